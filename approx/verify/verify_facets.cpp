// One pass over the facets, in parallel; records of ranges are joined in the order of the facets, so the
// first failure is the same for any number of threads. How often a point is a vertex of a facet is counted
// apart.

#include "approx/verify/verify_facets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Records = std::array<ClaimRecord, static_cast<std::size_t>(Claim::kCount)>;

/// A normal's components are rounded to 2^-53 each and its length was computed with d + 2 roundings: 16 times
/// that is still far from any length that is not meant to be 1.
double unit_length_roundoff(std::size_t dimension) {
  return 16.0 * static_cast<double>(dimension + 4) * 0x1p-53;
}

std::string facet_name(FacetId facet) { return "facet " + std::to_string(facet.value); }

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

class FacetChecker {
 public:
  FacetChecker(const PointView& points, const HullClaims& hull, DoubtfulSign doubtful)
      : points_(points),
        hull_(hull),
        numbers_(hull.numbers()),
        doubtful_(doubtful),
        is_at_origin_(std::ranges::all_of(hull.reference(), [](double entry) { return entry == 0.0; })),
        zeros_(points.dimension, 0.0),
        point_(points.dimension) {}

  void check(FacetId facet) {
    if (!check_ids(facet)) return;
    check_simplices(facet);
    check_normal(facet);
    check_inner(facet);
    check_ridges(facet);
    const CentredPlane plane = hull_.plane_at(facet, 0.0);
    const double value = plane_sign(plane, hull_.interior_point(), doubtful_);
    record_check(
        of(Claim::kInterior), value < 0.0,
        [&] {
          return "the interior point is not below " + facet_name(facet) + ": " +
                 found_and_claimed(value, 0.0);
        },
        value);
  }

  const Records& records() const { return records_; }

 private:
  ClaimRecord& of(Claim claim) { return records_[static_cast<std::size_t>(claim)]; }

  bool is_point(PointId point) const { return point.value < points_.rows; }
  bool is_facet(FacetId facet) const { return facet.value < hull_.facet_count(); }
  bool is_simplex(SimplexId simplex) const { return simplex.value < hull_.simplices().row_count; }

  /// Ids name what exists; nothing else is looked at otherwise.
  bool check_ids(FacetId facet) {
    const auto vertices = hull_.vertices_of(facet);
    const auto neighbours = hull_.neighbours_of(facet);
    const auto simplices = hull_.simplices_of(facet);
    const bool points_exist =
        std::all_of(vertices.begin(), vertices.end(), [&](PointId v) { return is_point(v); });
    record_check(of(Claim::kVertices), points_exist && vertices.size() >= numbers_.rank, [&] {
      return facet_name(facet) + " has a vertex that is no input point, or too few: found " +
             std::to_string(vertices.size()) + " vertices, expected at least " +
             std::to_string(numbers_.rank);
    });
    const bool facets_exist = std::all_of(neighbours.begin(), neighbours.end(),
                                          [&](FacetId g) { return is_facet(g) && g != facet; });
    const std::size_t least = numbers_.is_approximate ? 1 : numbers_.rank;
    record_check(of(Claim::kFacets), facets_exist && neighbours.size() >= least, [&] {
      return facet_name(facet) + " has a neighbour that is no other facet, or too few: found " +
             std::to_string(neighbours.size()) + " neighbours, expected at least " + std::to_string(least);
    });
    const bool simplices_exist =
        !simplices.empty() && std::all_of(simplices.begin(), simplices.end(), [&](SimplexId simplex) {
          return is_simplex(simplex) && hull_.facet_of(simplex) == facet;
        });
    record_check(of(Claim::kFacets), simplices_exist, [&] {
      return facet_name(facet) + " has no simplex, or one that does not name it as its facet";
    });
    return points_exist && facets_exist && simplices_exist;
  }

