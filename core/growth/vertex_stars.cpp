#include "core/growth/vertex_stars.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/dimension_switch.h"
#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/machine/blocks.h"
#include "core/scramble.h"

namespace ndhull {
namespace {

/// Numbers of simplices and sums of their random numbers.
struct StarSums {
  std::uint64_t met = 0, kept = 0, sum_met = 0, sum_kept = 0;
};

/// The star of one vertex of a hull in D dimensions.
template <std::size_t D>
class VertexFigure {
 public:
  VertexFigure(std::span<const double> vertices, std::span<const double> normals, std::uint32_t vertex,
               std::uint64_t most_table_rows, std::size_t foreseen_rows)
      : vertices_(vertices),
        normal_(normals.data() + std::size_t{vertex} * D),
        vertex_(vertex),
        most_table_rows_(most_table_rows),
        table_rows_(foreseen_rows) {}

  /// The simplices whose first vertex this is go to found(), all are counted in `sums`. False when the figure
  /// has no full dimension, or decisions were too close.
  bool grow_into(StarSums& sums) {
    if (!project()) return false;
    const PointView view = PointView::row_major(points_.data(), points_.size() / kFlat, kFlat);
    const Frame frame = fit_frame(view);
    if (frame.rank != kFlat) return false;
    std::vector<double> coordinates(points_.size());
    map_points(view, frame, coordinates.data());
    GrowthWork work;
    work.rank = kFlat;
    work.point_count = view.rows;
    work.points = coordinates.data();
    work.options.most_table_rows = most_table_rows_;
    work.options.foreseen_rows = table_rows_;
    start_growth(work, frame.simplex, {});
    if (grow(work) != GrowthStop::kNoOutsidePoints || !work.shifted_points.empty()) return false;
    table_rows_ = work.complex.row_count;
    keep_first(work.complex, sums);
    return true;
  }
  /// That growth needed.
  std::size_t table_rows() const { return table_rows_; }
  /// Any number x (D - 1), as SimplexRows has them.
  std::span<const std::uint16_t> found() const { return found_; }

 private:
  static constexpr std::size_t kFlat = D - 1;
  using Others = std::array<std::uint16_t, kFlat>;

  /// The points where the lines to the other vertices meet the plane n.(x - v) = -1, in axes of that plane.
  bool project() {
    // The reflection that turns the normal to the first axis turns the plane to the others.
    std::array<double, D> mirror;
    std::copy_n(normal_, D, mirror.data());
    double length_sq = 0.0;
    for (const double entry : mirror) length_sq += entry * entry;
    mirror[0] += std::copysign(std::sqrt(length_sq), mirror[0]);
    double mirror_sq = 0.0;
    for (const double entry : mirror) mirror_sq += entry * entry;
    const double* const v = vertices_.data() + std::size_t{vertex_} * D;
    const std::size_t count = vertices_.size() / D;
    points_.reserve((count - 1) * kFlat);
    for (std::size_t other = 0; other < count; ++other) {
      if (other == vertex_) continue;
      std::array<double, D> edge;
      double height = 0.0, along = 0.0;
      for (std::size_t k = 0; k < D; ++k) {
        edge[k] = vertices_[other * D + k] - v[k];
        height -= normal_[k] * edge[k];
        along += mirror[k] * edge[k];
      }
      if (!(height > 0.0)) return false;
      const double turn = 2.0 * along / mirror_sq;
      for (std::size_t k = 1; k < D; ++k) points_.push_back((edge[k] - turn * mirror[k]) / height);
    }
    return true;
  }

  void keep_first(const SimplicialComplex& complex, StarSums& sums) {
    std::vector<Others> found;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      Others others;
      std::uint64_t number = scramble(vertex_);
      bool is_first = true;
      for (std::size_t k = 0; k < kFlat; ++k) {
        const std::uint32_t place = complex.vertices(SimplexId{row})[k].value;
        others[k] = static_cast<std::uint16_t>(place + (place >= vertex_ ? 1u : 0u));
        number += scramble(others[k]);
        is_first = is_first && others[k] > vertex_;
      }
      ++sums.met;
      sums.sum_met += scramble(number);
      if (!is_first) continue;
      ++sums.kept;
      sums.sum_kept += scramble(number);
      std::sort(others.begin(), others.end());
      found.push_back(others);
    }
    std::sort(found.begin(), found.end());
    found_.reserve(found.size() * kFlat);
    for (const Others& others : found) found_.insert(found_.end(), others.begin(), others.end());
  }

  std::span<const double> vertices_;
  const double* normal_;
  std::uint32_t vertex_;
  std::uint64_t most_table_rows_;
  std::size_t table_rows_;
  std::vector<double> points_;
  std::vector<std::uint16_t> found_;
};

template <std::size_t D>
std::optional<SimplexRows> grow_all(std::span<const double> vertices, std::span<const double> normals,
                                    const StarOptions& options) {
  const std::size_t count = vertices.size() / D;
  SimplexRows rows(D, count, options.most_rows);
  std::vector<StarSums> sums(count);
  std::atomic<bool> has_ended = false;
  std::atomic<std::size_t> stars = 0;
  std::atomic<std::uint64_t> kept = 0;
  // Of the star before, with some room. Other tables would be pages of the system's, star by star.
  constexpr std::size_t kRoom = 8;  // a part
  std::atomic<std::size_t> foreseen_rows = 0;
  for_each_block(count, 1, [&](std::size_t begin, std::size_t) {
    if (has_ended.load(std::memory_order_relaxed)) return;
    const auto vertex = static_cast<std::uint32_t>(begin);
    StarSums& star = sums[vertex];
    VertexFigure<D> figure(vertices, normals, vertex, options.most_table_rows,
                           foreseen_rows.load(std::memory_order_relaxed));
    bool is_whole = false;
    run_alone([&](std::size_t, std::size_t) { is_whole = figure.grow_into(star); });
    foreseen_rows.store(figure.table_rows() + figure.table_rows() / kRoom, std::memory_order_relaxed);
    const std::uint64_t at = kept.fetch_add(star.kept), all = at + star.kept;
    if (!is_whole || all > options.most_rows || (options.gives_up && options.gives_up(++stars, all))) {
      has_ended.store(true, std::memory_order_relaxed);
    } else {
      rows.set_part(vertex, at, figure.found());
    }
  });
  if (has_ended.load()) return std::nullopt;
  StarSums all;
  for (const StarSums& star : sums) {
    all.met += star.met;
    all.kept += star.kept;
    all.sum_met += star.sum_met;
    all.sum_kept += star.sum_kept;
  }
  if (all.met != D * all.kept || all.sum_met != D * all.sum_kept) return std::nullopt;
  rows.number();
  return rows;
}

}  // namespace

std::optional<SimplexRows> grow_stars(std::size_t rank, std::span<const double> vertices,
                                      std::span<const double> normals, const StarOptions& options) {
  return call_with_dimension<3, kMaxRank>(rank,
                                          [&](auto d) { return grow_all<d>(vertices, normals, options); });
}

}  // namespace ndhull
