#include "approx/sample_shape.h"

#include <Eigen/Cholesky>

#include "core/dense_views.h"

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

void SampleShape::whiten(const double* points, std::size_t count, double* z, double* length_sq) const {
  whiten_points({rank_, dimension_, is_diagonal_, centre_.data(), map_.data(), mean_.data(), factor_.data(),
                 inverse_pivots_.data()},
                points, count, z, length_sq);
}

}  // namespace ndhull
