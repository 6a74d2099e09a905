#include "approx/trade/region_closing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/far_reach.h"
#include "approx/slabs/plane_fit.h"
#include "core/linear/column_table.h"

namespace ndhull {
namespace {

/// [ratio] A known facet that faces a direction less than this closes hardly more than there is.
constexpr double kFacesEnough = 0.1;

/// Planes that are to bound a region.
class RegionPlanes {
 public:
  RegionPlanes(const SimplicialComplex& complex, const WidthSpace& space, const Covering& covering)
      : space_(space), duals_(covering.planes.size() * space.rank()) {
    const std::size_t rank = space.rank();
    for (std::size_t facet = 0; facet < covering.planes.size(); ++facet) {
      const FittedPlane& plane = covering.planes[facet];
      normals_.insert(normals_.end(), plane.normal.begin(), plane.normal.end());
      if (is_measured(plane)) space.plane_of(plane.normal.data(), plane.height, duals_.data() + facet * rank);
    }
    // Simplices that stayed alone have their own.
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      const std::uint32_t facet = covering.facet_of[row];
      if (facet != kNone && !is_measured(covering.planes[facet]))
        std::ranges::copy(complex.plane(SimplexId{row}), duals_.data() + facet * rank);
    }
  }

  void add(std::span<const double> dual) {
    normals_.resize(normals_.size() + space_.rank());
    space_.normal_of(dual, normals_.data() + duals_.size());
    duals_.insert(duals_.end(), dual.begin(), dual.end());
  }

  /// A unit vector of the frame, or none.
  std::optional<std::vector<double>> find_way_out() const {
    const std::size_t rank = space_.rank();
    const Boundedness found = find_open_direction(normals_, rank);
    if (found.bounded) return find_far_reach(duals_, rank);
    std::vector<double> along(rank);
    space_.facing(found.direction.data(), along.data());
    const double length = std::sqrt(std::inner_product(along.begin(), along.end(), along.begin(), 0.0));
    for (double& entry : along) entry /= length;
    return along;
  }

 private:
  const WidthSpace& space_;
  std::vector<double> normals_, duals_;  // in the space, and in the frame
};

class RegionCloser {
 public:
  RegionCloser(const SimplicialComplex& complex, const WidthSpace& space, const double* coordinates,
               HullFacets* known, Covering& covering)
      : complex_(complex),
        space_(space),
        coordinates_(coordinates),
        known_(space.table().count() > space.vertex_count() ? known : nullptr),
        covering_(covering),
        rank_(space.rank()),
        size_of_(covering.planes.size(), 0),
        planes_(complex, space, covering) {
    for (const std::uint32_t facet : covering.facet_of)
      if (facet != kNone) ++size_of_[facet];
  }

  std::size_t run() {
    for (std::size_t left = 8 * rank_; left > 0; --left) {
      const std::optional<std::vector<double>> way_out = planes_.find_way_out();
      if (!way_out || !close(*way_out)) break;
    }
    return taken_;
  }

 private:
  /// How much simplices face a direction: a cosine, in the frame, where thin hulls are round.
  struct Facing {
    double most = 0.0;
    std::uint32_t row = kNone;
  };

  /// `along`: in the frame. False: all that face it are facets already.
  bool close(std::span<const double> along) {
    const Facing best = facing_most(along);
    if (best.row == kNone) return false;
    if (!known_ || reach_above(best.row) <= known_->width) return take(best.row);
    Facing of_known;
    while (known_rows_.size() < known_->vertices.size())
      known_rows_.push_back(row_of(known_->vertices[known_rows_.size()]));
    for (const std::uint32_t row : known_rows_)
      if (row != kNone) look_at(row, along, of_known);
    if (of_known.most > kFacesEnough) return take(of_known.row);
    return take_hull_facet(along, best.row);
  }

  Facing facing_most(std::span<const double> along) {
    Facing best;
    for (std::uint32_t row = 0; row < complex_.row_count; ++row)
      if (complex_.state[row] == SimplexState::kLive) look_at(row, along, best);
    return best;
  }

  void look_at(std::uint32_t row, std::span<const double> along, Facing& best) const {
    const auto plane = complex_.plane(SimplexId{row});
    double product = 0.0, length_sq = 0.0;
    for (std::size_t k = 0; k < rank_; ++k) {
      product += plane[k] * along[k];
      length_sq += plane[k] * plane[k];
    }
    if (product <= 0.0 || product * product < best.most * best.most * length_sq) return;
    const double facing = product / std::sqrt(length_sq);
    if (facing > best.most && size_of_[covering_.facet_of[row]] != 1) best = {facing, row};
  }

