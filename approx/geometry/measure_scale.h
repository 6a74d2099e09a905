// From determinants and planes of the frame to volumes and areas in input units.
#pragma once

#include <cstddef>
#include <span>

#include "approx/geometry/frame_planes.h"
#include "core/frame.h"

namespace ndhull {

/// Of cones and volumes, in multiples of 2^volume_exponent: those of tiny and of huge data are no doubles
/// where areas are.
class MeasureScale {
 public:
  explicit MeasureScale(const Frame& frame);

  std::size_t rank() const { return rank_; }
  std::size_t dimension() const { return dimension_; }
  double volume_per_determinant() const { return volume_per_determinant_; }
  double area_per_determinant() const { return static_cast<double>(rank_) * volume_per_determinant_; }
  int volume_exponent() const { return volume_exponent_; }
  const NormalMap& to_input() const { return to_input_; }

  /// From multiples of 2^volume_exponent to input units.
  double to_input_size(double size) const { return size * first_power_ * second_power_; }
  /// A sum of determinants times gradients' lengths that were scaled by 2^-exponent: an area in input units.
  double surface(double sum, int exponent) const;

  /// Areas of merged facets: of the projection of their simplices onto their plane. A simplex that faces the
  /// other way is taken off, and of a wide facet most may: nothing is left then.
  /// Shapes  area_vectors: facets x rank, sums of determinant times plane; normals: facets x dimension, unit.
  void project_areas(std::span<const double> area_vectors, const double* normals, double* areas) const;

 private:
  std::size_t rank_, dimension_;
  NormalMap to_input_;
  double volume_per_determinant_ = 0.0;
  int volume_exponent_ = 0;
  double first_power_ = 1.0, second_power_ = 1.0;  // their product is 2^volume_exponent_
};

}  // namespace ndhull
