// More time for fewer facets: the part of approx/trade/approximation.h that looks further.
//
// Idea. What slabs and joins leave are facets that could not take a whole neighbour any more. So pairs join
// into facets somewhat wider than may be, the narrowest first, and then simplices change facets and planes
// turn (approx/trade/facet_balance.h), which makes most of them as narrow as they have to be. Of those that
// stay too wide the deepest simplex becomes a facet of its own, until none is: fewer come back than had
// joined.
#include <algorithm>
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
/// What joining takes: for a facet, for each dimension of it, and for a row.
constexpr std::size_t kFacetBytes = 700, kFacetBytesOfRank = 80, kRowBytes = 24;

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

}  // namespace ndhull
