// The intersection of halfspaces: bounded, without end, empty, or flat, each with what proves it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "approx/hull.h"
#include "core/id_rows.h"
#include "core/points.h"

namespace ndhull {

/// What halfspaces have in common. Every kind has its proof in HalfspaceIntersection.
enum class IntersectionKind {
  kBounded,           ///< a polytope of full dimension
  kUnbounded,         ///< not empty, and without end along `direction`; perhaps flat as well (`equations`)
  kEmpty,             ///< nothing; see `proof`
  kLowerDimensional,  ///< a polytope in the subspace given by `equations`, perhaps one point
};
std::string_view to_string(IntersectionKind kind);

/// A halfspace and its weight in a combination of halfspaces.
struct HalfspaceWeight {
  std::uint32_t halfspace;
  double weight;  ///< of the row as given, > 0
};

struct IntersectionOptions {
  /// Strictly inside all halfspaces; none: the centre of a largest ball is found.
  std::optional<std::vector<double>> interior_point = {};
  bool measure = true;  ///< volume and areas; they take longer than the vertices
  Limits limits = {};   ///< of the dual hull: max_facets are vertices, before coincident ones are merged
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const Progress&)> progress = {};
  std::stop_token stop = {};
};

/// The result. Ids of halfspaces are rows of the input.
struct HalfspaceIntersection {
  IntersectionKind kind = IntersectionKind::kEmpty;
  /// Of the dual hull. Anything but kComplete: vertices are those of some of the halfspaces, so the
  /// intersection is inside them; none when these bound nothing yet. There is no volume then.
  HullStatus status = HullStatus::kComplete;
  std::size_t dimension = 0;
  std::size_t rank = 0;  ///< of the region, when it is not empty
  std::size_t halfspace_count = 0;

  std::vector<double> interior_point;  ///< strictly inside all halfspaces but the equalities
  /// [distance] Of the largest ball around a point of the region (inside its subspace), infinite when there
  /// is no largest; 0 when an interior point was given.
  double inner_radius = 0.0;

  /// kUnbounded: unit length, with a.u <= 0 for all rows; `direction_margin` is the largest a.u / |a|, 0 up
  /// to rounding.
  std::vector<double> direction;
  double direction_margin = 0.0;

  /// kEmpty: sum weight a = 0 up to `proof_residual` (a distance per unit of length of x) while
  /// sum weight b = proof_gap > 0, scaled so that sum weight |a| = 1.
  std::vector<HalfspaceWeight> proof;
  double proof_gap = 0.0;       ///< [distance]
  double proof_residual = 0.0;  ///< length of sum weight a

  /// rank < dimension: rows of dimension + 1 numbers, orthonormal normals and offsets of the subspace, and
  /// the halfspaces whose planes contain the region.
  std::vector<double> equations;
  std::vector<std::uint32_t> equalities;

  std::vector<double> vertices;  ///< bounded kinds: rows x dimension
  /// Of each vertex: the halfspaces that meet in it, ascending, less equalities and those that only touch the
  /// region.
  IdRows halfspaces_of;
  IdRows neighbours_of;  ///< of each vertex: those it shares an edge or, degenerate, a ridge with
  std::vector<std::uint32_t> non_redundant;  ///< ascending, less equalities: without one the region is larger
  double max_residual = 0.0;                 ///< [distance] largest of a vertex from a plane it is on

  std::optional<double> volume;  ///< of dimension rank; none: no double, or too much memory
  std::optional<double> area;    ///< of all facets, of dimension rank - 1
  HullStatus measure_status =
      HullStatus::kComplete;  ///< the limit that volume and area were not found within
  double region_seconds = 0.0, dual_hull_seconds = 0.0, vertex_seconds = 0.0, measure_seconds = 0.0;

  std::size_t vertex_count() const { return dimension == 0 ? 0 : vertices.size() / dimension; }
};

/// Intersects halfspaces a.x + b <= 0.
///
/// Shapes    halfspaces: rows x (dimension + 1), each a_1 .. a_d, b; normals of any length but zero.
/// Method    A point inside, by linear programs (halfspace_region.h); about a well centred one each plane is
///           a dual point, and the facets of their hull are the vertices. Vertices are refined on the planes
///           as given, by distances summed in twice the precision.
/// Merged    Vertices that differ by no more than the rounding of the planes' own numbers, or that the dual
///           hull's coplanar merging holds for one, are one vertex with all their halfspaces.
/// Throws    Error kBadHalfspace a zero normal, or an interior point that is not inside, with the halfspace
///           and the distance, or a region too long for doubles; kNotFinite, also of the interior point;
///           kEmptyInput no rows; kDimensionTooLow fewer than two columns; kTooManyPoints 2^31 rows; kUsage an
///           interior point of another dimension; kDimensionTooHigh rank above kMaxRank.
/// Cost      linear programs with rank rows, then the hull of the dual points; `measure`: see
///           measure_polytope.
HalfspaceIntersection intersect_halfspaces(const PointView& halfspaces,
                                           const IntersectionOptions& options = {});

}  // namespace ndhull
