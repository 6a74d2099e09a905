// The vector loop of approx/selection/volume_rays.h: what planes would gain on rays that have changed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// Planes that are side by side: a multiple of four vectors of any instruction set.
inline constexpr std::size_t kGainBlock = 32;

/// Rays whose first plane has become another one: one number each, of which `directions` has rank.
///
/// A plane is met at 1 / slope, slope = a . direction. Not above `lower` it is behind the first plane before
/// and after, and gains nothing; from `upper` on it was and is the first, and its gain changes by
/// `difference`; between them by difference - sign (slope^-rank - shorter).
struct RayChanges {
  std::vector<double> directions, lower, upper, difference, sign, shorter;

  std::size_t count() const { return lower.size(); }
  void clear() {
    for (std::vector<double>* values : {&directions, &lower, &upper, &difference, &sign, &shorter})
      values->clear();
  }
};

/// Adds the changes, in their order, to the gains of kGainBlock planes. The same bits on all machines:
/// products are not fused with sums.
///
/// Shapes  planes: rank x kGainBlock, one coordinate of all planes after the other. gains: kGainBlock.
void add_ray_gains(const double* planes, std::size_t rank, const RayChanges& changes, double* gains);

}  // namespace ndhull
