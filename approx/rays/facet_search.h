// The search for large facets: rays that sample, climbs that follow what they hit to larger neighbours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <unordered_map>
#include <vector>

#include "approx/rays/pace.h"
#include "approx/rays/ray_facets.h"
#include "approx/rays/ray_shooting.h"
#include "approx/work_end.h"
#include "core/portable_random.h"

namespace ndhull {

/// What the directions of rays are uniform in.
enum class DirectionUnit {
  kInput,     ///< input units: columns have extents within a factor of four
  kUnitCube,  ///< after scaling every column to its extent
};

/// A facet and how it was found.
struct FoundFacet {
  /// Rays that lead to a facet, by hitting it or by climbing, as far as they are counted.
  static constexpr std::size_t kCountedRays = 3;

  double area = 0.0;  ///< [area, input units]
  bool area_is_whole = true;
  bool is_climbed_from = false;
  std::uint64_t hits = 0;  ///< rays
  std::array<std::uint32_t, kCountedRays> rays{};
  std::uint8_t ray_count = 0;
};

/// Facets found so far, and what finds more.
class FacetSearch {
 public:
  /// Precondition: shooter.frame().rank >= 2. The shooter must outlive the search. `max_seconds_of_facet`: as
  /// FacetGeometry's.
  FacetSearch(RayShooter& shooter, std::uint64_t seed, double max_seconds_of_facet = 0.0);

  DirectionUnit direction_unit() const { return direction_unit_; }

  /// Shoots uniform rays from the centre. Every one that was begun is counted, as hit or as left open.
  /// Returns the facets that were hit, each once, in order.
  std::vector<std::uint32_t> shoot(std::size_t rays, std::stop_token stop);
  /// Walks over the ridges of the largest facets, among the `width` largest, that were not climbed from.
  /// At most `most` of them; of the last one not all ridges where a deadline comes. Returns how many it were:
  /// 0 when all are done.
  std::size_t climb(std::size_t width, std::size_t most, const WorkEnd& end);
  /// One step of steepest ascent from each facet: over its ridges, to the largest neighbour. Returns the
  /// neighbours that are larger, each once, in order; ascents that reached their top are left out, and those
  /// that `most` leaves no room for stay where they are.
  std::vector<std::uint32_t> ascend(std::span<const std::uint32_t> from, std::size_t most,
                                    const WorkEnd& end);
  /// Adds the facet that a ray in frame coordinates hits. False when the walk was left open.
  bool add_hit_by(const std::vector<double>& direction, std::uint32_t& facet);

  std::size_t size() const { return facets_.size(); }
  const FoundFacet& facet(std::uint32_t id) const { return facets_[id]; }
  std::span<const std::uint32_t> points_of(std::uint32_t facet) const {
    return {points_.data() + begins_[facet], begins_[facet + 1] - begins_[facet]};
  }
  /// Plane, vertices, area of a facet, as they were found.
  RayFacet geometry_of(std::uint32_t facet) const;
  /// The `count` largest, the largest first; equal areas in the order they were found.
  std::vector<std::uint32_t> largest(std::size_t count) const;

  std::uint64_t rays() const { return rays_; }
  std::uint64_t open_rays() const { return open_rays_; }
  std::uint64_t climbs() const { return climbs_; }
  /// Was time too short to walk over all ridges of a facet that was climbed from?
  bool left_ridges_out() const { return has_left_ridges_out_; }
  /// Facets that exactly `hits` rays hit.
  std::uint64_t facets_with_hits(std::uint64_t hits) const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFu;
  static constexpr std::size_t kWalksAtOnce = 512;

  std::vector<double> random_direction();
  std::uint32_t find(std::span<const std::uint32_t> points) const;
  /// The facets of walks, in order; kNone for those left open. New ones are added.
  std::vector<std::uint32_t> enter(std::span<const WalkResult> walks);
  std::vector<std::uint32_t> vertices_of(std::uint32_t facet) const;
  void climb_from(std::span<const std::uint32_t> from, const WorkEnd& end);
  void lead(std::uint32_t facet, std::uint32_t ray);

  RayShooter& shooter_;
  FacetGeometry geometry_;
  PortableRandom random_;
  DirectionUnit direction_unit_ = DirectionUnit::kInput;
  // dimension x rank: normal numbers times this are directions in the frame, uniform in the unit.
  Eigen::MatrixXd to_direction_;
  std::vector<FoundFacet> facets_;
  std::vector<std::size_t> begins_{0};
  std::vector<std::uint32_t> points_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> facets_of_hash_;  // looked up only
  std::vector<std::vector<std::uint32_t>> neighbours_;                            // of facets climbed from
  std::vector<std::vector<std::uint32_t>> vertices_;  // of facets with more than rank points
  Pace walks_at_once_{kWalksAtOnce};  // over ridges: facets with many points take a tenth of a second each
  bool has_left_ridges_out_ = false;
  std::uint64_t rays_ = 0, open_rays_ = 0, climbs_ = 0;
};

}  // namespace ndhull
