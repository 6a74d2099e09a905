// The vertices of a hull without its facets, in any dimension.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/points.h"

namespace ndhull {

/// Largest rank whose vertices are looked for. [dimensions]
inline constexpr std::size_t kMaxExtremeRank = 512;

struct ExtremeOptions {
  double max_seconds = 0.0;   ///< wall clock; 0: none
  unsigned threads = 0;       ///< 0: all cores. The result does not depend on it.
  std::stop_token stop = {};  ///< ends with the vertices found so far
  /// Called from the calling thread with a few words on how far it is.
  std::function<void(std::string_view)> progress = {};
};

enum class ExtremeStatus { kComplete, kTimeLimit, kInterrupted };
std::string_view to_string(ExtremeStatus status);

/// The vertices, each with a plane that parts it from all other points.
struct ExtremePoints {
  std::size_t dimension = 0, rank = 0, point_count = 0;
  ExtremeStatus status = ExtremeStatus::kComplete;
  std::vector<PointId> vertices;  ///< ascending; of points that are equal, or equal up to roundoff, the first
  /// One row a vertex, dimension + 1 numbers, unit normal and offset: normal . x + offset is above 0 at the
  /// vertex (and at its copies) and below 0 at all others. Empty when all points are equal.
  std::vector<double> planes;
  /// One a vertex, itself included: points of the input equal to it, and those equal up to roundoff that are
  /// above its plane.
  std::vector<std::uint32_t> copies;
  std::vector<double> interior_point;
  std::uint64_t points_inside = 0;  ///< distinct points that are no vertices
  /// Distinct points that were not decided: rounding, or a limit. 0 when complete, but for rounding.
  std::uint64_t open_points = 0;
  double seconds = 0.0;
};

/// Finds the vertices.
///
/// Method    For each point one linear program: is it a combination of others? Over the points found to be
///           extreme so far first; a direction in which none of these is as far is tried on all points. Then
///           the furthest of all joins them, or the point is a vertex (Clarkson. More output-sensitive
///           geometric algorithms. FOCS 1994; Ottmann, Schuierer, Soundaralakshmi. Enumerating extreme points
///           in higher dimensions. STACS 1995).
/// Roundoff  A point less than about 2e-12 of the hull's size outside the hull of the others is none, as for
///           growth. Of points within 2.5e-13 of each other the first stands for all; what is within 2e-12 of
///           a vertex and not decided otherwise goes with it. A vertex that no plane of doubles parts, far
///           from the origin or of hulls as thin as rounding, is open.
/// Throws    Error as fit_frame and check_extents; kDimensionTooHigh rank above kMaxExtremeRank.
/// Cost      points x vertices x dimension multiply-adds at the worst, times the pivots of a program (10 in
///           10-d); 12 rank bytes a point, 8 dimension a vertex. Where coordinates are more than 1e8 times
///           the hull's size, or it is as thin, some 10 dimension operations more for each point and vertex.
ExtremePoints extreme_points(const PointView& points, const ExtremeOptions& options = {});

}  // namespace ndhull
