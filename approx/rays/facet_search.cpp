#include "approx/rays/facet_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "approx/geometry/orthonormal.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"
#include "core/scramble.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// Columns whose extents differ by less than this factor are taken to be in one unit.
constexpr double kOneUnit = 4.0;

std::uint64_t hash_of(std::span<const std::uint32_t> ids) {
  std::uint64_t hash = kScrambleStep;
  for (const std::uint32_t id : ids) hash = scramble(hash + id);
  return hash;
}

std::vector<double> extents_of(const Frame& frame) {
  std::vector<double> extents;
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    extents.push_back(frame.column_max[k] - frame.column_min[k]);
  }
  return extents;
}

bool is_one_unit(const std::vector<double>& extents) {
  double least = HUGE_VAL, most = 0.0;
  for (const double extent : extents) {
    if (extent == 0.0) continue;
    least = std::min(least, extent);
    most = std::max(most, extent);
  }
  return most <= kOneUnit * least;
}

/// Directions uniform in a unit are orthonormal axes of the data's subspace there times normal numbers.
Eigen::MatrixXd direction_map(const Frame& frame, const std::vector<double>& scale) {
  const auto rank = static_cast<Index>(frame.rank), dimension = static_cast<Index>(frame.dimension);
  const Eigen::Map<const RowMatrix> map(frame.map.data(), rank, dimension);
  Eigen::VectorXd scales(dimension);
  for (Index k = 0; k < dimension; ++k) {
    const double extent = scale[static_cast<std::size_t>(k)];
    scales[k] = extent > 0.0 ? extent : 1.0;
  }
  if (frame.rank == frame.dimension) return map * scales.asDiagonal();
  Eigen::MatrixXd spanned = Eigen::Map<const RowMatrix>(frame.basis.data(), rank, dimension).transpose();
  spanned = (scales.cwiseInverse().asDiagonal() * spanned).eval();
  for (Index column = 0; column < rank; ++column) spanned.col(column).normalize();
  return map * scales.asDiagonal() * orthonormal_columns(spanned, rank);
}

}  // namespace

FacetSearch::FacetSearch(RayShooter& shooter, std::uint64_t seed, double max_seconds_of_facet)
    : shooter_(shooter), geometry_(shooter, max_seconds_of_facet), random_(seed) {
  const Frame& frame = shooter.frame();
  std::vector<double> scale = extents_of(frame);
  if (is_one_unit(scale)) {
    std::fill(scale.begin(), scale.end(), 1.0);
  } else {
    direction_unit_ = DirectionUnit::kUnitCube;
  }
  to_direction_ = direction_map(frame, scale);
}

std::vector<double> FacetSearch::random_direction() {
  Eigen::VectorXd normal(to_direction_.cols());
  for (Index k = 0; k < normal.size(); ++k) normal[k] = random_.normal();
  const Eigen::VectorXd direction = to_direction_ * normal;
  return {direction.data(), direction.data() + direction.size()};
}

std::uint32_t FacetSearch::find(std::span<const std::uint32_t> points) const {
  const auto bucket = facets_of_hash_.find(hash_of(points));
  if (bucket == facets_of_hash_.end()) return kNone;
  for (const std::uint32_t facet : bucket->second) {
    const auto known = points_of(facet);
    if (std::equal(known.begin(), known.end(), points.begin(), points.end())) return facet;
  }
  return kNone;
}

