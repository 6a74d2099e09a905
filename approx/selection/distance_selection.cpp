// The greedy half of approx/selection/outer_distance.h: planes that keep the furthest vertex near.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "approx/geometry/boundedness.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/outer_distance.h"
#include "approx/selection/plane_candidates.h"
#include "approx/selection/volume_rays.h"
#include "core/error.h"
#include "core/linear/column_table.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Ids = std::vector<std::uint32_t>;

constexpr int kExchangeRounds = 3;
constexpr std::uint64_t kMostSimplices = 200'000;
/// A round adds this part of the planes that are missing, at least one.
constexpr std::size_t kAddingRounds = 16;
/// Vertices that threads look at side by side, and those of them that one thread takes.
constexpr std::size_t kVerticesInTurn = 512, kVerticesOfThread = 32;

/// A vertex of the polytope: how far above the hull's facets, and above which most.
struct Spike {
  double height;
  std::uint32_t plane;
  bool operator<(const Spike& other) const {  // the furthest comes first
    return height != other.height ? height > other.height : plane < other.plane;
  }
};

class DistanceChoice {
 public:
  DistanceChoice(const Hull& hull, std::size_t count, const WorkEnd& end, const PointView* points)
      : hull_(hull),
        points_(points),
        count_(count),
        end_(end),
        facets_(plane_candidates(hull, count)),
        planes_(outer_planes_about_interior(hull, facets_)) {}

  std::vector<FacetId> choose() {
    if (facets_.size() <= count_) return sorted_facets(first(facets_.size()));
    table_.emplace(planes_.rank, facets_.size());
    for (std::size_t row = 0; row < facets_.size(); ++row)
      table_->set(row, {planes_.normals.data() + row * planes_.rank, planes_.rank}, planes_.heights[row]);
    const Ids start = complete_to_bounded(planes_.normals, planes_.rank, {});
    Ids chosen = start;
    add_planes(chosen);
    if (chosen.size() <= kMostExchanged) exchange(chosen);
    if (end_.is_here()) return sorted_facets(chosen);
    Reach least = reach(chosen);
    const auto consider = [&](Ids others) {
      const Reach its = reach(others);
      if (end_.is_here() || its >= least) return;
      least = its;
      chosen = std::move(others);
    };
    consider(first(count_));
    Ids for_volume = choose_by_rays(even_planes(), start, count_, end_);
    if (for_volume.size() <= kMostExchanged) exchange(for_volume);
    consider(std::move(for_volume));
    return sorted_facets(chosen);
  }

 private:
  /// Distance of the furthest vertex from the hull, where that is known, then its height; infinite without
  /// one.
  using Reach = std::pair<double, double>;

  Reach reach(const Ids& ids) const {
    const std::optional<Spike> highest = furthest(ids);
    if (!highest) return {HUGE_VAL, HUGE_VAL};
    std::optional<double> distance;
    if (points_ != nullptr) {
      const Limits limits{.max_facets = kMostSimplices, .max_seconds = end_.seconds_left()};
      distance = outer_distance(hull_, *points_, sorted_facets(ids), limits, 1, end_.stop()).distance;
    }
    return {distance.value_or(HUGE_VAL), highest->height};
  }

  /// The planes a . y <= 1, spread evenly.
  RowMatrix even_planes() const {
    RowMatrix rows = as_rows(planes_.normals, planes_.rank);
    for (std::size_t row = 0; row < facets_.size(); ++row)
      rows.row(static_cast<Eigen::Index>(row)) /= planes_.heights[row];
    return rows * even_spread_map(rows);
  }

  static Ids first(std::size_t count) {
    Ids ids(count);
    std::iota(ids.begin(), ids.end(), 0U);
    return ids;
  }

  std::vector<FacetId> sorted_facets(const Ids& ids) const {
    std::vector<FacetId> facets;
    for (const std::uint32_t id : ids) facets.push_back(facets_[id]);
    std::sort(facets.begin(), facets.end());
    return facets;
  }

  /// The polytope below these planes; nothing when there is none or it has too many vertices.
  std::optional<PlanePolytope> polytope_of(const Ids& ids) const {
    PlanesAboutOrigin some;
    some.rank = planes_.rank;
    for (const std::uint32_t id : ids) {
      const auto normal = planes_.normals.begin() + static_cast<std::ptrdiff_t>(id * planes_.rank);
      some.normals.insert(some.normals.end(), normal, normal + static_cast<std::ptrdiff_t>(planes_.rank));
      some.heights.push_back(planes_.heights[id]);
    }
    HullOptions options;
    options.limits.max_facets = kMostSimplices;
    options.limits.max_seconds = end_.seconds_left();
    options.stop = end_.stop();
    options.threads = 1;
    options.wants_partial = false;
    PlanePolytope polytope = intersect_about_origin(some, options);
    if (!polytope.bounded || polytope.status != HullStatus::kComplete) return std::nullopt;
    return polytope;
  }

  /// Of these vertices, rows of the polytope's.
  void find_heights(const PlanePolytope& polytope, std::span<const std::uint32_t> rows,
                    std::span<Spike> spikes) const {
    for_each_block(rows.size(), kVerticesOfThread, [&](std::size_t begin, std::size_t end) {
      std::vector<double> multipliers(planes_.rank + 1, -1.0);
      for (std::size_t place = begin; place < end; ++place) {
        std::copy_n(polytope.vertices.data() + rows[place] * planes_.rank, planes_.rank, multipliers.data());
        const ColumnTable::Best best = table_->largest_product(multipliers);
        spikes[place] = {best.product, static_cast<std::uint32_t>(best.column)};
      }
    });
  }

