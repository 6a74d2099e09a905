// One run of the driver, for its own sources: hull_builder.cpp (the steps), adopted_hull.cpp (hulls that were
// found without growth to the end) and runs_instead.cpp (other runs in its place).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "approx/accuracy.h"
#include "approx/facets/described_hull.h"
#include "approx/facets/facet_layout.h"
#include "approx/growth/begun_hull.h"
#include "approx/growth/certified_growth.h"
#include "approx/hull.h"
#include "approx/slabs/star_hull.h"
#include "approx/trade/approximate_facets.h"
#include "core/frame.h"
#include "core/machine/huge_array.h"
#include "core/machine/stopwatch.h"
#include "core/points.h"

namespace ndhull {

/// The search for whole facets, which a run may hand on to the next one.
struct WholeFacetSearch {
  std::vector<double> coordinates;  // in the frame
  HullDescription description;

  WholeFacetSearch(const double* points, std::size_t count, const Frame& frame, std::uint64_t most_words)
      : coordinates(points, points + count * frame.rank),
        description(coordinates.data(), count, frame, most_words) {}
};

/// The tables that the steps hand on.
class HullBuilder {
 public:
  HullBuilder(const PointView& points, const HullOptions& options, Clock::time_point start,
              double input_bytes, EarlierRun earlier = {}, std::unique_ptr<WholeFacetSearch> search = {})
      : points_(points),
        options_(options),
        start_(start),
        input_bytes_(input_bytes),
        earlier_(earlier),
        whole_facets_(std::move(search)) {}

  Hull run(BegunHull* begun = nullptr);

  /// The hull of some of the points in terms of all of them: point i of it is ids[i].
  static void rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count);

 private:
  SimplicialComplex& complex() { return growth_->work().complex; }
  double& seconds(Phase phase) { return hull_.statistics.seconds[static_cast<std::size_t>(phase)]; }
  void detail(std::string_view name, Clock::time_point since) {
    hull_.statistics.detail_seconds.emplace_back(name, seconds_since(since));
  }
  std::vector<bool> corners() { return find_corners(growth_->work()); }

  void describe_input();
  std::optional<Hull> grow_segment();
  std::optional<Hull> grow_exactly();
  std::optional<Hull> grow_for(const ResolvedAccuracy& lengths, const std::vector<double>& factor);
  Hull merged_hull(bool is_exact, const ResolvedAccuracy& lengths);

  void find_whole_facets();
  bool look_for_whole_facets(std::uint64_t work);
  bool finds_whole_facets_late();
  bool approximate(const std::vector<double>& factor);
  void compact_rows(KnownHighest& known);
  void merge();
  void find_determinants(std::span<const std::uint8_t> is_shifted);
  void choose_for_volume(std::span<const double> determinants);
  void make_facets(const KnownHighest& known);
  void certify_facets(const KnownHighest& known, const IdRows* merged_vertices);

  Hull again(const HullOptions& options, EarlierRun earlier);
  Hull exact_first(const ResolvedAccuracy& lengths);
  Hull with(const Accuracy& accuracy, const ResolvedAccuracy& lengths, std::uint64_t max_facets,
            std::uint64_t joined_to = 0);
  Hull for_width_instead();
  bool is_wide_for(double height, const ResolvedAccuracy& lengths) const;
  Hull narrow_instead(const ResolvedAccuracy& lengths);
  Hull with_larger_shift();

  bool take_described();
  void adopt(DescribedHull found);
  void adopt(StarHull found);

  const PointView& points_;
  const HullOptions& options_;
  Clock::time_point start_;
  double input_bytes_;
  EarlierRun earlier_;
  Hull hull_;
  Frame frame_;
  std::optional<CertifiedGrowth> growth_;
  std::unique_ptr<WholeFacetSearch> whole_facets_;  // from when they were first looked for
  bool wants_exact_first_ = false;
  bool is_bounded_ = true;  // by planes chosen for volume
  std::optional<StarHull> star_hull_;
  FacetClusters clusters_;  // of an approximate hull; none: coplanar simplices are merged
  HugeArray<double> determinants_;
  std::vector<bool> is_vertex_;
};

}  // namespace ndhull
