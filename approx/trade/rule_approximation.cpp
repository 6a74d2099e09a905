#include "approx/trade/rule_approximation.h"

#include <utility>
#include <vector>

#include "approx/growth/outside_points.h"
#include "approx/slabs/merge_rule.h"
#include "approx/trade/cluster_merge.h"

namespace ndhull {
namespace {

/// Of W alone: what is left out is no further above any simplex, where that is affordable. The outer planes
/// of a hull come in steps, one vertex each: to be clearly below W costs 3 % more facets on 10^5 sphere
/// points in 6-d with W 0.2, and 1 % of the width is gained.
constexpr double kAloneShare = 0.995;
/// Rounds of points that go back before the best so far is taken: those that are where they were not located,
/// and those that a search finds, few at a time.
constexpr int kRoundsOfLocating = 24, kRoundsOfSearch = 96;

}  // namespace

ApproximateFacets RuleApproximation::run() {
  ApproximateFacets found;
  grow_outside_width();
  growth_.drop_grower();
  if (accuracy_.merges_neighbours() && growth_.may_cover()) found.clusters = merge();
  return found;
}

void RuleApproximation::grow_outside_width() {
  const double width = lengths_.outside_width;
  hull_.chosen.outside_width = width;
  if (width > 0.0) growth_.grow_from_some();  // a search over all follows
  if (growth_.grow_to(width, 0, 0.0) && width > 0.0 && search_outside(width)) return;
  locate_and_go_on(width);
  for (int round = 0; round < kRoundsOfLocating && !growth_.is_limited() && growth_.repair(); ++round) {
    growth_.grow_to(width, 0, 0.0);
    locate_and_go_on(width);
  }
}

/// Takes in what is further above any simplex. True when all is known of the points left out, and nothing is
/// to be located.
bool RuleApproximation::search_outside(double width) {
  // Where most points are inside, proving that leaves few to search. Merging has to know where they are; else
  // the search of many is the certificate as well: of few points and the vertices the facet table has that
  // sooner. To locate a point takes about as long as to search them all for one plane.
  constexpr std::size_t kWorthCertifying = 1 << 13;
  const bool merges = accuracy_.merges_neighbours();
  bool certifies = !merges;
  std::vector<PointId> points = growth_.unproven_points();
  const std::size_t planes = growth_.work().complex.row_count - growth_.work().free_count;
  if (merges || 2 * points.size() < growth_.work().point_count || points.size() < planes) {
    locate_and_go_on(width);
    certifies = !merges && growth_.left_out().size() >= kWorthCertifying;
    points = growth_.left_out_points(certifies);
  }
  const std::size_t count = points.size();
  if (!growth_.may_search(count)) return false;
  OutsideSearch search(growth_, std::move(points), certifies);
  const double wanted = merges ? width : kAloneShare * width;
  bool has_grown = false;
  for (int round = 0; round < kRoundsOfSearch && search.put_back_above(width, wanted); ++round) {
    has_grown = true;
    if (!growth_.grow_to(wanted, 0, 0.0) || !growth_.may_search(count)) return false;
  }
  if (!certifies) return !has_grown;
  const double gauge = search.largest_gauge();
  growth_.certify_by_search(search.points(), gauge, search.take_highest());
  return true;
}

// Many simplices are gathered into slabs first, each well inside what the rule and the cap allow: merging
// them pair by pair would take longer than growing them did.
FacetClusters RuleApproximation::merge() {
  constexpr double kShareOfSlabs = 0.8;  // of the cap
  const double cap = lengths_.width_cap * (1.0 - 1e-9);
  MergeRule rule{.centrum_radius = lengths_.centrum_radius,
                 .max_cosine = accuracy_.max_cosine,
                 .width_cap = cap,
                 .least_facets = growth_.work().rank + 1};
  Covering covering;
  MergeCounts counts;
  for (int round = 0; round < kWidthRounds;) {
    make_space(true);
    const SimplexRule simplex_rule(growth_.work().complex, *space_, rule, is_convex());
    SlabCover cover(growth_.work().complex, *space_, is_convex(), &simplex_rule);
    covering = cover.cover(kShareOfSlabs * rule.width_cap, CoverEffort{.final_fit_steps = 0});
    counts = merge_clusters(growth_.work().complex, *space_, rule, covering);
    if (!keeps_hull(covering) && covering.planes.size() < cover.live_count()) {
      if (rule.width_cap < thinnest()) return FacetClusters{};
      rule.width_cap *= 0.75;  // what was merged bounds no region any more; a hull may be thin
      continue;
    }
    ++round;
    const TrueWidths widths = true_widths(covering);
    const std::size_t known = extra_.size();
    add_offenders(covering, widths, cap);
    if (extra_.size() == known || growth_.is_late()) break;
  }
  hull_.chosen.width_cap = cap;
  hull_.chosen.merges = counts.merges;
  hull_.chosen.refused_merges = counts.refused;
  return facets_of(covering);
}

}  // namespace ndhull
