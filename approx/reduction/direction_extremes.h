// The points that are furthest along many directions, in one pass over all of them: what a first hull of a
// large set is well grown from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/reduction/point_shards.h"
#include "approx/reduction/sample_shape.h"

namespace ndhull {

/// Rows of the whole set and their coordinates.
struct RowList {
  std::vector<std::uint32_t> ids;  ///< ascending, each once
  std::vector<double> rows;        ///< ids.size() x dimension, input units
};

/// Finds for each of `directions` random directions the point that is furthest along it, among those that are
/// at least `least_length` from the mean: all in the coordinates of the shape, so that the directions are
/// spread as the points are.
///
/// Returns   the same for any shards, processes and threads: the largest product in single precision, of
///           equal ones the first row.
/// Cost      one pass; directions x dimension multiply-adds for each point that is so far out.
RowList find_direction_extremes(const PointShards& shards, const SampleShape& shape, double least_length,
                                std::size_t directions, std::uint64_t seed);

}  // namespace ndhull
