// More time for fewer facets, or narrower ones: the part of approx/trade/approximation.h that looks further.
//
// Idea. What slabs and joins leave are facets that could not take a whole neighbour any more. So pairs join
// into facets somewhat wider than may be, the narrowest first, and then simplices change facets and planes
// turn (approx/trade/facet_balance.h), which makes most of them as narrow as they have to be. Of those that
// stay too wide the deepest simplex becomes a facet of its own, until none is: fewer come back than had
// joined.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "approx/trade/approximation.h"
#include "approx/trade/facet_balance.h"

namespace ndhull {
namespace {

/// Pairs join into facets this much wider than may be; by this part less each time.
constexpr double kLooser = 0.3, kLooserLessEachTime = 0.8;
constexpr int kMostCycles = 8, kMostCyclesQuick = 1;
/// Turns before facets that are still too wide are split, and at most after that.
constexpr int kQuietTurns = 4, kMostSplits = 12;
/// A cycle that leaves more than this part of the facets was the last.
constexpr double kHardlyFewer = 0.995;
/// Turns in single precision make a facet wider by less than this part.
constexpr double kTurnError = 1e-6;
constexpr int kMostRoundsOfPoints = 6;
/// What joining takes: for a facet, for each dimension of it, and for a row.
constexpr std::size_t kFacetBytes = 700, kFacetBytesOfRank = 80, kRowBytes = 24;
/// Widths that are looked into for a number of facets; how much narrower one has to be at least, and up to
/// which part of the number it is not enough.
constexpr int kMostWidths = 8, kMostInVain = 2;
constexpr double kLeastNarrower = 0.004, kNearlyAll = 0.995;
/// Logarithms of widths as near each other say nothing of the power.
constexpr double kTellsOfPower = 0.02;

bool is_too_wide(const FittedPlane& plane, double cap) { return is_measured(plane) && plane.width() > cap; }

std::size_t count_too_wide(const Covering& covering, double cap) {
  const auto is_one = [&](const FittedPlane& plane) { return is_too_wide(plane, cap); };
  return static_cast<std::size_t>(std::count_if(covering.planes.begin(), covering.planes.end(), is_one));
}

/// Facets that are too wide fall into what each facet of another covering has of them, with its plane. A
/// simplex with points far above it need not fit below a plane of its own that turning finds.
void take_parts_of(const Covering& narrow, double cap, Covering& covering) {
  std::vector<FittedPlane> planes;
  std::vector<std::uint32_t> new_id(covering.planes.size(), kNone);
  covering.widest = 0.0;
  const auto add = [&](const FittedPlane& plane) {
    if (is_measured(plane)) covering.widest = std::max(covering.widest, plane.width());
    planes.push_back(plane);
    return static_cast<std::uint32_t>(planes.size() - 1);
  };
  for (std::size_t facet = 0; facet < covering.planes.size(); ++facet)
    if (!is_too_wide(covering.planes[facet], cap)) new_id[facet] = add(covering.planes[facet]);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> parts;
  for (std::size_t row = 0; row < covering.facet_of.size(); ++row) {
    std::uint32_t& facet = covering.facet_of[row];
    if (facet == kNone) continue;
    if (new_id[facet] != kNone) {
      facet = new_id[facet];
      continue;
    }
    const auto [part, is_new] = parts.try_emplace({facet, narrow.facet_of[row]}, 0);
    if (is_new) part->second = add(narrow.planes[narrow.facet_of[row]]);
    facet = part->second;
  }
  covering.planes = std::move(planes);
}

}  // namespace

/// As few facets as are found that are no wider than this over the points of the space. False: there are
/// none, and nothing has changed. Facets may be too wide before.
bool Approximation::look_further(double width, Covering& covering) {
  const std::size_t bytes = covering.planes.size() * (kFacetBytes + kFacetBytesOfRank * space_->rank()) +
                            covering.facet_of.size() * kRowBytes;
  if (bytes > growth_.bytes_left() || growth_.is_late()) return false;
  const double cap = width * (1.0 - kTurnError);
  FacetBalance balance(growth_.work().complex, *space_, is_convex(), covering);
  const auto join = [&](double widest) {
    if (growth_.is_late()) return;
    Covering joined = balance.covering();
    join_neighbours(joined, widest);
    if (joined.planes.size() < balance.covering().planes.size()) balance.set_joined(std::move(joined));
  };
  bool is_found = covering.widest <= width;
  balance.turn();
  double looser = kLooser;
  const int most_cycles = is_thorough() ? kMostCycles : kMostCyclesQuick;
  for (int cycle = 0; cycle < most_cycles && !growth_.is_late(); ++cycle, looser *= kLooserLessEachTime) {
    join((1.0 + looser) * cap);
    for (int turn = 0; turn < kQuietTurns && !growth_.is_late(); ++turn) balance.turn();
    for (int turn = 0; turn < kMostSplits && !growth_.is_late(); ++turn) {
      const std::size_t wide = count_too_wide(balance.covering(), cap);
      if (wide == 0) break;
      balance.split_widest(wide);
      balance.turn();
    }
    join(cap);
    balance.turn();  // those alone are as they were made
    Covering found = balance.covering();
    if (count_too_wide(found, cap) > 0) {
      if (!is_found) continue;
      take_parts_of(covering, cap, found);
    }
    const std::size_t before = covering.planes.size(), now = found.planes.size();
    if ((is_found && now >= before) || !keeps_hull(found)) break;
    covering = std::move(found);
    const bool was_last = is_found && static_cast<double>(now) > kHardlyFewer * static_cast<double>(before);
    is_found = true;
    if (was_last) break;
  }
  return is_found;
}

/// Fewer facets than a covering that fits over all points. What the fits have not seen may be above the
/// fewer: then they see it, and it is looked for again.
void Approximation::look_for_fewer(double width, Covering& covering) {
  for (int round = 0; round < kMostRoundsOfPoints; ++round) {
    Covering fewer = covering;
    if (!look_further(width, fewer) || fewer.planes.size() >= covering.planes.size()) return;
    const TrueWidths widths = true_widths(fewer);
    if (widths.widest() <= width) {
      covering = std::move(fewer);
      return;
    }
    const std::size_t known = extra_.size();
    add_offenders(fewer, widths, width);
    if (extra_.size() == known) return;
    make_space(true);
  }
}

/// So many facets, narrower: their number falls like a power of the width, which shows from width to width.
void Approximation::look_for_narrower(std::uint64_t count, CountSearch& search) {
  const double wanted = kNearlyAll * static_cast<double>(count);
  const double power_of_ball = std::max(1.0, 0.5 * (static_cast<double>(space_->rank()) - 1.0));
  double power = power_of_ball, width = search.width, last_width = HUGE_VAL, last_count = 0.0;
  int in_vain = 0;
  for (int i = 0; i < kMostWidths && search.width > flat() && !growth_.is_late(); ++i) {
    Covering covering = search.narrowest;
    if (!look_further(width, covering)) {
      if (i == 0 || ++in_vain == kMostInVain) return;
      width = 0.5 * (width + search.width);
      continue;
    }
    const double before = search.width, found = static_cast<double>(covering.planes.size());
    const bool is_narrower =
        covering.planes.size() <= count && consider(covering, search.slab, search) < before;
    if (i > 0 && !is_narrower && ++in_vain == kMostInVain) return;
    if (i > 0 && is_narrower && found >= wanted) return;
    if (std::abs(std::log(last_width / width)) > kTellsOfPower) {
      if (i > 0)
        power = std::clamp(std::log(found / last_count) / std::log(last_width / width), 1.0, power_of_ball);
      last_width = width;
      last_count = found;
    }
    width = std::min(width * std::pow(found / wanted, 1.0 / power), (1.0 - kLeastNarrower) * search.width);
  }
}

}  // namespace ndhull
