#include "approx/reduction/inner_ellipsoid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/dimension_switch.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

constexpr double kUnitRoundoff = 0x1p-53;
/// What is taken off for all that is not counted one by one.
constexpr double kMargin = 1e-3;

}  // namespace

InnerEllipsoid::InnerEllipsoid(const SampleShape& shape, double reach)
    : shape_(shape), rounding_(static_cast<double>(shape.dimension() + 4) * kUnitRoundoff * reach) {}

/// The largest radius, in units of the ellipsoid, that is proven to be below this plane.
double InnerEllipsoid::radius_below(std::span<const double> plane) const {
  const std::size_t rank = shape_.rank();
  const std::vector<double>&mean = shape_.mean(), &factor = shape_.factor();
  double at_mean = 0.0, length_sq = 0.0, slope_sq = 0.0, sizes_sq = 0.0;
  for (std::size_t i = 0; i < rank; ++i) {
    at_mean += plane[i] * mean[i];
    length_sq += plane[i] * plane[i];
    double slope = 0.0, size = 0.0;
    for (std::size_t k = i; k < rank; ++k) {  // the factor is a lower triangle
      const double term = factor[k * rank + i] * plane[k];
      slope += term;
      size += std::abs(term);
    }
    slope_sq += slope * slope;
    sizes_sq += size * size;
  }
  const double below = (1.0 - kMargin) * (1.0 - at_mean) - std::sqrt(length_sq) * rounding_;
  const double substitution = static_cast<double>(rank + 2) * kUnitRoundoff;
  return below / (std::sqrt(slope_sq) + substitution * std::sqrt(sizes_sq));
}

void InnerEllipsoid::fit(const SimplicialComplex& complex) {
  constexpr std::size_t kRowsAtATime = 4096;
  radius_sq_ = 0.0;
  if (shape_.rank() == 0) return;
  std::vector<double> radii((complex.row_count + kRowsAtATime - 1) / kRowsAtATime, HUGE_VAL);
  for_each_block(complex.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    double& radius = radii[begin / kRowsAtATime];
    for (std::size_t row = begin; row < end; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      radius = std::min(radius, radius_below(complex.plane(SimplexId{static_cast<std::uint32_t>(row)})));
    }
  });
  const double radius = *std::min_element(radii.begin(), radii.end());
  if (radius > 0.0 && radius < HUGE_VAL) radius_sq_ = radius * radius;
}

std::uint64_t InnerEllipsoid::contains(const PointView& points, std::span<const std::size_t> rows) const {
  if (radius_sq_ == 0.0 || rows.empty()) return 0;
  std::array<double, kMaxRank * kPoints> z;
  std::array<double, kPoints> length_sq;
  shape_.whiten(points, rows, z.data(), length_sq.data());
  std::uint64_t inside = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    inside |= static_cast<std::uint64_t>(length_sq[i] < radius_sq_ ? 1 : 0) << i;
  return inside;
}

void InnerEllipsoid::drop_inside(const PointView& points, std::size_t begin, std::size_t end,
                                 RowBits& rows) const {
  if (radius_sq_ == 0.0) return;
  std::array<std::size_t, kPoints> some;
  std::size_t count = 0;
  const auto look = [&] {
    for (std::uint64_t inside = contains(points, {some.data(), count}); inside != 0; inside &= inside - 1)
      rows.drop(some[static_cast<std::size_t>(std::countr_zero(inside))]);
    count = 0;
  };
  rows.for_each(begin, end, [&](std::size_t row) {
    some[count++] = row;
    if (count == kPoints) look();
  });
  look();
}

}  // namespace ndhull
