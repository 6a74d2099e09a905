#include "approx/reduction/reduced_points.h"

#include <utility>

namespace ndhull {

template <class Scalar>
void ReducedPoints::copy_rows(const PointShards& shards, std::vector<Scalar>& out) {
  RowCopier copier(shards);
  std::vector<double> row(dimension_);
  if (shards.exchange == nullptr) {
    out.resize(ids_.size() * dimension_);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      copier.copy(ids_[i], row.data());
      for (std::size_t k = 0; k < dimension_; ++k) out[i * dimension_ + k] = static_cast<Scalar>(row[k]);
    }
    return;
  }
  // A row and its id; single precision and ids are doubles without loss.
  std::vector<double> said;
  said.reserve(ids_.size() * (dimension_ + 1));
  for (const std::uint32_t id : ids_) {
    copier.copy(id, row.data());
    said.push_back(static_cast<double>(id));
    said.insert(said.end(), row.begin(), row.end());
  }
  said = shards.exchange->gather_to_first(said);
  ids_.clear();
  for (std::size_t at = 0; at < said.size(); ++at) {
    if (at % (dimension_ + 1) == 0) {
      ids_.push_back(static_cast<std::uint32_t>(said[at]));
    } else {
      out.push_back(static_cast<Scalar>(said[at]));
    }
  }
}

ReducedPoints::ReducedPoints(const PointShards& shards, std::vector<std::uint32_t> ids)
    : dimension_(shards.dimension), ids_(std::move(ids)) {
  if (shards.type == ScalarType::kFloat32) {
    copy_rows(shards, floats_);
  } else {
    copy_rows(shards, doubles_);
  }
}

PointView ReducedPoints::view() const {
  return floats_.empty() ? PointView::row_major(doubles_.data(), ids_.size(), dimension_)
                         : PointView::row_major(floats_.data(), ids_.size(), dimension_);
}

std::uint64_t ReducedPoints::bytes() const {
  return doubles_.size() * sizeof(double) + floats_.size() * sizeof(float) +
         ids_.size() * sizeof(std::uint32_t);
}

}  // namespace ndhull
