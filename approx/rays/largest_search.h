// The rounds of a search for the largest facets, and when it ends.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/rays/facet_search.h"
#include "approx/rays/largest_facets.h"
#include "approx/rays/pace.h"
#include "approx/rays/ray_shooting.h"
#include "approx/work_end.h"

namespace ndhull {

/// One search: rays and climbs in turn. Precondition: rank >= 2.
class LargestSearch {
 public:
  /// Throws Error kDimensionTooHigh.
  LargestSearch(RayShooter& shooter, const LargestOptions& options,
                std::chrono::steady_clock::time_point start);

  /// The first rays.
  void look();
  /// From what the first rays hit: may the hull have fewer facets than this?
  bool may_be_built(std::uint64_t most_facets) const;
  /// Searches to the end; fills all of `result` but the facets' planes and the sample.
  void run(LargestFacets& result);
  /// Fills in the facets and the sample.
  void certify(const PointView& points, LargestFacets& result);

 private:
  void shoot(std::uint64_t rays);
  void climb(double most_work);
  void ascend(double most_work);
  double work() const;
  bool is_over(std::size_t stable_rounds);
  void add_bounding();
  std::uint64_t led_by(std::uint64_t rays) const;
  double recall_estimate() const;
  RaySample describe_sample() const;
  LargestFacet describe(std::uint32_t id) const;

  RayShooter& shooter_;
  const LargestOptions& options_;
  WorkEnd end_;
  FacetSearch search_;
  Pace rays_at_once_, climbs_at_once_;
  std::size_t width_;               // the facets that are climbed from are among so many largest
  std::vector<std::uint32_t> hit_;  // by the last rays
  std::vector<std::uint32_t> largest_, bounding_;
  bool all_climbed_ = false;
  LargestStatus status_ = LargestStatus::kStable;
};

}  // namespace ndhull