std::vector<std::uint32_t> FacetSearch::enter(std::span<const WalkResult> walks) {
  std::vector<std::uint32_t> ids(walks.size(), kNone);
  std::vector<std::size_t> first_walks;  // one for each new facet
  for (std::size_t row = 0; row < walks.size(); ++row) {
    if (walks[row].end != WalkEnd::kFacet) continue;
    const std::vector<std::uint32_t>& on_plane = walks[row].on_plane;
    ids[row] = find(on_plane);
    if (ids[row] != kNone) continue;
    ids[row] = static_cast<std::uint32_t>(facets_.size());
    facets_.emplace_back();
    neighbours_.emplace_back();
    vertices_.emplace_back();
    points_.insert(points_.end(), on_plane.begin(), on_plane.end());
    begins_.push_back(points_.size());
    facets_of_hash_[hash_of(on_plane)].push_back(ids[row]);
    first_walks.push_back(row);
  }
  for_each_block(first_walks.size(), 1, [&](std::size_t one, std::size_t) {
    const WalkResult& walk = walks[first_walks[one]];
    RayFacet made = geometry_.make_facet(walk);
    const std::uint32_t id = ids[first_walks[one]];
    facets_[id].area = made.area;
    facets_[id].area_is_whole = made.area_is_whole;
    if (made.points.size() > walk.basis.size()) vertices_[id] = std::move(made.vertices);
  });
  return ids;
}

void FacetSearch::lead(std::uint32_t first, std::uint32_t ray) {
  std::vector<std::uint32_t> stack = {first};
  while (!stack.empty()) {
    const std::uint32_t id = stack.back();
    stack.pop_back();
    FoundFacet& facet = facets_[id];
    const auto end = facet.rays.begin() + facet.ray_count;
    if (facet.ray_count == FoundFacet::kCountedRays || std::find(facet.rays.begin(), end, ray) != end)
      continue;
    facet.rays[facet.ray_count++] = ray;
    for (const std::uint32_t neighbour : neighbours_[id]) stack.push_back(neighbour);
  }
}

std::vector<std::uint32_t> FacetSearch::shoot(std::size_t rays, std::stop_token stop) {
  std::vector<WalkTask> tasks(rays);
  for (WalkTask& task : tasks) task.direction = random_direction();
  const std::vector<WalkResult> walks = shooter_.walk(tasks, stop);
  const std::vector<std::uint32_t> ids = enter(walks);
  std::vector<std::uint32_t> hit;
  for (std::size_t row = 0; row < rays; ++row) {
    if (walks[row].end == WalkEnd::kNotBegun) continue;
    const auto ray = static_cast<std::uint32_t>(rays_++);
    if (ids[row] == kNone) {
      ++open_rays_;
      continue;
    }
    ++facets_[ids[row]].hits;
    lead(ids[row], ray);
    hit.push_back(ids[row]);
  }
  std::sort(hit.begin(), hit.end());
  hit.erase(std::unique(hit.begin(), hit.end()), hit.end());
  return hit;
}

std::size_t FacetSearch::climb(std::size_t width, std::size_t most, const WorkEnd& end) {
  std::vector<std::uint32_t> from;
  for (const std::uint32_t id : largest(width)) {
    if (!facets_[id].is_climbed_from && from.size() < most) from.push_back(id);
  }
  climb_from(from, end);
  return from.size();
}

std::vector<std::uint32_t> FacetSearch::ascend(std::span<const std::uint32_t> from, std::size_t most,
                                               const WorkEnd& end) {
  std::vector<std::uint32_t> fresh, next;
  for (const std::uint32_t id : from) {
    if (facets_[id].is_climbed_from) continue;
    if (fresh.size() < most) {
      fresh.push_back(id);
    } else {
      next.push_back(id);
    }
  }
  climb_from(fresh, end);
  for (const std::uint32_t id : from) {
    std::uint32_t best = id;
    for (const std::uint32_t neighbour : neighbours_[id]) {
      if (facets_[neighbour].area > facets_[best].area) best = neighbour;
    }
    if (best != id) next.push_back(best);
  }
  std::sort(next.begin(), next.end());
  next.erase(std::unique(next.begin(), next.end()), next.end());
  return next;
}

