// The driver. Steps in order, with the file that holds each:
//   1 frame            core/frame           coordinates to work in, the first simplex, the rank
//   2 growth           core/growth          insertions, furthest point first
//   3 certify          core/membership      every point proven inside, or put back: growth goes on
//   4 merge            approx/coplanar_merge  simplices on one plane become one facet
//   5 facet table      approx/facet_table   planes in input units, outer and inner offsets proven, areas
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "approx/coplanar_merge.h"
#include "approx/facet_table.h"
#include "approx/frame_planes.h"
#include "approx/hull.h"
#include "core/error.h"
#include "core/frame.h"
#include "core/growth.h"
#include "core/membership.h"
#include "core/plane_kernels.h"

namespace ndhull {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Repair rounds after which the rest is reported, not chased. One or two are what degenerate inputs need.
constexpr std::uint64_t kRepairRounds = 8;
/// Points further inside than this need no look at their distance from each plane. [ratio]
constexpr double kWellInside = 1e-9;
/// Points from which on an early proof pays.
constexpr std::size_t kManyPoints = 4096;
/// Plane-times-point products that are worth certifying points near the hull one by one.
constexpr double kAffordableProducts = 4e11;

HullStatus status_of(GrowthStop stop) {
  switch (stop) {
    case GrowthStop::kNoOutsidePoints:
    case GrowthStop::kPaused: return HullStatus::kComplete;
    case GrowthStop::kFacetLimit: return HullStatus::kFacetLimit;
    case GrowthStop::kTimeLimit: return HullStatus::kTimeLimit;
    case GrowthStop::kMemoryLimit: return HullStatus::kMemoryLimit;
    case GrowthStop::kInterrupted: return HullStatus::kInterrupted;
  }
  return HullStatus::kComplete;
}

}  // namespace

/// One run: the tables that its steps hand on.
class HullBuilder {
 public:
  HullBuilder(const PointView& points, const HullOptions& options) : points_(points), options_(options) {}

  Hull run() {
    start_ = Clock::now();
    frame_ = fit_frame(points_);
    if (frame_.rank > kMaxRank) {
      throw Error(ErrorCode::kDimensionTooHigh, "points span " + std::to_string(frame_.rank) +
                                                    " dimensions, expected at most " +
                                                    std::to_string(kMaxRank) + "; project them to fewer");
    }
    describe_input();
    if (frame_.rank == 0) return std::move(hull_);
    coordinates_.resize(points_.rows * frame_.rank + 8);
    map_points(points_, frame_, coordinates_.data());
    detail("frame", start_);
    if (frame_.rank == 1) {
      make_segment();
    } else {
      grow_and_certify();
    }
    const Clock::time_point merge_start = Clock::now();
    compact(work_.complex);
    merge();
    make_facets();
    seconds(Phase::kMerge) = seconds_since(merge_start);
    return std::move(hull_);
  }

 private:
  double& seconds(Phase phase) { return hull_.statistics.seconds[static_cast<std::size_t>(phase)]; }
  void detail(std::string_view name, Clock::time_point since) {
    hull_.statistics.detail_seconds.emplace_back(name, seconds_since(since));
  }

  void describe_input() {
    hull_.dimension = frame_.dimension;
    hull_.rank = frame_.rank;
    hull_.point_count = points_.rows;
    hull_.interior_point = frame_.centre;
    hull_.reference = frame_.centre;
    hull_.length_unit_ = LengthUnit(frame_, options_.unit_cube);
    if (frame_.rank == 0) hull_.vertices.push_back(PointId{0});
    hull_.subspace_equations = find_subspace_equations(frame_);
  }

  /// rank 1: the two ends, each a facet with one vertex.
  void make_segment() {
    std::uint32_t low = 0, high = 0;
    for (std::uint32_t id = 0; id < points_.rows; ++id) {
      if (coordinates_[id] < coordinates_[low]) low = id;
      if (coordinates_[id] > coordinates_[high]) high = id;
    }
    work_.complex = SimplicialComplex(1, 2);
    work_.complex.row_count = 2;
    const std::uint32_t ends[2] = {low, high};
    for (std::uint32_t row = 0; row < 2; ++row) {
      work_.complex.topology[2 * row] = ends[row];
      work_.complex.topology[2 * row + 1] = 1 - row;
      work_.complex.planes[row] = 1.0 / coordinates_[ends[row]];
      work_.complex.state[row] = SimplexState::kLive;
    }
    certificate_wanted_.assign(points_.rows, true);
  }

