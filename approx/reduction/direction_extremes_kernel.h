// The vector loop of directional extremes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ndhull {

/// Points that are multiplied with all directions at a time; their coordinates stay in the first-level cache.
inline constexpr std::size_t kExtremeTile = 128;

/// The furthest point along one direction.
struct DirectionExtreme {
  static constexpr std::uint32_t kNoPoint = 0xFFFF'FFFFu;
  float product;
  std::uint32_t id = kNoPoint;
  /// Of points as far as each other the one with the lowest id is meant.
  bool is_before(const DirectionExtreme& other) const {
    return product != other.product ? product > other.product : id < other.id;
  }
};

/// Replaces the extremes that one of the points is beyond; of several as far as each other by the first.
/// Products are sums of rounded products, not fused: the same on every machine.
///
/// Shapes  columns: rank x kExtremeTile, the points in columns, anything behind the last one. ids: of the
///         points, at most kExtremeTile. directions: rank numbers for each of the extremes.
void raise_extremes(const float* columns, std::size_t rank, std::span<const std::uint32_t> ids,
                    const float* directions, std::span<DirectionExtreme> extremes);

}  // namespace ndhull
