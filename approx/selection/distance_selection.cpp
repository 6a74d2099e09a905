// The greedy half of approx/selection/outer_distance.h: planes that keep the furthest vertex near.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "approx/geometry/boundedness.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/outer_distance.h"
#include "approx/selection/plane_candidates.h"
#include "core/dense_views.h"
#include "core/error.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Ids = std::vector<std::uint32_t>;

constexpr int kExchangeRounds = 3;
constexpr std::uint64_t kMostSimplices = 200'000;
/// A round adds this part of the planes that are missing, at least one.
constexpr std::size_t kAddingRounds = 16;
constexpr Index kBlock = 256;

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
  DistanceChoice(const Hull& hull, std::size_t count, const WorkEnd& end) : count_(count), end_(end) {
    facets_.resize(hull.facet_count());
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) facets_[row] = FacetId{row};
    std::sort(facets_.begin(), facets_.end(), [&hull](FacetId a, FacetId b) {
      const double area_a = hull.area_of(a), area_b = hull.area_of(b);
      return area_a != area_b ? area_a > area_b : a < b;
    });
    if (facets_.size() > kMostCandidates) {
      std::vector<FacetId> few(facets_.begin(), facets_.begin() + kMostCandidates);
      planes_ = outer_planes_about_interior(hull, few);
      if (is_bounded()) facets_ = std::move(few);
    }
    planes_ = outer_planes_about_interior(hull, facets_);
  }

  std::vector<FacetId> choose() {
    if (facets_.size() <= count_) return sorted_facets(first(facets_.size()));
    Ids chosen = complete_to_bounded(planes_.normals, planes_.rank, {});
    add_planes(chosen);
    if (chosen.size() <= kMostExchanged) exchange(chosen);
    if (end_.is_here()) return sorted_facets(chosen);
    const Ids largest = first(count_);
    const auto of_largest = furthest(largest), of_chosen = furthest(chosen);
    if (of_largest && of_chosen && of_largest->height < of_chosen->height) chosen = largest;
    return sorted_facets(chosen);
  }

 private:
  bool is_bounded() const { return find_open_direction(planes_.normals, planes_.rank).bounded; }

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

  /// The vertices of the polytope below these planes, the furthest first; nothing when it has none or too
  /// many.
  std::vector<Spike> spikes(const Ids& ids) const {
    PlanesAboutOrigin some;
    some.rank = planes_.rank;
    for (const std::uint32_t id : ids) {
      const auto normal = planes_.normals.begin() + static_cast<std::ptrdiff_t>(id * planes_.rank);
      some.normals.insert(some.normals.end(), normal, normal + static_cast<std::ptrdiff_t>(planes_.rank));
      some.heights.push_back(planes_.heights[id]);
    }
    std::vector<Spike> spikes;
    HullOptions options;
    options.limits.max_facets = kMostSimplices;
    options.limits.max_seconds = end_.seconds_left();
    options.stop = end_.stop();
    options.threads = 1;
    options.wants_partial = false;
    const PlanePolytope polytope = intersect_about_origin(some, options);
    if (!polytope.bounded || polytope.status != HullStatus::kComplete) return spikes;
    const auto rank = static_cast<Index>(planes_.rank);
    const auto plane_count = static_cast<Index>(planes_.heights.size());
    const Eigen::Map<const RowMatrix> normals(planes_.normals.data(), plane_count, rank);
    const Eigen::Map<const Eigen::VectorXd> heights(planes_.heights.data(), plane_count);
    const Eigen::Map<const RowMatrix> vertices(polytope.vertices.data(),
                                               static_cast<Index>(polytope.vertex_count(planes_.rank)), rank);
    Eigen::MatrixXd above;
    for (Index begin = 0; begin < vertices.rows(); begin += kBlock) {
      if (end_.is_here()) return {};
      const Index used = std::min(kBlock, vertices.rows() - begin);
      above.noalias() = normals * vertices.middleRows(begin, used).transpose();
      above.colwise() -= heights;
      for (Index k = 0; k < used; ++k) {
        Index plane = 0;
        const double height = above.col(k).maxCoeff(&plane);
        spikes.push_back({height, static_cast<std::uint32_t>(plane)});
      }
    }
    std::sort(spikes.begin(), spikes.end());
    return spikes;
  }

  std::optional<Spike> furthest(const Ids& ids) const {
    const std::vector<Spike> all = spikes(ids);
    if (all.empty()) return std::nullopt;
    return all.front();
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
        const std::optional<Spike> then = furthest(others);
        if (!then || then->height >= now->height) continue;
        chosen = std::move(others);
        now = then;
        has_changed = true;
      }
      if (!has_changed) break;
    }
  }

  std::size_t count_;
  const WorkEnd& end_;
  std::vector<FacetId> facets_;  // candidates, largest first
  PlanesAboutOrigin planes_;     // their outer planes
};

}  // namespace

std::vector<FacetId> choose_for_distance(const Hull& hull, std::size_t count, const WorkEnd& end) {
  if (hull.rank == 0) return {};
  if (count <= hull.rank) {
    throw Error(ErrorCode::kUsage, "selection for distance: found " + std::to_string(count) +
                                       " facets wanted, expected at least " + std::to_string(hull.rank + 1) +
                                       ": fewer planes bound no region");
  }
  return DistanceChoice(hull, count, end).choose();
}

}  // namespace ndhull
