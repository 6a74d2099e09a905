#include "approx/reduction/shard_overview.h"

#include <algorithm>
#include <cmath>

#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Rows that are copied at a time.
constexpr std::size_t kCopiedAtATime = 1024;

/// Widens the ranges by rows begin .. end; false when one of their coordinates is not finite.
template <class Scalar>
bool add_rows(const PointView& points, std::size_t begin, std::size_t end, double* low, double* high) {
  const Scalar* const data = static_cast<const Scalar*>(points.data);
  constexpr std::size_t kRowsInCache = 64;
  double sum = 0.0;
  for (std::size_t first = begin; first < end; first += kRowsInCache) {
    const std::size_t last = std::min(end, first + kRowsInCache);
    for (std::size_t k = 0; k < points.dimension; ++k) {
      const Scalar* const column = data + k * points.column_stride;
      Scalar least = static_cast<Scalar>(HUGE_VAL), most = -least, products = 0;
      for (std::size_t row = first; row < last; ++row) {
        const Scalar x = column[row * points.row_stride];
        least = std::min(least, x);
        most = std::max(most, x);
        products += Scalar{0} * x;  // NaN where x is not finite
      }
      low[k] = std::min(low[k], static_cast<double>(least));
      high[k] = std::max(high[k], static_cast<double>(most));
      sum += static_cast<double>(products);
    }
  }
  return sum == 0.0;
}

}  // namespace

std::optional<ColumnRanges> find_column_ranges(const PointShards& shards,
                                               const std::vector<ShardBlock>& blocks) {
  const std::size_t dimension = shards.dimension;
  std::vector<double> lows(blocks.size() * dimension, HUGE_VAL), highs(lows.size(), -HUGE_VAL);
  std::vector<std::uint8_t> is_finite(blocks.size(), 1);
  for_each_shard_block(shards, blocks, [&](std::size_t index, const ShardBlock& block) {
    const PointView& points = shards.parts[block.part].points;
    const auto add = points.type == ScalarType::kFloat64 ? add_rows<double> : add_rows<float>;
    is_finite[index] = add(points, block.begin, block.end, lows.data() + index * dimension,
                           highs.data() + index * dimension);
  });
  // -low, so that all that processes say is to be maximised.
  std::vector<double> mine(2 * dimension, -HUGE_VAL);
  for (std::size_t i = 0; i < lows.size(); ++i) {
    mine[i % dimension] = std::max(mine[i % dimension], -lows[i]);
    mine[dimension + i % dimension] = std::max(mine[dimension + i % dimension], highs[i]);
  }
  const std::vector<double> all = shards.all_gather(mine);
  ColumnRanges ranges{std::vector<double>(dimension, HUGE_VAL), std::vector<double>(dimension, -HUGE_VAL)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t column = i % dimension;
    if (i / dimension % 2 == 0) {
      ranges.low[column] = std::min(ranges.low[column], -all[i]);
    } else {
      ranges.high[column] = std::max(ranges.high[column], all[i]);
    }
  }
  if (shards.any(std::count(is_finite.begin(), is_finite.end(), 0) != 0)) return std::nullopt;
  return ranges;
}

RowSample take_sample(const PointShards& shards, std::size_t count) {
  const std::size_t dimension = shards.dimension, step = std::max<std::size_t>(1, shards.rows / count);
  std::vector<std::size_t> rows;
  for (const PointShard& part : shards.parts) {
    const std::size_t end = part.first_row + part.points.rows;
    for (std::size_t row = (part.first_row + step - 1) / step * step; row < end; row += step)
      rows.push_back(row);
  }
  std::vector<double> sample(rows.size() * dimension);
  for_each_block(rows.size(), kCopiedAtATime, [&](std::size_t begin, std::size_t end) {
    RowCopier copier(shards);
    for (std::size_t i = begin; i < end; ++i) copier.copy(rows[i], sample.data() + i * dimension);
  });
  return {step, shards.all_gather(std::move(sample))};
}

}  // namespace ndhull
