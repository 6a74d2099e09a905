// Facets as disjoint connected sets of simplices, each with a plane that all its vertices are less than a
// width below. Planes are dual vertices in the frame, so that any plane between two of them is known without
// a look at the points: what a.y is at most is convex in a.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/facets/facet_layout.h"
#include "approx/slabs/covering.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/simplex_marks.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// Facets as lists of simplices. The plane of a facet is that of its seed, or one of its own.
struct DualFacets {
  const SimplicialComplex* complex = nullptr;
  SimplexMarks marks;                    ///< of each row; taken: in a facet, or a free row
  std::vector<SimplexId> members;        ///< facet by facet, the seed first
  std::vector<std::uint32_t> begin;      ///< of each facet in `members`, and the end
  std::vector<std::uint32_t> seeds;      ///< per facet: one of its rows of the complex
  std::vector<std::uint32_t> own_plane;  ///< per facet: which of own_planes; kNone: its seed's
  std::vector<double> own_planes;        ///< planes x rank
  std::vector<std::uint32_t> unfit;      ///< simplices that are facets alone, and thicker than the width
  /// Every plane is further from the frame's centre than the width. Where all fit they bound a region: along
  /// any direction the hull ends in a simplex of some facet; if that facet's plane did not face the
  /// direction, a point of the simplex would be as deep below it as the centre.
  bool are_far_from_centre = true;

  // What joining facets has to know; tops and lengths are known afterwards too. Of thin slabs, which are not
  // joined, empty.
  /// Of facets of several simplices the different vertices, facet by facet; of others none.
  std::vector<PointId> vertices;
  std::vector<std::uint32_t> vertex_begin;  ///< of each facet in `vertices`, and the end
  std::vector<double> tops;                 ///< per facet: no a.y of a point of the space is larger
  std::vector<float> lengths;  ///< per facet: |R a|, one over the plane's distance from the centre

  std::size_t count() const { return seeds.size(); }
  bool may_join() const { return !vertex_begin.empty(); }
  std::size_t size(std::size_t facet) const { return begin[facet + 1] - begin[facet]; }
  std::span<const SimplexId> members_of(std::size_t facet) const {
    return {members.data() + begin[facet], size(facet)};
  }
  /// Per row of the complex; kNone: a free row. Cost  a write anywhere in memory for each, by all threads.
  std::vector<std::uint32_t> facet_of_rows() const;
  std::span<const double> plane(std::size_t facet) const {
    if (own_plane[facet] == kNone) return complex->plane(SimplexId{seeds[facet]});
    return {own_planes.data() + own_plane[facet] * complex->rank, complex->rank};
  }
};

/// In `members` the seed of a facet, until facets are listed: no row has so high a number.
inline constexpr std::uint32_t kSeedBit = 0x8000'0000u;
/// Makes the tables of facets from `members`, of which so many are listed: seeds have the bit. `with_planes`:
/// the seeds of facets that have planes of their own, in order.
void list_facets(DualFacets& facets, std::size_t member_count, std::span<const std::uint32_t> with_planes);

/// plane . y as four sums that are made side by side: one after the other, each addition would wait for the
/// last. Inner loops are written so that compilers make pairs of them.
template <std::size_t D>
[[gnu::always_inline]] inline double dot_in_frame(const double* plane, const double* y) {
  constexpr std::size_t kWhole = D / 4 * 4;
  std::array<double, 4> sums{};
  if constexpr (kWhole > 0)
    for (std::size_t i = 0; i < 4; ++i) sums[i] = plane[i] * y[i];
  for (std::size_t k = 4; k < kWhole; k += 4)
    for (std::size_t i = 0; i < 4; ++i) sums[i] += plane[k + i] * y[k + i];
  for (std::size_t k = kWhole; k < D; ++k) sums[k % 4] += plane[k] * y[k];
  return (sums[0] + sums[2]) + (sums[1] + sums[3]);
}

/// What is above a simplex' own plane by more than rounding.
struct PointsAbove {
  bool are_left_out = false;  ///< points that are no vertices, perhaps
  double vertices = 0.0;      ///< vertices, by no more than this, since growth has moved some inwards [gauge]

  bool are_none() const { return !are_left_out && !are_shifted(); }
  bool are_shifted() const { return vertices > 0.0; }
};

/// The largest a.y of any point of the space.
class PlaneTops {
 public:
  PlaneTops(const WidthSpace& space, PointsAbove above);

  /// Of a simplex' own plane. Cost  nothing where no points are above, else a product of a direction with all
  /// that may be.
  double of_simplex(const double* plane, double length);

 private:
  const WidthSpace& space_;
  PointsAbove above_;
  SupportTable left_out_;  // where only these are looked at
  std::vector<double> normal_;
  PlaneFitWork work_;
};

/// The same facets with planes measured over all points of the space.
/// Cost  for each facet of several simplices a product of a direction with all points.
Covering covering_of(const DualFacets& facets, const WidthSpace& space);

/// The same facets as they are put in order: only the directions of their planes count then. Their planes are
/// those of their seeds, where they have none of their own: not copied.
FacetClusters clusters_of(DualFacets facets);

}  // namespace ndhull
