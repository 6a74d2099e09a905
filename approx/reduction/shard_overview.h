// A first look at all points: how far each column reaches, and some rows.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "approx/reduction/point_shards.h"

namespace ndhull {

/// Extent of each column. [input units]
struct ColumnRanges {
  std::vector<double> low, high;
};

/// Over the points of all processes; nothing when a coordinate is not finite. Cost  one pass.
std::optional<ColumnRanges> find_column_ranges(const PointShards& shards,
                                               const std::vector<ShardBlock>& blocks);

/// Some `count` points of all, evenly spread over their rows.
struct RowSample {
  std::size_t step = 1;      ///< row i of the sample is row i * step of the set
  std::vector<double> rows;  ///< row-major
};
RowSample take_sample(const PointShards& shards, std::size_t count);

}  // namespace ndhull
