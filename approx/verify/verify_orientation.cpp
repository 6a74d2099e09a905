// Convexity from the points alone: over each ridge of a simplicial facet, is the neighbour's opposite vertex
// on the interior point's side of the hyperplane through the facet's vertices? Signs are exact. Where one is
// wrong the hull is not convex there as exact points; the height must then be explained by the facet's
// claimed width.
//
// An orientation that intervals cannot decide costs up to a millisecond. Ridges that are nearly flat by the
// facet's own plane are counted first, and sampled at a stride when there are too many.

#include <algorithm>
#include <vector>

#include "approx/verify/verify_facets.h"
#include "core/exact_orientation.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Clear ridges cost about 3 us each, flat ones up to 800 us: with these counts some 10-20 s on one core.
constexpr std::uint64_t kMaxClearRidges = 2'000'000;
constexpr std::uint64_t kMaxFlatRidges = 20'000;
/// A vertex less below a facet's plane than this part of the interior point's depth: intervals may not
/// decide.
constexpr double kFlatRatio = 1e-9;

/// A ridge of a simplicial facet, seen from its simplex.
struct Ridge {
  FacetId facet;
  SimplexId simplex;
  PointId opposite;  ///< the neighbour's vertex that is not on the ridge
  bool is_flat;
};

struct Found {
  ClaimRecord record;
  std::uint64_t concave = 0;
};

class RidgeChecker {
 public:
  RidgeChecker(const PointView& points, const HullClaims& hull)
      : points_(points), hull_(hull), dimension_(points.dimension), point_(points.dimension) {
    rows_.resize((dimension_ + 1) * dimension_);
  }

  /// Calls `visit` for every ridge of the facet when it is simplicial; of two simplicial facets the one with
  /// the lower id has the ridge.
  template <class Visit>
  void for_each_ridge(FacetId facet, const Visit& visit) {
    if (hull_.simplices_of(facet).size() != 1) return;
    const SimplexId simplex = hull_.simplices_of(facet)[0];
    const auto vertices = hull_.simplices().vertices(simplex);
    const CentredPlane plane = hull_.plane_at(facet, 0.0);
    const double depth = -plane_value_double(plane, hull_.interior_point()).value;
    for (const SimplexId next : hull_.simplices().neighbours(simplex)) {
      const FacetId other = hull_.facet_of(next);
      if (other < facet && hull_.simplices_of(other).size() == 1) continue;
      const auto next_vertices = hull_.simplices().vertices(next);
      const auto opposite = std::find_if(next_vertices.begin(), next_vertices.end(), [&](PointId vertex) {
        return std::find(vertices.begin(), vertices.end(), vertex) == vertices.end();
      });
      if (opposite == next_vertices.end()) continue;  // the two have all vertices in common: a 2-vertex hull
      points_.copy_row(opposite->value, point_.data());
      const bool is_flat = !(plane_value_double(plane, point_).value < -kFlatRatio * depth);
      visit(Ridge{facet, simplex, *opposite, is_flat});
    }
  }

  void check(const Ridge& ridge, Found& found) {
    const auto vertices = hull_.simplices().vertices(ridge.simplex);
    for (std::size_t i = 0; i < dimension_; ++i) {
      points_.copy_row(vertices[i].value, rows_.data() + i * dimension_);
    }
    if (ridge.facet != oriented_) {
      oriented_ = ridge.facet;
      side_ = orientation_of(hull_.interior_point());
    }
    points_.copy_row(ridge.opposite.value, point_.data());
    const int side = orientation_of(point_);
    const bool is_convex = side_ == 0 || side == 0 || side == side_;
    if (!is_convex) ++found.concave;
    // One of the two is on the far side, by the facet's normal as well as by the points.
    const bool holds = is_convex || (height_is_explained(ridge.facet, point_) &&
                                     height_is_explained(ridge.facet, hull_.interior_point()));
    record_check(found.record, holds, [&] {
      return "point " + std::to_string(ridge.opposite.value) +
             " or the interior point is higher over the vertices " + "of facet " +
             std::to_string(ridge.facet.value) + " than its width explains: width " +
             found_and_claimed(hull_.outer_offset(ridge.facet) - hull_.inner_offset(ridge.facet),
                               hull_.numbers().max_facet_width);
    });
  }

 private:
  int orientation_of(std::span<const double> point) {
    std::copy(point.begin(), point.end(), rows_.end() - static_cast<std::ptrdiff_t>(dimension_));
    return exact_orientation(rows_, dimension_);
  }

  bool height_is_explained(FacetId facet, std::span<const double> point) const {
    const auto vertices = std::span<const double>(rows_).first(dimension_ * dimension_);
    return exact_height_test(vertices, hull_.normal(facet), point, hull_.outer_offset(facet),
                             hull_.inner_offset(facet),
                             hull_.input_per_length_unit(facet)) != HeightTest::kAbove;
  }

  const PointView& points_;
  const HullClaims& hull_;
  std::size_t dimension_;
  std::vector<double> rows_;  // the facet's vertices and the point in question
  std::vector<double> point_;
  FacetId oriented_;  // the facet whose side_ is known
  int side_ = 0;      // the orientation of its vertices with the interior point
};

/// A ridge's number among those of its kind, and whether the sample takes it.
struct Sampler {
  std::uint64_t stride;
  std::uint64_t seen = 0;
  bool takes_next() { return seen++ % stride == 0; }
};

std::uint64_t stride_for(std::uint64_t count, std::uint64_t limit) {
  return std::max<std::uint64_t>(1, (count + limit - 1) / limit);
}

}  // namespace

void verify_orientation(const PointView& points, const HullClaims& hull, Verification& result) {
  std::uint64_t clear_count = 0, flat_count = 0;
  {
    RidgeChecker checker(points, hull);
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      checker.for_each_ridge(FacetId{row},
                             [&](const Ridge& ridge) { ++(ridge.is_flat ? flat_count : clear_count); });
    }
  }
  Sampler clear{stride_for(clear_count, kMaxClearRidges)};
  Sampler flat{stride_for(flat_count, kMaxFlatRidges)};
  std::vector<Ridge> sample;
  {
    RidgeChecker checker(points, hull);
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      checker.for_each_ridge(FacetId{row}, [&](const Ridge& ridge) {
        if ((ridge.is_flat ? flat : clear).takes_next()) sample.push_back(ridge);
      });
    }
  }
  constexpr std::size_t kRidgesAtATime = 1024;
  std::vector<Found> parts((sample.size() + kRidgesAtATime - 1) / kRidgesAtATime);
  for_each_block(sample.size(), kRidgesAtATime, [&](std::size_t begin, std::size_t end) {
    RidgeChecker checker(points, hull);
    for (std::size_t row = begin; row != end; ++row)
      checker.check(sample[row], parts[begin / kRidgesAtATime]);
  });
  ClaimRecord& record = result.of(Claim::kOrientation);
  result.concave_ridges = 0;
  for (const Found& part : parts) {
    join_records(record, part.record);
    result.concave_ridges += part.concave;
  }
  record.complete = clear.stride == 1 && flat.stride == 1;
}

}  // namespace ndhull
