#include "approx/rays/near_copies.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/portable_random.h"

namespace ndhull {

std::vector<std::uint32_t> find_near_copies(const double* rows, std::size_t count, std::size_t dimension,
                                            double distance) {
  constexpr std::uint64_t kSeed = 1;
  PortableRandom random(kSeed);
  std::vector<double> direction(dimension), key(count, 0.0);
  double length_sq = 0.0, largest = 0.0;
  for (double& x : direction) {
    x = random.normal();
    length_sq += x * x;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < dimension; ++k) {
      key[i] += direction[k] * rows[i * dimension + k];
      largest = std::max(largest, std::abs(rows[i * dimension + k]));
    }
  }
  // Equal points have equal keys; those of others are off by their rounding.
  const auto terms = static_cast<double>(dimension);
  const double rounding = distance > 0.0 ? 4.0 * terms * terms * 0x1p-52 * largest : 0.0;
  const double reach = (distance + rounding) * std::sqrt(length_sq);
  std::vector<std::uint32_t> order(count), place(count), first_of(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
  for (std::uint32_t at = 0; at < count; ++at) place[order[at]] = at;
  const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
    double distance_sq = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      const double difference = rows[a * dimension + k] - rows[b * dimension + k];
      distance_sq += difference * difference;
    }
    return distance_sq <= distance * distance;
  };
  for (std::uint32_t id = 0; id < count; ++id) {
    first_of[id] = id;
    const auto try_one = [&](std::uint32_t at) {
      const std::uint32_t other = order[at];
      if (std::abs(key[other] - key[id]) > reach) return false;
      if (other < first_of[id] && first_of[other] == other && is_near(other, id)) first_of[id] = other;
      return true;
    };
    for (std::uint32_t at = place[id]; at > 0 && try_one(at - 1);) --at;
    for (std::uint32_t at = place[id]; at + 1 < count && try_one(at + 1);) ++at;
  }
  return first_of;
}

}  // namespace ndhull
