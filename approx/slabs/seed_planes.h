// The planes of slabs that start from a simplex: its own, raised above what points are above it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/geometry/gradient_length.h"
#include "approx/slabs/dual_facets.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// A plane of the frame that no point of the space is above, and what a slab below it takes.
template <std::size_t D>
struct SeedPlane {
  std::array<double, D> plane;
  double top, length, least;  // least: what vertices' products are at least
  bool is_fitted = false;     // no more the simplex' own plane
};

/// Planes for the slabs of one width.
template <std::size_t D>
class SeedPlanes {
 public:
  /// All must outlive this. factor: rank x rank.
  SeedPlanes(const SimplicialComplex& complex, const WidthSpace& space, std::span<const double> factor,
             PointsAbove above, double width)
      : complex_(complex),
        space_(space),
        length_of_(factor),
        tops_(space, above),
        above_(above),
        width_(width) {}

  /// The seed's own, as if no point were above it.
  SeedPlane<D> own(std::uint32_t seed) const {
    std::array<double, D> plane;
    std::copy_n(complex_.planes.data() + std::size_t{seed} * D, D, plane.data());
    return below(plane);
  }
  SeedPlane<D> below(const std::array<double, D>& plane) const {
    const double length = length_of_(plane.data());
    return {plane, 1.0, length, 1.0 - width_ * length};
  }

  bool may_have_points_above() const { return !above_.are_none(); }
  /// To the highest point of the space. Cost  as PlaneTops.
  void raise_top(SeedPlane<D>& seed_plane) {
    seed_plane.top = tops_.of_simplex(seed_plane.plane.data(), seed_plane.length);
    seed_plane.least = seed_plane.top - width_ * seed_plane.length;
  }

  /// Raises a seed's own plane, and turns it where the seed would be more than the width below. False: no
  /// plane was found that it is less than the width below.
  bool raise_above_points(std::uint32_t seed, SeedPlane<D>& own) {
    if (!may_have_points_above()) return true;
    raise_top(own);
    return own.least <= 1.0 || fit(seed, own);
  }

  /// Turns a seed's plane so that all vertices that are less than the width below it become less deep: that
  /// makes room for more. Cost  two products of a direction with all points, and a fit.
  void turn_to_vertices_below(std::uint32_t seed, SeedPlane<D>& own) {
    FittedPlane start = measured(own, {});
    const double least = start.height - width_;
    list_vertices_from(space_, least, work_, vertices_);
    std::erase_if(vertices_, [&](std::uint32_t row) {
      const double height = dot_in_frame<D>(start.normal.data(), space_.row(row));
      if (height >= least) start.low = std::min(start.low, height);
      return height < least;
    });
    SeedPlane<D> turned = own;
    // None where rounding takes a seed out that is just within the width.
    if (vertices_.empty() || !turn(start, turned)) return;
    for (std::size_t k = 0; k < D; ++k) {  // one may be lost by rounding
      const PointId id{complex_.topology[std::size_t{seed} * 2 * D + k]};
      if (dot_in_frame<D>(turned_.normal.data(), space_.row(space_.row_of(id))) < turned_.height - width_)
        return;
    }
    own = turned;
  }
  /// The same with these vertices, all less than the width below it. False: no way of turning makes them less
  /// deep.
  bool turn_to(std::span<const PointId> vertices, SeedPlane<D>& own) {
    vertices_.clear();
    for (const PointId id : vertices) vertices_.push_back(space_.row_of(id));
    return turn(measured(own, vertices_), own);
  }

  double length_of(const double* plane) const { return length_of_(plane); }
  double length_sq_of(const double* plane) const { return length_of_.squared(plane); }

 private:
  FittedPlane measured(const SeedPlane<D>& own, std::span<const std::uint32_t> vertices) {
    normal_.resize(D);
    space_.normal_of(own.plane, normal_.data());
    return measure_plane(space_, normal_, vertices, work_);
  }

  /// To vertices_. The last plane measured must be `start`.
  bool turn(const FittedPlane& start, SeedPlane<D>& own) {
    constexpr unsigned kSteps = 24;
    turned_ = narrow_plane(space_, start, vertices_, kSteps, work_);
    return turned_.normal != start.normal && take_turned(own);
  }
  bool take_turned(SeedPlane<D>& own) const {
    if (turned_.width() > width_) return false;
    std::array<double, D> plane;
    space_.plane_of(turned_.normal.data(), turned_.height, plane.data());
    own = below(plane);
    own.is_fitted = true;
    return true;
  }

  bool fit(std::uint32_t seed, SeedPlane<D>& own) {
    constexpr unsigned kSteps = 48;
    vertices_.clear();
    for (std::size_t k = 0; k < D; ++k)
      vertices_.push_back(space_.row_of(PointId{complex_.topology[std::size_t{seed} * 2 * D + k]}));
    turned_ = narrow_plane(space_, measured(own, vertices_), vertices_, kSteps, work_);
    return take_turned(own);
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  GradientLength<D> length_of_;
  PlaneTops tops_;
  PointsAbove above_;
  PlaneFitWork work_;
  FittedPlane turned_;
  std::vector<double> normal_;
  std::vector<std::uint32_t> vertices_;  // rows of the space
  double width_;
};

}  // namespace ndhull
