// Large inputs: the points that the hull can depend on, found in a few passes over blocks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// Points from which on passes over all of them are cheaper than tables of all of them.
inline constexpr std::size_t kPointsToReduce = 100'000;

/// Gives the memory of rows begin .. end back when they are a mapped file: they come again when they are
/// read.
void give_back_rows(const PointView& points, std::size_t begin, std::size_t end);

/// The points that are left, copied.
class ReducedPoints {
 public:
  /// Copies the rows `ids`, ascending, in the type that they have.
  ReducedPoints(const PointView& points, std::vector<std::uint32_t> ids);

  PointView view() const;
  /// Of each row of the view: the row of the input.
  const std::vector<std::uint32_t>& ids() const { return ids_; }
  /// Memory of all that is kept. [bytes]
  std::uint64_t bytes() const;

 private:
  std::size_t dimension_;
  std::vector<std::uint32_t> ids_;
  std::vector<double> doubles_;
  std::vector<float> floats_;  // one of the two is used
};

/// Finds the points that are not proven to be well inside the hull of others that are kept.
///
/// Method   A hull is grown from a sample, furthest point first. What lies more than 1e-9 inside it, by
/// barycentric
///          coordinates in one of its simplices (core/membership.h), is dropped. Then the points that were
///          furthest outside are added, the hull grows eight times as large, and the points that are left
///          pass again.
/// Returns  ascending rows. All of them where the points span less than all dimensions or are not finite:
/// then
///          fit_frame says what is to be said.
/// Proof    A dropped point lies in the hull of kept ones, more than 1e-9 of the way to the interior point
/// below
///          its boundary: planes that bound those bound it.
/// Memory   a bit a point; of mapped files blocks are given back to the system once they are read.
/// Cost     some 0.5 us a point and thread in each of at most four passes.
/// Threads  the result does not depend on them.
std::vector<std::uint32_t> find_points_to_keep(const PointView& points, std::uint64_t seed,
                                               const std::function<bool()>& is_late);

}  // namespace ndhull
