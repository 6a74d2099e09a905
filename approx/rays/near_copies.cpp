#include "approx/rays/near_copies.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "core/ids.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

/// Ids in an order, from which they are removed.
class Chain {
 public:
  explicit Chain(std::span<const std::uint32_t> order)
      : before_(order.size(), kNone), after_(order.size(), kNone) {
    for (std::size_t at = 1; at < order.size(); ++at) {
      before_[order[at]] = order[at - 1];
      after_[order[at - 1]] = order[at];
    }
  }
  /// The nearest one that is left; kNone: the end. Of one that was removed: as it was then.
  std::uint32_t before(std::uint32_t id) const { return before_[id]; }
  std::uint32_t after(std::uint32_t id) const { return after_[id]; }
  void remove(std::uint32_t id) {
    if (before_[id] != kNone) after_[before_[id]] = after_[id];
    if (after_[id] != kNone) before_[after_[id]] = before_[id];
  }

 private:
  std::vector<std::uint32_t> before_, after_;
};

}  // namespace

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
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
  const auto is_near = [&](std::uint32_t a, std::uint32_t b) {
    double distance_sq = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      const double difference = rows[a * dimension + k] - rows[b * dimension + k];
      distance_sq += difference * difference;
    }
    return distance_sq <= distance * distance;
  };
  // Each point that stands for itself takes all that are near and left; what is taken, and what has had its
  // turn, leaves the chain of those along the direction, or many copies of a point would all be met by each.
  Chain chain(order);
  std::vector<std::uint32_t> first_of(count, kNone);
  for (std::uint32_t id = 0; id < count; ++id) {
    if (first_of[id] != kNone) continue;
    first_of[id] = id;
    const auto try_one = [&](std::uint32_t other) {
      if (std::abs(key[other] - key[id]) > reach) return false;
      if (is_near(id, other)) {
        first_of[other] = id;
        chain.remove(other);
      }
      return true;
    };
    for (std::uint32_t other = chain.before(id); other != kNone && try_one(other);)
      other = chain.before(other);
    for (std::uint32_t other = chain.after(id); other != kNone && try_one(other);) other = chain.after(other);
    chain.remove(id);
  }
  return first_of;
}

}  // namespace ndhull
