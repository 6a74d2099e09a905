#include "approx/slabs/width_space.h"

#include <cmath>

#include "core/machine/blocks.h"

namespace ndhull {

std::vector<double> map_to_lengths(std::size_t rank, std::span<const double> gradient_factor,
                                   const double* coordinates, std::span<const PointId> points) {
  constexpr std::size_t kAtATime = 4096;
  std::vector<double> rows(points.size() * rank);
  for_each_block(points.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double* y = coordinates + std::size_t{points[row].value} * rank;
      double* z = rows.data() + row * rank;
      for (std::size_t i = 0; i < rank; ++i) {
        double rest = y[i];
        for (std::size_t k = 0; k < i; ++k) rest -= gradient_factor[k * rank + i] * z[k];
        z[i] = rest / gradient_factor[i * rank + i];
      }
    }
  });
  return rows;
}

WidthSpace::WidthSpace(std::size_t rank, std::vector<double> gradient_factor, const double* coordinates,
                       std::size_t point_count, std::span<const PointId> vertices,
                       std::span<const PointId> others, std::size_t planes)
    : rank_(rank),
      vertex_count_(vertices.size()),
      factor_(std::move(gradient_factor)),
      row_of_point_(point_count, PointId::kNone) {
  point_of_row_.assign(vertices.begin(), vertices.end());
  point_of_row_.insert(point_of_row_.end(), others.begin(), others.end());
  for (std::uint32_t row = 0; row < point_of_row_.size(); ++row)
    row_of_point_[point_of_row_[row].value] = row;
  rows_ = map_to_lengths(rank, factor_, coordinates, point_of_row_);
  table_ = SupportTable(rank, rows_);
  // On spheres the cones of fewer points are too wide for most to be left out. To make the tree takes as long
  // as products with all points for some hundred directions.
  constexpr std::size_t kExponent = 6, kFewPlanes = 256;
  if (planes > kFewPlanes && point_of_row_.size() >> (rank + kExponent) > 0) tree_.emplace(rank, rows_);
}

FurthestPoint WidthSpace::furthest(std::span<const double> normal, double attained) const {
  FurthestPoint furthest{attained};
  find_furthest(*tree_, normal, {&furthest, 1});
  return furthest;
}

void WidthSpace::find_above(std::span<const double> normal, double least,
                            std::vector<FurthestPoint>& found) const {
  ndhull::find_above(*tree_, normal, least, found);
}

void WidthSpace::normal_of(std::span<const double> plane, double* normal) const {
  double length_sq = 0.0;
  for (std::size_t i = 0; i < rank_; ++i) {
    double entry = 0.0;
    for (std::size_t k = i; k < rank_; ++k) entry += factor_[i * rank_ + k] * plane[k];
    normal[i] = entry;
    length_sq += entry * entry;
  }
  const double scale = 1.0 / std::sqrt(length_sq);
  for (std::size_t i = 0; i < rank_; ++i) normal[i] *= scale;
}

double WidthSpace::distance_of(std::span<const double> plane) const {
  double length_sq = 0.0;
  for (std::size_t i = 0; i < rank_; ++i) {
    double entry = 0.0;
    for (std::size_t k = i; k < rank_; ++k) entry += factor_[i * rank_ + k] * plane[k];
    length_sq += entry * entry;
  }
  return 1.0 / std::sqrt(length_sq);
}

void WidthSpace::plane_of(const double* normal, double height, double* plane) const {
  for (std::size_t i = rank_; i-- > 0;) {
    double rest = normal[i] / height;
    for (std::size_t k = i + 1; k < rank_; ++k) rest -= factor_[i * rank_ + k] * plane[k];
    plane[i] = rest / factor_[i * rank_ + i];
  }
}

void WidthSpace::facing(const double* normal, double* m) const {
  for (std::size_t k = 0; k < rank_; ++k) {
    m[k] = 0.0;
    for (std::size_t i = 0; i <= k; ++i) m[k] += factor_[i * rank_ + k] * normal[i];
  }
}

}  // namespace ndhull
