// A polytope given by planes around the origin: its vertices and the planes that meet in each.
//
// The plane n.y <= h, h > 0, is the dual point n / h; facets of the hull of the dual points are the vertices
// of the polytope (Preparata, Muller. Finding the intersection of n half-spaces in time O(n log n).
// Theoretical Computer Science 8, 1979).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/hull.h"
#include "core/id_rows.h"

namespace ndhull {

/// {y : normal_i . y <= height_i}, all heights > 0. Row k of normals belongs to heights[k].
struct PlanesAboutOrigin {
  std::size_t rank = 0;         ///< coordinates
  std::vector<double> normals;  ///< rows x rank, unit length
  std::vector<double> heights;  ///< distances of the planes from the origin
};

/// Vertices and, simplex by simplex, the planes in them. A vertex in which more than rank planes meet has
/// several simplices: together they say how it looks when the planes are moved a little.
struct PlanePolytope {
  bool bounded = true;  ///< otherwise nothing but the status is set
  HullStatus status = HullStatus::kComplete;
  std::vector<double> vertices;              ///< rows x rank
  std::vector<std::uint32_t> planes;         ///< simplices x rank: the planes of each simplex
  std::vector<std::uint32_t> vertex_of;      ///< of each simplex
  IdRows planes_of;                          ///< of each vertex, in no order
  IdRows neighbours_of;                      ///< of each vertex: those its simplices share a ridge with
  std::vector<std::uint32_t> non_redundant;  ///< planes without which the polytope would be larger, ascending

  std::size_t vertex_count(std::size_t rank) const { return vertices.size() / rank; }
};

/// Intersects the halfspaces below the planes.
///
/// Limits  options.limits.max_facets bounds the simplices; status says when it was hit: then the polytope is
///         that of some of the planes; nothing but the status is set without options.wants_partial.
/// Throws  Error as convex_hull does.
/// Cost    that of the hull of the dual points.
PlanePolytope intersect_about_origin(const PlanesAboutOrigin& planes, const HullOptions& options);

/// What the polytope measures.
struct PolytopeMeasure {
  HullStatus status = HullStatus::kComplete;  ///< otherwise nothing is measured
  double volume = 0.0;                        ///< of dimension rank
  double area = 0.0;                          ///< of all facets, of dimension rank - 1
};

/// [bytes] About what measuring takes: all faces, most of them at the middle dimensions. (940 a vertex in 5-d,
/// 1,184 in 6-d, 2,725 in 7-d and 5,040 in 8-d were seen, what the dual hull takes among them.)
double bytes_of_measure(std::size_t rank, std::size_t simplices);

/// Volume and area.
///
/// Method  Few vertices in which many planes meet: the hull of the vertices. Otherwise the measure of a face
///         is the sum over its own facets of height times measure, over its dimension, seen from one vertex
///         of the face. Faces are sets of planes; each is computed once (Bueler, Enge, Fukuda. Exact volume
///         computation for polytopes: a practical study. Polytopes - Combinatorics and Computation, 2000).
///         Terms have signs (approx/polytope/signed_measure.h) to 9-d, and beyond where facets without signs
///         are not in balance, so that faces that rounding has folded cancel. Thin polytopes are measured
///         twice: their volume as linear images that are thin nowhere.
/// Shapes  wants_area: otherwise the area may be 0.
/// Limits  options.limits.max_seconds, options.stop; kMemoryLimit where bytes_of_measure is more than
///         options.limits.max_memory_bytes, or signs are needed and take more than a gigabyte.
/// Error   2e-13 relative was the largest seen on polytopes whose volume is known. Of thin ones the rounding
///         of the planes, over their thickness.
/// Cost    time and memory by the faces of all dimensions, 2^rank a simplex at most: about 7 microseconds a
///         vertex in 6-d, 25 in 8-d.
PolytopeMeasure measure_polytope(const PlanesAboutOrigin& planes, const PlanePolytope& polytope,
                                 const HullOptions& options = {}, bool wants_area = true);

}  // namespace ndhull
