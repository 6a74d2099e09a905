// The planes of slabs that start from a simplex: its own, raised above what points are above it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/dual_facets.h"
#include "approx/gradient_length.h"
#include "approx/plane_fit.h"
#include "approx/width_space.h"
#include "core/ids.h"
#include "core/simplicial_complex.h"

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
    return below(plane, 1.0);
  }
  SeedPlane<D> below(const std::array<double, D>& plane, double top) const {
    const double length = length_of_(plane.data());
    return {plane, top, length, top - width_ * length};
  }

  bool may_have_points_above() const { return above_ != PointsAbove::kNoPoint; }
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

  double length_of(const double* plane) const { return length_of_(plane); }

 private:
  bool fit(std::uint32_t seed, SeedPlane<D>& own) {
    constexpr unsigned kSteps = 48;
    std::array<std::uint32_t, D> vertices;
    for (std::size_t k = 0; k < D; ++k)
      vertices[k] = space_.row_of(PointId{complex_.topology[std::size_t{seed} * 2 * D + k]});
    std::vector<double> normal(D);
    space_.normal_of(own.plane, normal.data());
    const FittedPlane start = measure_plane(space_, normal, vertices, work_);
    const FittedPlane fitted = narrow_plane(space_, start, vertices, kSteps, work_);
    if (fitted.width() > width_) return false;
    std::array<double, D> plane;
    space_.plane_of(fitted.normal.data(), fitted.height, plane.data());
    own = below(plane, 1.0);
    own.is_fitted = true;
    return true;
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  GradientLength<D> length_of_;
  PlaneTops tops_;
  PointsAbove above_;
  PlaneFitWork work_;
  double width_;
};

}  // namespace ndhull