  GrowthStop poll(std::uint64_t points_left, double furthest_gauge) {
    const std::uint64_t rows = work_.complex.row_count - work_.free_count;
    const std::uint64_t bytes =
        work_.complex.row_count * (16 * frame_.rank + 5) + coordinates_.size() * 8 + points_.rows * 12;
    if (options_.progress) {
      options_.progress({Phase::kGrowth, points_left, rows, furthest_gauge, seconds_since(start_), bytes});
    }
    if (options_.stop.stop_requested()) return GrowthStop::kInterrupted;
    const Limits& limits = options_.limits;
    if (limits.max_seconds > 0.0 && seconds_since(start_) > limits.max_seconds) return GrowthStop::kTimeLimit;
    // The facet table takes about as much again for each simplex as is kept of the planes.
    const std::uint64_t at_end = bytes + rows * (8 * frame_.dimension + 40);
    if (limits.max_memory_bytes > 0 && at_end > limits.max_memory_bytes) return GrowthStop::kMemoryLimit;
    return GrowthStop::kNoOutsidePoints;
  }

  void grow_and_certify() {
    work_.rank = frame_.rank;
    work_.point_count = points_.rows;
    work_.points = coordinates_.data();
    work_.measure_phases = true;
    work_.options.seed = options_.seed;
    work_.options.max_rows = options_.limits.max_facets;
    work_.options.poll = [this](std::uint64_t left, double gauge) { return poll(left, gauge); };
    Clock::time_point phase_start = Clock::now();
    start_growth(work_, frame_.simplex);
    detail("first partition", phase_start);
    const HullBall ball = find_ball(frame_.rank, coordinates_.data(), points_.rows, frame_.simplex);
    std::uint64_t searched_all = 0;
    if (points_.rows > kManyPoints) prove_early(ball);
    for (std::uint64_t round = 0;; ++round) {
      phase_start = Clock::now();
      const GrowthStop stop = grow(work_);
      hull_.status = status_of(stop);
      seconds(Phase::kGrowth) += seconds_since(phase_start);
      phase_start = Clock::now();
      const std::vector<LocatedPoint> located =
          prove_inside(work_.complex, coordinates_.data(), ball, points_off_the_complex(), searched_all);
      const bool repaired =
          stop == GrowthStop::kNoOutsidePoints && round < kRepairRounds && put_back(located);
      if (!repaired) choose_certificate_points(located);
      seconds(Phase::kCertify) += seconds_since(phase_start);
      if (!repaired) break;
      ++hull_.statistics.repair_rounds;
    }
    const GrowthCounters& counters = work_.counters;
    HullStatistics& statistics = hull_.statistics;
    statistics.created_simplices = counters.created;
    statistics.insertions = counters.insertions;
    statistics.shifted_points = counters.shifted;
    statistics.rejected_insertions = counters.rejected;
    statistics.detail_seconds.emplace_back("visible set", counters.seconds_visible);
    statistics.detail_seconds.emplace_back("cone", counters.seconds_cone);
    statistics.detail_seconds.emplace_back("matching", counters.seconds_match);
    statistics.detail_seconds.emplace_back("partition", counters.seconds_partition);
    statistics.detail_seconds.emplace_back("points inside", seconds(Phase::kCertify));
  }

  /// Most of many points are well inside a small hull already. What is proven inside a part of the hull is
  /// inside the whole, and the part's simplices are few and in cache.
  void prove_early(const HullBall& ball) {
    Clock::time_point start = Clock::now();
    work_.options.pause_rows = 128 * frame_.rank;
    const GrowthStop stop = grow(work_);
    work_.options.pause_rows = 0;
    seconds(Phase::kGrowth) += seconds_since(start);
    if (stop != GrowthStop::kPaused) return;  // finished, or ended by a limit: the final proof comes next
    start = Clock::now();
    const std::vector<PointId> candidates = points_off_the_complex();
    proven_.assign(points_.rows, false);
    for (const LocatedPoint& point : try_inside(work_.complex, coordinates_.data(), ball, candidates)) {
      if (point.gauge < -kWellInside) proven_[point.point.value] = true;
    }
    seconds(Phase::kCertify) += seconds_since(start);
  }