  /// Vertices and neighbours are those of the simplices; the relation holds both ways.
  void check_simplices(FacetId facet) {
    simplex_vertices_.clear();
    simplex_facets_.clear();
    for (const SimplexId simplex : hull_.simplices_of(facet)) {
      const auto vertices = hull_.simplices().vertices(simplex);
      simplex_vertices_.insert(simplex_vertices_.end(), vertices.begin(), vertices.end());
      for (const SimplexId next : hull_.simplices().neighbours(simplex)) {
        if (!is_simplex(next)) continue;  // a failure of kComplex
        if (const FacetId other = hull_.facet_of(next); other != facet) simplex_facets_.push_back(other);
      }
    }
    sort_unique(simplex_vertices_);
    sort_unique(simplex_facets_);
    for (const PointId vertex : hull_.vertices_of(facet)) {
      const bool known = std::binary_search(simplex_vertices_.begin(), simplex_vertices_.end(), vertex);
      record_check(of(Claim::kVertices), known, [&] {
        return "point " + std::to_string(vertex.value) + " is a vertex of " + facet_name(facet) +
               " but of none of its simplices";
      });
    }
    neighbours_.assign(hull_.neighbours_of(facet).begin(), hull_.neighbours_of(facet).end());
    sort_unique(neighbours_);
    record_check(of(Claim::kFacets), neighbours_ == simplex_facets_, [&] {
      return "the neighbours of " + facet_name(facet) + " are not those of its simplices: found " +
             std::to_string(simplex_facets_.size()) + ", claimed " + std::to_string(neighbours_.size());
    });
    for (const FacetId other : neighbours_) {
      const auto back = hull_.neighbours_of(other);
      record_check(of(Claim::kFacets), std::find(back.begin(), back.end(), facet) != back.end(), [&] {
        return facet_name(facet) + " names " + facet_name(other) +
               " as neighbour, which does not name it back";
      });
    }
  }

  void check_normal(FacetId facet) {
    const auto normal = hull_.normal(facet);
    double length_sq = 0.0;
    for (const double value : normal) length_sq += value * value;
    const double length = std::sqrt(length_sq);
    const bool is_unit = std::fabs(length - 1.0) <= unit_length_roundoff(numbers_.dimension);
    record_check(of(Claim::kNormals), is_unit, [&] {
      return "the length of the normal of " + facet_name(facet) + ": " + found_and_claimed(length, 1.0);
    });
    // offset = centred_offset - normal . reference, to roundoff: the centred plane's value at the origin.
    const CentredPlane plane = hull_.plane_at(facet, 0.0);
    const BoundedValue value =
        is_at_origin_ ? BoundedValue{plane.offset, 0.0} : plane_value_extended(plane, zeros_);
    const double found = std::fabs(value.value - hull_.offset(facet));
    const double claimed = numbers_.roundoff * plane.unit;
    const double rounding = 4.0 * 0x1p-53 * (claimed + std::fabs(value.value)) + value.error;
    record_check(
        of(Claim::kNormals), found <= claimed + rounding,
        [&] {
          return "the offset of " + facet_name(facet) +
                 " and its centred offset differ by more than roundoff: " + found_and_claimed(found, claimed);
        },
        found - claimed);
  }

  double value_at(PointId point, const CentredPlane& plane) {
    points_.copy_row(point.value, point_.data());
    return plane_sign(plane, point_, doubtful_);
  }

  void check_inner(FacetId facet) {
    const CentredPlane plane = hull_.plane_at(facet, hull_.inner_offset(facet));
    for (const PointId vertex : hull_.vertices_of(facet)) {
      const double value = value_at(vertex, plane);
      record_check(
          of(Claim::kInner), value >= 0.0,
          [&] {
            const double claimed = plane.claimed * plane.unit;
            return "vertex " + std::to_string(vertex.value) + " is below the inner plane of " +
                   facet_name(facet) + ": " + found_and_claimed(value + claimed, claimed);
          },
          -value);
    }
  }

  void check_ridges(FacetId facet) {
    const CentredPlane plane = hull_.plane_at(facet, hull_.outer_offset(facet));
    own_.assign(hull_.vertices_of(facet).begin(), hull_.vertices_of(facet).end());
    sort_unique(own_);
    const auto expect_below = [&](PointId vertex) {
      const double value = value_at(vertex, plane);
      record_check(
          of(Claim::kRidges), value <= 0.0,
          [&] {
            const double claimed = plane.claimed * plane.unit;
            return "vertex " + std::to_string(vertex.value) + " of a neighbour is above the outer plane of " +
                   facet_name(facet) + ": " + found_and_claimed(value + claimed, claimed);
          },
          value);
    };
    for (const PointId vertex : own_) expect_below(vertex);
    for (const FacetId other : neighbours_) {
      for (const PointId vertex : hull_.vertices_of(other)) {
        if (is_point(vertex) && !std::binary_search(own_.begin(), own_.end(), vertex)) expect_below(vertex);
      }
    }
  }

  const PointView& points_;
  const HullClaims& hull_;
  HullNumbers numbers_;
  DoubtfulSign doubtful_;
  Records records_;
  bool is_at_origin_;  // where the planes' offsets are centred
  std::vector<double> zeros_, point_;
  std::vector<PointId> simplex_vertices_, own_;
  std::vector<FacetId> simplex_facets_, neighbours_;
};

/// Orthonormal directions of the normals seen so far, up to `rank` of them.
struct NormalSpan {
  std::vector<std::vector<double>> directions;

