#include "approx/slabs/slab_choice.h"

#include <algorithm>
#include <queue>

namespace ndhull {
namespace {

void count_up(std::uint8_t& count) {
  if (count < 255) ++count;
}

}  // namespace

std::vector<std::uint32_t> choose_slabs(std::span<const MemberRange> slabs,
                                        std::span<const std::uint32_t> members,
                                        std::span<const std::uint8_t> hits) {
  std::vector<std::uint8_t> times(hits.size(), 0);  // chosen slabs that hold it, at most 255
  // Of holding it: 0 once a chosen slab does. Whole numbers: their sums are exact, and quick.
  std::vector<std::uint16_t> worth(hits.size(), 0);
  for (std::size_t row = 0; row < worth.size(); ++row)
    if (hits[row] > 0) worth[row] = static_cast<std::uint16_t>(0xFFFFu / hits[row]);
  const auto gain_of = [&](std::uint32_t slab) {
    std::uint64_t gain = 0;
    for (std::size_t i = slabs[slab].begin; i < slabs[slab].end; ++i) gain += worth[members[i]];
    return gain;
  };
  struct Offer {
    std::uint64_t gain;
    std::uint32_t slab;
    bool operator<(const Offer& other) const {
      return gain != other.gain ? gain < other.gain : slab > other.slab;
    }
  };
  std::vector<Offer> first_offers;
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t slab = 0; slab < slabs.size(); ++slab) {
    if (slabs[slab].begin == slabs[slab].end) continue;
    const std::uint32_t seed = members[slabs[slab].begin];
    if (slabs[slab].end - slabs[slab].begin > 1 || hits[seed] > 1) {
      first_offers.push_back({gain_of(slab), slab});
    } else {  // no other slab holds its simplex
      chosen.push_back(slab);
      times[seed] = 1;
    }
  }
  std::sort(first_offers.begin(), first_offers.end(), [](const Offer& a, const Offer& b) { return b < a; });
  std::priority_queue<Offer> offers;  // those that have become less
  for (std::size_t next = 0; next < first_offers.size() || !offers.empty();) {
    const bool is_first = offers.empty() || (next < first_offers.size() && offers.top() < first_offers[next]);
    const Offer best = is_first ? first_offers[next++] : offers.top();
    if (!is_first) offers.pop();
    const std::uint64_t gain = gain_of(best.slab);  // gains only fall: an old one is an upper bound
    if (gain == 0) continue;
    const Offer now{gain, best.slab};
    if ((!offers.empty() && now < offers.top()) || (next < first_offers.size() && now < first_offers[next])) {
      offers.push(now);
      continue;
    }
    chosen.push_back(best.slab);
    for (std::size_t i = slabs[best.slab].begin; i < slabs[best.slab].end; ++i) {
      count_up(times[members[i]]);
      worth[members[i]] = 0;
    }
  }
  std::vector<std::uint32_t> kept;
  for (std::size_t c = chosen.size(); c-- > 0;) {
    const MemberRange& slab = slabs[chosen[c]];
    const auto begin = members.begin() + static_cast<std::ptrdiff_t>(slab.begin);
    const auto end = members.begin() + static_cast<std::ptrdiff_t>(slab.end);
    // A simplex in 255 slabs or more counts as in just so many: a slab too many may stay.
    if (std::any_of(begin, end, [&](std::uint32_t row) { return times[row] == 1; })) {
      kept.push_back(chosen[c]);
    } else {
      std::for_each(begin, end, [&](std::uint32_t row) { --times[row]; });
    }
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

}  // namespace ndhull