  /// Points that are vertices of no simplex and not proven inside; marks the vertices in certificate_wanted_.
  std::vector<PointId> points_off_the_complex() {
    certificate_wanted_.assign(points_.rows, false);
    for (std::uint32_t row = 0; row < work_.complex.row_count; ++row) {
      if (work_.complex.state[row] != SimplexState::kLive) continue;
      for (const PointId id : work_.complex.vertices(SimplexId{row})) certificate_wanted_[id.value] = true;
    }
    std::vector<PointId> rest;
    for (std::uint32_t id = 0; id < points_.rows; ++id) {
      if (!certificate_wanted_[id] && (proven_.empty() || !proven_[id])) rest.push_back(PointId{id});
    }
    return rest;
  }

  /// Points more than four shifts outside go back; true when there were any.
  bool put_back(const std::vector<LocatedPoint>& located) {
    bool any = false;
    for (const LocatedPoint& point : located) {
      if (point.gauge <= 4.0 * work_.options.shift) continue;
      double gauge = -1.0;
      const auto plane = work_.complex.plane(point.simplex);
      for (std::size_t k = 0; k < frame_.rank; ++k)
        gauge += plane[k] * coordinates_[point.point.value * frame_.rank + k];
      if (gauge <= 2.0 * work_.options.shift) continue;
      push_outside(work_, point.point.value, point.simplex.value, gauge);
      any = true;
    }
    return any;
  }

  /// Vertices, and points so near the hull (or outside, after a limit) that only their distances will do.
  /// When that would cost too much the points outside are covered by their gauge.
  void choose_certificate_points(const std::vector<LocatedPoint>& located) {
    std::size_t near_count = 0;
    double largest_gauge = 0.0;
    for (const LocatedPoint& point : located) {
      largest_gauge = std::max(largest_gauge, point.gauge);
      near_count += point.gauge > -kWellInside ? 1 : 0;
    }
    hull_.max_outside_gauge = largest_gauge;
    const double live = static_cast<double>(work_.complex.row_count - work_.free_count);
    const double products = live * static_cast<double>(near_count) * static_cast<double>(frame_.dimension);
    if (products > kAffordableProducts && std::isfinite(largest_gauge)) {
      // Rounding of the frame's coordinates is far below this.
      covered_gauge_ = largest_gauge + 1e-14;
      return;
    }
    for (const LocatedPoint& point : located) {
      if (point.gauge > -kWellInside) certificate_wanted_[point.point.value] = true;
    }
  }

  void merge() {
    const Clock::time_point start = Clock::now();
    determinants_ = HugeArray<double>(work_.complex.row_count);
    const std::span<double> determinants(determinants_.data(), work_.complex.row_count);
    const bool shifted = work_.counters.shifted > 0;
    if (frame_.rank >= 2) {
      solve_simplices(work_.complex, coordinates_.data(), shifted, determinants);
    } else {
      for (std::size_t row = 0; row < 2; ++row) determinants[row] = std::abs(1.0 / work_.complex.planes[row]);
    }
    orient(determinants);
    detail("volumes", start);
    // Without a shifted point every decision was clearer than the shift: all ridges are convex.
    if (!shifted || options_.triangulate) {
      hull_.layout_ = simplicial_layout(work_.complex);
      return;
    }
    const Clock::time_point merge_start = Clock::now();
    hull_.layout_ =
        merge_coplanar(work_.complex, coordinates_.data(), determinants, 4.0 * work_.options.shift);
    detail("coplanar merging", merge_start);
  }

  /// The rows' common orientation may be either; volumes are positive.
  static void orient(std::span<double> determinants) {
    double sum = 0.0;
    for (const double determinant : determinants) sum += determinant;
    if (sum >= 0.0) return;
    for (double& determinant : determinants) determinant = -determinant;
  }