void FacetSearch::climb_from(std::span<const std::uint32_t> from, const WorkEnd& end) {
  std::vector<WalkTask> tasks;
  std::vector<std::size_t> ends;
  std::vector<std::optional<std::vector<WalkTask>>> ridges(from.size());  // none: there was no time
  for_each_block(from.size(), 1, [&](std::size_t row, std::size_t) {
    if (end.is_late()) return;
    const auto points = points_of(from[row]);
    if (points.size() == shooter_.frame().rank) {
      RayFacet simplex;
      simplex.points.assign(points.begin(), points.end());
      simplex.vertices = simplex.points;
      ridges[row] = geometry_.ridge_walks(simplex);
    } else {
      ridges[row] = geometry_.ridge_walks(geometry_of(from[row]));
    }
  });
  for (std::optional<std::vector<WalkTask>>& some : ridges) {
    has_left_ridges_out_ = has_left_ridges_out_ || !some;
    if (some) std::ranges::move(*some, std::back_inserter(tasks));
    ends.push_back(tasks.size());
  }
  std::vector<std::uint32_t> ids;
  for (std::size_t first = 0; first < tasks.size() && !end.is_late();) {
    const std::size_t count = walks_at_once_.at_once(tasks.size() - first, end);
    std::vector<std::uint32_t> met;
    walks_at_once_.look_at(
        count, end, [&] { met = enter(shooter_.walk(std::span(tasks).subspan(first, count), end.stop())); });
    ids.insert(ids.end(), met.begin(), met.end());
    first += count;
  }
  has_left_ridges_out_ = has_left_ridges_out_ || ids.size() < tasks.size();
  ids.resize(tasks.size(), kNone);
  std::size_t row = 0;
  for (std::size_t one = 0; one < from.size(); ++one) {
    facets_[from[one]].is_climbed_from = true;
    std::vector<std::uint32_t> neighbours;
    for (; row < ends[one]; ++row) {
      if (ids[row] != kNone) neighbours.push_back(ids[row]);
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    neighbours_[from[one]] = neighbours;
    const FoundFacet origin = facets_[from[one]];
    for (const std::uint32_t neighbour : neighbours) {
      for (std::size_t k = 0; k < origin.ray_count; ++k) lead(neighbour, origin.rays[k]);
    }
  }
  climbs_ += from.size();
}

bool FacetSearch::add_hit_by(const std::vector<double>& direction, std::uint32_t& facet) {
  const WalkTask task{.direction = direction};
  const std::vector<WalkResult> walks = shooter_.walk({&task, 1});
  const std::vector<std::uint32_t> ids = enter(walks);
  facet = ids.front();
  return facet != kNone;
}

RayFacet FacetSearch::geometry_of(std::uint32_t facet) const {
  const auto points = points_of(facet);
  RayFacet result;
  result.points.assign(points.begin(), points.end());
  result.vertices = vertices_of(facet);
  result.plane = geometry_.fit_plane(result.points);
  result.area = facets_[facet].area;
  result.area_is_whole = facets_[facet].area_is_whole;
  return result;
}

std::vector<std::uint32_t> FacetSearch::vertices_of(std::uint32_t facet) const {
  const auto points = points_of(facet);
  if (points.size() > shooter_.frame().rank) return vertices_[facet];
  return {points.begin(), points.end()};
}

std::vector<std::uint32_t> FacetSearch::largest(std::size_t count) const {
  std::vector<std::uint32_t> ids(facets_.size());
  for (std::uint32_t id = 0; id < ids.size(); ++id) ids[id] = id;
  const auto kept = ids.begin() + static_cast<std::ptrdiff_t>(std::min(count, ids.size()));
  const auto is_larger = [this](std::uint32_t a, std::uint32_t b) {
    return facets_[a].area != facets_[b].area ? facets_[a].area > facets_[b].area : a < b;
  };
  std::nth_element(ids.begin(), kept, ids.end(), is_larger);
  ids.erase(kept, ids.end());
  std::sort(ids.begin(), ids.end(), is_larger);
  return ids;
}

std::uint64_t FacetSearch::facets_with_hits(std::uint64_t hits) const {
  return static_cast<std::uint64_t>(std::count_if(
      facets_.begin(), facets_.end(), [hits](const FoundFacet& facet) { return facet.hits == hits; }));
}

}  // namespace ndhull
