// How long the gradient of a plane's gauge is: one over the plane's distance from the frame's centre.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace ndhull {

/// |R a| for planes a of a frame of rank D, with R the gradient factor (gradient_factor in
/// approx/geometry/length_unit.h).
template <std::size_t D>
class GradientLength {
 public:
  /// Shapes  factor: D x D, row-major.
  explicit GradientLength(std::span<const double> factor) {
    for (std::size_t k = 0; k < D; ++k) {
      for (std::size_t i = 0; i < D; ++i) {
        columns_[k * D + i] = factor[i * D + k];
        if (i != k && factor[i * D + k] != 0.0) is_diagonal_ = false;
      }
      diagonal_[k] = factor[k * D + k];
    }
  }

  double operator()(const double* plane) const { return std::sqrt(squared(plane)); }
  double squared(const double* plane) const { return is_diagonal_ ? scaled(plane) : full(plane); }

 private:
  /// Squared, with the sums of all rows side by side.
  double full(const double* plane) const {
    std::array<double, D> sums{};
    for (std::size_t k = 0; k < D; ++k)
      for (std::size_t i = 0; i < D; ++i) sums[i] += columns_[k * D + i] * plane[k];
    double length_sq = 0.0;
    for (const double entry : sums) length_sq += entry * entry;
    return length_sq;
  }

  /// Squared, where all other entries of R are 0, as those of frames that only scale.
  double scaled(const double* plane) const {
    double length_sq = 0.0;
    for (std::size_t k = 0; k < D; ++k) length_sq += diagonal_[k] * plane[k] * (diagonal_[k] * plane[k]);
    return length_sq;
  }

  std::array<double, D * D> columns_;
  std::array<double, D> diagonal_;
  bool is_diagonal_ = true;
};

}  // namespace ndhull
