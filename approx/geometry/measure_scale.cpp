#include "approx/geometry/measure_scale.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ndhull {

MeasureScale::MeasureScale(const Frame& frame)
    : rank_(frame.rank), dimension_(frame.dimension), to_input_(frame) {
  const ScaledRatio scale = volume_scale(frame);
  volume_per_determinant_ = 1.0 / (scale.ratio * std::tgamma(static_cast<double>(frame.rank) + 1.0));
  volume_exponent_ = -scale.exponent;
  // In two steps: the power itself may be no double where an area is one.
  first_power_ = std::ldexp(1.0, std::clamp(volume_exponent_ / 2, -1022, 1022));
  second_power_ = std::ldexp(1.0, std::clamp(volume_exponent_ - volume_exponent_ / 2, -1022, 1022));
}

double MeasureScale::surface(double sum, int exponent) const {
  return std::ldexp(sum * area_per_determinant(), exponent + volume_exponent_);
}

void MeasureScale::project_areas(std::span<const double> area_vectors, const double* normals,
                                 double* areas) const {
  const std::size_t count = area_vectors.size() / rank_;
  std::vector<double> directions(count * dimension_), lengths(count);
  to_input_.map(area_vectors.data(), count, directions.data(), lengths.data());
  for (std::size_t i = 0; i < count; ++i) {
    double cosine = 0.0;
    for (std::size_t k = i * dimension_; k < (i + 1) * dimension_; ++k) cosine += directions[k] * normals[k];
    // A facet of simplices without volume has no direction either.
    areas[i] = std::isfinite(cosine) && cosine > 0.0
                   ? to_input_size(lengths[i] * cosine * area_per_determinant())
                   : 0.0;
  }
}

}  // namespace ndhull
