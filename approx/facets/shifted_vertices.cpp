#include "approx/facets/shifted_vertices.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/linear/column_simplex.h"
#include "core/linear/column_table.h"
#include "core/machine/blocks.h"
#include "core/search/support.h"

namespace ndhull {
namespace {

/// [ratio to the frame's size] So far outside the others' hull a point is a vertex for certain.
constexpr double kClear = 1e-11;
constexpr std::size_t kAtATime = 32;

class ShiftedVertices {
 public:
  explicit ShiftedVertices(const GrowthWork& work)
      : work_(work), rank_(work.rank), is_vertex_(find_corners(work)) {
    for (std::uint32_t id = 0; id < is_vertex_.size(); ++id) {
      if (!is_vertex_[id]) continue;
      ids_.push_back(id);
      rows_.insert(rows_.end(), point(id), point(id) + rank_);
    }
  }

  std::vector<bool> run() {
    const std::vector<std::uint32_t> doubtful = places_not_furthest();
    stand_in_ = first_not_in(doubtful);
    if (doubtful.empty() || stand_in_ == ids_.size()) return is_vertex_;
    std::vector<std::uint8_t> is_inside(doubtful.size());
    for_each_block(doubtful.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
      ColumnTable others = table();
      for (std::size_t i = begin; i < end; ++i) {
        is_inside[i] = is_in_hull_of_others(doubtful[i], others);
        put(doubtful[i], doubtful[i], others);
      }
    });
    ColumnTable left = table();
    for (std::size_t i = 0; i < doubtful.size(); ++i) {
      if (is_inside[i] == 0) continue;
      const std::uint32_t place = doubtful[i];
      if (is_in_hull_of_others(place, left)) {
        is_vertex_[ids_[place]] = false;
      } else {
        put(place, place, left);
      }
    }
    return is_vertex_;
  }

 private:
  const double* point(std::uint32_t id) const { return work_.points + std::size_t{id} * rank_; }
  const double* row(std::uint32_t place) const { return rows_.data() + std::size_t{place} * rank_; }

  /// Of corners, the places in ids_, that are not clearly the furthest along the mean normal of their
  /// simplices.
  std::vector<std::uint32_t> places_not_furthest() const {
    const std::vector<double> normals = mean_normals();
    const SupportTable support(rank_, rows_);
    std::vector<std::uint8_t> is_furthest(ids_.size());
    for_each_block(ids_.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
      SupportProducts products;
      std::vector<std::uint32_t> near;
      for (std::size_t place = begin; place < end; ++place) {
        double height = 0.0;
        const double* const normal = normals.data() + place * rank_;
        if (support.find(normal, products, height) != place) continue;
        near.clear();
        support.rows_above(products, height - 1e-4 * std::abs(height), ids_.size(), near);
        is_furthest[place] = std::ranges::all_of(near, [&](std::uint32_t other) {
          return other == place || height - product(normal, row(other)) > kClear * scale();
        });
      }
    });
    std::vector<std::uint32_t> places;
    for (std::uint32_t place = 0; place < ids_.size(); ++place)
      if (is_furthest[place] == 0) places.push_back(place);
    return places;
  }

  /// The first place that is not in this list, which is ascending; the number of places where all are.
  std::size_t first_not_in(const std::vector<std::uint32_t>& places) const {
    std::size_t place = 0;
    while (place < places.size() && places[place] == place) ++place;
    return place;
  }

  /// Unit, or 0 where they cancel.
  std::vector<double> mean_normals() const {
    std::vector<std::uint32_t> place_of(work_.point_count);
    for (std::uint32_t place = 0; place < ids_.size(); ++place) place_of[ids_[place]] = place;
    std::vector<double> normals(rows_.size(), 0.0);
    const SimplicialComplex& complex = work_.complex;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      const auto plane = complex.plane(SimplexId{row});
      const double length = std::sqrt(product(plane.data(), plane.data()));
      for (const PointId id : complex.vertices(SimplexId{row}))
        for (std::size_t k = 0; k < rank_; ++k) normals[place_of[id.value] * rank_ + k] += plane[k] / length;
    }
    for (std::size_t begin = 0; begin < normals.size(); begin += rank_) {
      double* const normal = normals.data() + begin;
      const double length = std::sqrt(product(normal, normal));
      if (length > 0.0) std::for_each(normal, normal + rank_, [&](double& entry) { entry /= length; });
    }
    return normals;
  }

  double product(const double* a, const double* b) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < rank_; ++k) sum += a[k] * b[k];
    return sum;
  }
  double scale() const { return static_cast<double>(rank_); }  // no point of a frame is much longer

  /// A column for each corner: the point, and 1.
  ColumnTable table() const {
    ColumnTable columns(rank_ + 1, ids_.size());
    for (std::uint32_t place = 0; place < ids_.size(); ++place) put(place, place, columns);
    return columns;
  }
  void put(std::uint32_t column, std::uint32_t place, ColumnTable& columns) const {
    std::vector<double> entries(row(place), row(place) + rank_);
    entries.push_back(1.0);
    columns.set(column, entries, 0.0);
  }

  /// Leaves a point that stays in its column.
  bool is_in_hull_of_others(std::uint32_t place, ColumnTable& others) const {
    constexpr std::uint64_t kPatience = 250;  // pivots; then tolerances are no longer what they were
    put(place, static_cast<std::uint32_t>(stand_in_), others);
    std::vector<double> target(row(place), row(place) + rank_);
    target.push_back(1.0);
    ColumnSimplex lp(target);
    const LpResult result = solve_lp(lp, [&](const LpQuery& query) { return others.price(query); });
    return result.status == LpStatus::kOptimal && result.pivots < kPatience &&
           result.infeasibility <= kClear * scale();
  }

  const GrowthWork& work_;
  std::size_t rank_;
  std::vector<bool> is_vertex_;
  std::vector<std::uint32_t> ids_;  // of the corners, ascending
  std::vector<double> rows_;        // their coordinates
  std::size_t stand_in_ = 0;        // the place of a corner that is a vertex for certain
};

}  // namespace

std::vector<bool> find_vertices_of_shifted(const GrowthWork& work) { return ShiftedVertices(work).run(); }

}  // namespace ndhull