  /// The vertices of the polytope below these planes, the furthest first; nothing when it has none or too
  /// many.
  std::vector<Spike> spikes(const Ids& ids) const {
    const std::optional<PlanePolytope> polytope = polytope_of(ids);
    if (!polytope) return {};
    std::vector<std::uint32_t> rows(polytope->vertex_count(planes_.rank));
    std::iota(rows.begin(), rows.end(), 0U);
    std::vector<Spike> spikes(rows.size());
    for (std::size_t first = 0; first < rows.size(); first += kVerticesInTurn) {
      if (end_.is_here()) return {};
      const std::size_t used = std::min(kVerticesInTurn, rows.size() - first);
      find_heights(*polytope, std::span(rows).subspan(first, used), std::span(spikes).subspan(first, used));
    }
    std::sort(spikes.begin(), spikes.end());
    return spikes;
  }

  /// The first of `spikes`, or one that is at least so high. No vertex is further above a plane than it is
  /// away from the origin, so the furthest ones are looked at, and the rest where that does not settle it.
  std::optional<Spike> furthest(const Ids& ids, double enough = HUGE_VAL) const {
    const std::optional<PlanePolytope> polytope = polytope_of(ids);
    if (!polytope) return std::nullopt;
    const auto vertices = as_rows(polytope->vertices, planes_.rank);
    const Eigen::VectorXd away = vertices.rowwise().norm();
    std::vector<std::uint32_t> rows(polytope->vertex_count(planes_.rank));
    std::iota(rows.begin(), rows.end(), 0U);
    std::sort(rows.begin(), rows.end(), [&away](std::uint32_t a, std::uint32_t b) {
      return away[a] != away[b] ? away[a] > away[b] : a < b;
    });
    std::optional<Spike> best;
    std::vector<Spike> spikes(kVerticesInTurn);
    // Few at first, since the furthest vertex is often the highest.
    for (std::size_t first = 0, used = 0; first < rows.size(); first += used) {
      if (best && (best->height >= enough || away[rows[first]] < best->height)) break;
      if (end_.is_here()) return std::nullopt;
      used = std::min({2 * used + kVerticesOfThread, kVerticesInTurn, rows.size() - first});
      find_heights(*polytope, std::span(rows).subspan(first, used), spikes);
      const Spike highest =
          *std::min_element(spikes.begin(), spikes.begin() + static_cast<std::ptrdiff_t>(used));
      if (!best || highest < *best) best = highest;
    }
    return best;
  }

  /// Planes above which the furthest vertices are, until there are count_.
  void add_planes(Ids& chosen) const {
    std::vector<bool> is_chosen(facets_.size(), false);
    for (const std::uint32_t id : chosen) is_chosen[id] = true;
    const auto add = [&](std::uint32_t id) {
      if (is_chosen[id]) return false;
      is_chosen[id] = true;
      chosen.push_back(id);
      return true;
    };
    while (chosen.size() < count_) {
      std::size_t missing = (count_ - chosen.size() + kAddingRounds - 1) / kAddingRounds, added = 0;
      for (const Spike& spike : spikes(chosen)) {
        if (added < missing && add(spike.plane)) ++added;
      }
      if (added > 0) continue;
      // Too many vertices to look at, the hull is reached, or there is no time: the largest of the others.
      for (std::uint32_t id = 0; chosen.size() < count_; ++id) add(id);
    }
  }

  /// Takes each plane out in turn, and puts in the one that the furthest vertex then is furthest above.
  void exchange(Ids& chosen) const {
    std::optional<Spike> now = furthest(chosen);
    for (int round = 0; round < kExchangeRounds && now; ++round) {
      bool has_changed = false;
      for (std::size_t place = 0; place < chosen.size() && !end_.is_here(); ++place) {
        Ids others = chosen;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
        const std::optional<Spike> open = furthest(others);
        if (!open || std::find(others.begin(), others.end(), open->plane) != others.end()) continue;
        others.insert(others.begin() + static_cast<std::ptrdiff_t>(place), open->plane);
        const std::optional<Spike> then = furthest(others, now->height);
        if (!then || then->height >= now->height) continue;
        chosen = std::move(others);
        now = then;
        has_changed = true;
      }
      if (!has_changed) break;
    }
  }

  const Hull& hull_;
  const PointView* points_;  // null: not at hand
  std::size_t count_;
  const WorkEnd& end_;
  std::vector<FacetId> facets_;       // candidates, largest first
  PlanesAboutOrigin planes_;          // their outer planes
  std::optional<ColumnTable> table_;  // the same, each with its height
};

}  // namespace

std::vector<FacetId> choose_for_distance(const Hull& hull, std::size_t count, const WorkEnd& end,
                                         const PointView* points) {
  if (hull.rank == 0) return {};
  if (count <= hull.rank) {
    throw Error(ErrorCode::kUsage, "selection for distance: found " + std::to_string(count) +
                                       " facets wanted, expected at least " + std::to_string(hull.rank + 1) +
                                       ": fewer planes bound no region");
  }
  return DistanceChoice(hull, count, end, points).choose();
}

}  // namespace ndhull
