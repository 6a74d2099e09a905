// Which lanes of a vector are set, in order: what moves them to its front.
#pragma once

#include <array>
#include <cstdint>

namespace ndhull {

/// Row b: the numbers of the bits that are set in b, ascending; then the other numbers below 8.
using LaneOrders = std::array<std::array<std::uint8_t, 8>, 256>;

constexpr LaneOrders make_lane_orders() {
  LaneOrders orders{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::size_t front = 0, back = static_cast<std::size_t>(__builtin_popcount(bits));
    for (std::uint8_t lane = 0; lane < 8; ++lane) orders[bits][bits >> lane & 1 ? front++ : back++] = lane;
  }
  return orders;
}

alignas(64) inline constexpr LaneOrders kLaneOrders = make_lane_orders();

}  // namespace ndhull
