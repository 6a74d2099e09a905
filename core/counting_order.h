// Sorting by keys that are few.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace ndhull {

/// The places 0, 1, ... of the keys in ascending order of the keys, equal ones as they stand: a counting sort.
///
/// Shapes  keys: whole numbers below `count`, whatever their type.
/// Cost    O(keys + count), one thread.
template <class Key>
std::vector<std::uint32_t> counting_order(std::span<const Key> keys, std::size_t count) {
  std::vector<std::uint32_t> next(count), order(keys.size());
  for (const Key key : keys) ++next[static_cast<std::size_t>(key)];
  std::exclusive_scan(next.begin(), next.end(), next.begin(), 0u);
  for (std::uint32_t place = 0; place < order.size(); ++place)
    order[next[static_cast<std::size_t>(keys[place])]++] = place;
  return order;
}

}  // namespace ndhull
