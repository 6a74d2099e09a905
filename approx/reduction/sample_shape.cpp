#include "approx/reduction/sample_shape.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>

#include "core/dimension_switch.h"
#include "core/linear/dense_views.h"

namespace ndhull {

SampleShape::SampleShape(const Frame& frame, const double* points, std::size_t count)
    : rank_(frame.rank),
      dimension_(frame.dimension),
      is_diagonal_(frame.is_diagonal),
      centre_(frame.centre),
      map_(frame.map) {
  const auto rank = static_cast<Eigen::Index>(rank_);
  const Eigen::Map<const RowMatrix> sample(points, static_cast<Eigen::Index>(count), rank);
  const Eigen::VectorXd mean = sample.colwise().mean().transpose();
  const RowMatrix centred = sample.rowwise() - mean.transpose();
  const Eigen::LLT<RowMatrix> covariance(centred.transpose() * centred / static_cast<double>(count));
  RowMatrix factor = covariance.matrixL();
  if (covariance.info() != Eigen::Success || !factor.allFinite() || factor.diagonal().minCoeff() <= 0.0)
    factor.setIdentity();
  mean_.assign(mean.data(), mean.data() + rank);
  factor_.assign(factor.data(), factor.data() + rank * rank);
  for (Eigen::Index i = 0; i < rank; ++i) inverse_pivots_.push_back(1.0 / factor(i, i));
}

namespace {

/// The rows less the centre, in columns.
template <class Scalar>
void shift_rows(const PointView& points, std::span<const std::size_t> rows, const double* centre,
                double* columns) {
  const Scalar* const data = static_cast<const Scalar*>(points.data);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Scalar* const row = data + rows[i] * points.row_stride;
    for (std::size_t k = 0; k < points.dimension; ++k)
      columns[k * kWhitenedPoints + i] = static_cast<double>(row[k * points.column_stride]) - centre[k];
  }
}

}  // namespace

void SampleShape::whiten(const PointView& points, std::span<const std::size_t> rows, double* z,
                         double* length_sq) const {
  std::array<double, kMaxRank * kWhitenedPoints> columns;
  const auto shift = points.type == ScalarType::kFloat64 ? shift_rows<double> : shift_rows<float>;
  shift(points, rows, centre_.data(), columns.data());
  for (std::size_t k = 0; k < dimension_; ++k)
    std::fill(columns.data() + k * kWhitenedPoints + rows.size(), columns.data() + (k + 1) * kWhitenedPoints,
              0.0);
  whiten_columns(
      {rank_, dimension_, is_diagonal_, map_.data(), mean_.data(), factor_.data(), inverse_pivots_.data()},
      columns.data(), rows.size(), z, length_sq);
}

}  // namespace ndhull