  /// Gram-Schmidt, twice. A normal within 1e-6 of the span adds nothing: coplanar simplices differ by far
  /// less, and what meets at such an angle may rightly be taken for flat.
  void add(std::span<const double> normal, std::size_t rank) {
    if (directions.size() >= rank) return;
    std::vector<double> rest(normal.begin(), normal.end());
    for (std::size_t step = 0; step < 2 * directions.size(); ++step) {
      const std::vector<double>& direction = directions[step % directions.size()];
      const double share = std::inner_product(rest.begin(), rest.end(), direction.begin(), 0.0);
      for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= share * direction[k];
    }
    const double length = std::sqrt(std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.0));
    if (!(length > 1e-6)) return;
    for (double& value : rest) value /= length;
    directions.push_back(std::move(rest));
  }
};

/// A corner of facets that is no vertex of the hull lies in a flat region or on a ridge: the normals there do
/// not span the space.
void verify_none_left_out(const HullClaims& hull, std::span<const std::uint32_t> facets_of_point,
                          const std::vector<bool>& is_vertex, ClaimRecord& record) {
  const std::size_t rank = hull.numbers().rank;
  std::map<std::uint32_t, NormalSpan> left_out;
  for (std::uint32_t point = 0; point < facets_of_point.size(); ++point) {
    if (!is_vertex[point] && facets_of_point[point] >= rank) left_out[point];
  }
  if (!left_out.empty()) {
    for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
      for (const PointId vertex : hull.vertices_of(FacetId{row})) {
        const auto found = left_out.find(vertex.value);
        if (found != left_out.end()) found->second.add(hull.normal(FacetId{row}), rank);
      }
    }
  }
  for (const auto& [point, span] : left_out) {
    record_check(record, span.directions.size() < rank, [&, id = point] {
      return "point " + std::to_string(id) +
             " is a corner of the hull, and not among its vertices: found in " +
             std::to_string(facets_of_point[id]) + " facets";
    });
  }
}

/// Each simplex has one facet, and each vertex of the hull enough of them.
void verify_counts(const PointView& points, const HullClaims& hull, Verification& result) {
  const HullNumbers numbers = hull.numbers();
  std::size_t simplex_count = 0;
  std::vector<std::uint32_t> facets_of_point(points.rows, 0);
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    simplex_count += hull.simplices_of(FacetId{row}).size();
    for (const PointId vertex : hull.vertices_of(FacetId{row})) {
      if (vertex.value < points.rows) ++facets_of_point[vertex.value];
    }
  }
  record_check(result.of(Claim::kFacets), simplex_count == hull.simplices().row_count, [&] {
    return "simplices in facets: found " + std::to_string(simplex_count) + ", claimed " +
           std::to_string(hull.simplices().row_count);
  });

  ClaimRecord& record = result.of(Claim::kVertices);
  const auto vertices = hull.vertices();
  record_check(record, std::is_sorted(vertices.begin(), vertices.end()),
               [] { return std::string("the vertices of the hull are not in ascending order"); });
  const std::size_t least_facets = numbers.rank == 1 || numbers.is_approximate ? 1 : numbers.rank;
  std::vector<bool> is_vertex(points.rows, false);
  for (const PointId vertex : vertices) {
    const bool fresh = vertex.value < points.rows && !is_vertex[vertex.value];
    record_check(record, fresh && facets_of_point[vertex.value] >= least_facets, [&] {
      const std::uint32_t found = vertex.value < points.rows ? facets_of_point[vertex.value] : 0;
      return "point " + std::to_string(vertex.value) +
             " is given twice as vertex or is in too few facets: found " + std::to_string(found) +
             ", expected at least " + std::to_string(least_facets);
    });
    if (vertex.value < points.rows) is_vertex[vertex.value] = true;
  }
  verify_none_left_out(hull, facets_of_point, is_vertex, record);
}

}  // namespace

void verify_facets(const PointView& points, const HullClaims& hull, DoubtfulSign doubtful,
                   Verification& result) {
  const std::size_t count = hull.facet_count();
  constexpr std::size_t kFacetsAtATime = 2048;
  std::vector<Records> parts((count + kFacetsAtATime - 1) / kFacetsAtATime);
  for_each_block(count, kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    FacetChecker checker(points, hull, doubtful);
    for (std::size_t row = begin; row != end; ++row) checker.check(FacetId{static_cast<std::uint32_t>(row)});
    parts[begin / kFacetsAtATime] = checker.records();
  });
  for (const Records& part : parts)
    for (std::size_t row = 0; row < part.size(); ++row) join_records(result.claims[row], part[row]);
  verify_counts(points, hull, result);
}

}  // namespace ndhull