  /// [distance] of any point above the plane of a simplex.
  double reach_above(std::uint32_t row) {
    std::vector<double> normal(rank_);
    const SimplexId simplex{row};
    space_.normal_of(complex_.plane(simplex), normal.data());
    const std::uint32_t vertex = space_.row_of(complex_.vertices(simplex)[0]);
    return measure_plane(space_, normal, std::span(&vertex, 1), fit_).width();
  }

  bool take(std::uint32_t row) {
    --size_of_[covering_.facet_of[row]];
    covering_.facet_of[row] = static_cast<std::uint32_t>(covering_.planes.size());
    size_of_.push_back(1);
    planes_.add(complex_.plane(SimplexId{row}));
    covering_.planes.push_back(own_plane(complex_, space_, row));
    ++taken_;
    return true;
  }

  /// The facet of all points' hull that the ray along this leaves through; `otherwise`: a simplex, where it
  /// is divided into others.
  bool take_hull_facet(std::span<const double> along, std::uint32_t otherwise) {
    const std::optional<LpResult> facet = hull_facet(along);
    if (!facet) return take(otherwise);
    std::vector<PointId> vertices;
    for (const LpColumnId column : facet->basis) vertices.push_back(space_.point_of(column.value));
    std::sort(vertices.begin(), vertices.end());
    if (std::ranges::find(known_->vertices, vertices) == known_->vertices.end())
      known_->vertices.push_back(vertices);
    const auto is_missing = [this](PointId id) { return space_.row_of(id) >= space_.vertex_count(); };
    if (std::ranges::none_of(vertices, is_missing)) {
      const std::uint32_t row = row_of(vertices);
      return take(row != kNone && size_of_[covering_.facet_of[row]] != 1 ? row : otherwise);
    }
    std::vector<PointId>& missing = known_->missing;
    std::ranges::copy_if(vertices, std::back_inserter(missing), is_missing);
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    planes_.add(facet->duals);
    return true;
  }

  /// In the frame, whose centre is inside: the least sum of weights with which points add up to `along`.
  std::optional<LpResult> hull_facet(std::span<const double> along) {
    if (!points_) {
      points_.emplace(rank_, space_.table().count());
      for (std::uint32_t row = 0; row < points_->count(); ++row)
        points_->set(row, {coordinates_ + std::size_t{space_.point_of(row).value} * rank_, rank_}, 1.0);
    }
    ColumnSimplex lp(along);
    LpResult result = solve_lp(lp, [this](const LpQuery& query) { return points_->price(query); });
    const auto is_point = [](LpColumnId id) { return id.valid(); };
    if (result.status != LpStatus::kOptimal || !std::ranges::all_of(result.basis, is_point))
      return std::nullopt;
    return result;
  }

  /// The live simplex with these vertices; none: there is none.
  std::uint32_t row_of(std::span<const PointId> vertices) {
    is_wanted_.resize(space_.point_count());
    for (const PointId id : vertices) is_wanted_[id.value] = 1;
    const auto is_wanted = [this](PointId id) { return is_wanted_[id.value] != 0; };
    std::uint32_t row = 0;
    while (row < complex_.row_count && (complex_.state[row] != SimplexState::kLive ||
                                        !std::ranges::all_of(complex_.vertices(SimplexId{row}), is_wanted)))
      ++row;
    for (const PointId id : vertices) is_wanted_[id.value] = 0;
    return row < complex_.row_count ? row : kNone;
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const double* coordinates_;
  HullFacets* known_;  // none: simplices are taken however far points are above them
  Covering& covering_;
  std::size_t rank_;
  std::vector<std::uint32_t> size_of_;
  RegionPlanes planes_;
  std::vector<std::uint8_t> is_wanted_;
  std::vector<std::uint32_t> known_rows_;  // of the first of known_->vertices: each is looked for once
  std::optional<ColumnTable> points_;
  PlaneFitWork fit_;
  std::size_t taken_ = 0;
};

}  // namespace

bool bounds_region(const SimplicialComplex& complex, const WidthSpace& space, const Covering& covering) {
  return covering.planes.size() > kSurelyBounded || !RegionPlanes(complex, space, covering).find_way_out();
}

std::size_t close_open_directions(const SimplicialComplex& complex, const WidthSpace& space,
                                  const double* coordinates, HullFacets* known, Covering& covering) {
  if (known) known->missing.clear();
  if (covering.planes.size() > kSurelyBounded) return 0;
  return RegionCloser(complex, space, coordinates, known, covering).run();
}

}  // namespace ndhull
