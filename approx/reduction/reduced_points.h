// The points of a large set that are left when the others were dropped, copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/reduction/point_shards.h"

namespace ndhull {

/// Some rows of a point set, in memory.
class ReducedPoints {
 public:
  ReducedPoints() = default;
  /// Copies rows that this process holds, ascending. Of several processes the first gets those of all, in
  /// their order; the others get none.
  ReducedPoints(const PointShards& shards, std::vector<std::uint32_t> ids);

  PointView view() const;
  /// Of each row of the view: the row of the whole set.
  const std::vector<std::uint32_t>& ids() const { return ids_; }
  /// Memory of all that is kept. [bytes]
  std::uint64_t bytes() const;

 private:
  template <class Scalar>
  void copy_rows(const PointShards& shards, std::vector<Scalar>& out);

  std::size_t dimension_ = 0;
  std::vector<std::uint32_t> ids_;
  std::vector<double> doubles_;
  std::vector<float> floats_;  // one of the two is used
};

}  // namespace ndhull