  void make_facets() {
    Clock::time_point start = Clock::now();
    is_vertex_ = find_vertices(work_.complex, hull_.layout_, points_.rows);
    for (std::uint32_t id = 0; id < points_.rows; ++id) {
      if (is_vertex_[id]) hull_.vertices.push_back(PointId{id});
    }
    const CertificatePoints certificate = gather_certificate_points(points_, frame_, certificate_wanted_);
    hull_.reference = certificate.reference;
    coordinates_ = std::vector<double>();
    detail("vertices", start);
    start = Clock::now();
    FacetTable table =
        make_facet_table(work_.complex, hull_.layout_, frame_, certificate,
                         {determinants_.data(), work_.complex.row_count}, hull_.length_unit_, covered_gauge_);
    detail("facet table", start);
    hull_.normals_ = std::move(table.normals);
    hull_.centred_offsets_ = std::move(table.offsets);
    hull_.outer_ = std::move(table.outer);
    hull_.inner_ = std::move(table.inner);
    hull_.areas_ = std::move(table.areas);
    hull_.max_outer_offset = table.max_outer;
    hull_.min_inner_offset = table.min_inner;
    hull_.max_facet_width = table.max_width;
    hull_.roundoff = table.roundoff;
    hull_.area = table.area;
    hull_.volume = table.volume;
    hull_.own_ids_.resize(work_.complex.row_count);
    for (std::uint32_t row = 0; row < work_.complex.row_count; ++row) hull_.own_ids_[row] = SimplexId{row};
    list_irregular_facets();
    hull_.simplices = std::move(work_.complex);
  }

  /// Vertices and neighbours of the facets that are merged or have a merged neighbour.
  void list_irregular_facets() {
    const FacetLayout& layout = hull_.layout_;
    std::vector<std::uint32_t> seen_vertex(points_.rows, FacetId::kNone);
    std::vector<std::uint32_t> seen_facet(layout.facets, FacetId::kNone);
    IdRows& vertices = hull_.facet_vertices_;
    IdRows& neighbours = hull_.facet_neighbours_;
    for (std::uint32_t facet = static_cast<std::uint32_t>(layout.regular); facet < layout.facets; ++facet) {
      const bool simplicial = hull_.is_simplicial(FacetId{facet});
      seen_facet[facet] = facet;
      for (const SimplexId simplex : hull_.simplices_of(FacetId{facet})) {
        for (const PointId id : work_.complex.vertices(simplex)) {
          if (seen_vertex[id.value] == facet || !is_vertex_[id.value]) continue;
          seen_vertex[id.value] = facet;
          vertices.values.push_back(id.value);
        }
        for (const SimplexId neighbour : work_.complex.neighbours(simplex)) {
          const std::uint32_t other = layout.facet_of(neighbour).value;
          if (!simplicial && seen_facet[other] == facet) continue;
          seen_facet[other] = facet;
          neighbours.values.push_back(other);
        }
      }
      if (!simplicial) {
        std::sort(vertices.values.begin() + vertices.begin.back(), vertices.values.end());
        std::sort(neighbours.values.begin() + neighbours.begin.back(), neighbours.values.end());
      }
      vertices.begin.push_back(static_cast<std::uint32_t>(vertices.values.size()));
      neighbours.begin.push_back(static_cast<std::uint32_t>(neighbours.values.size()));
    }
  }

  const PointView& points_;
  const HullOptions& options_;
  Clock::time_point start_;
  Hull hull_;
  Frame frame_;
  std::vector<double> coordinates_;  // points x rank, in the frame
  GrowthWork work_;
  std::vector<bool> certificate_wanted_;
  std::vector<bool> proven_;  // inside by more than kWellInside; empty: nothing was proven early
  double covered_gauge_ = 0.0;
  HugeArray<double> determinants_;
  std::vector<bool> is_vertex_;
};

Hull convex_hull(const PointView& points, const HullOptions& options) {
  tbb::task_arena arena(options.threads == 0 ? tbb::task_arena::automatic
                                             : static_cast<int>(options.threads));
  return arena.execute([&] { return HullBuilder(points, options).run(); });
}

}  // namespace ndhull
