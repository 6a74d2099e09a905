// Facets against certified width: what fewer facets cost, to choose from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"

namespace ndhull {

/// One hull of the curve.
struct TradePoint {
  std::uint64_t facets = 0;
  double width = 0.0;    ///< [length unit] widest facet, certified
  double seconds = 0.0;  ///< of this hull alone
};

/// Hulls of the same points with larger and larger target widths, each 1.41 times the one before, from that
/// of `first` (or 1 % of the largest extent if it is finer) until a simplex's number of facets is reached, 64
/// % of the extent, a limit or a stop.
///
/// Rows    `first` comes first, then fewer and fewer facets. A hull is left out when another has no more
///         facets and none wider, so widths rise from the second row on. `first` stays even so: one that was
///         merged by another rule may be beaten.
/// Shapes  points as for convex_hull; options: those of `first`, whose limits each hull is under as well, but
///         for the seconds, which are for all of them together; seconds: what `first` took.
/// Cost    a hull each; together some 3 times the first when that has a target, else 5 to 10 times the exact
///         hull.
/// Throws  as convex_hull.
std::vector<TradePoint> trade_curve(const PointView& points, const HullOptions& options, const Hull& first,
                                    double seconds);

/// The files that `--curve path` means: the table, and the picture beside it.
struct CurvePaths {
  std::string table, picture;
};
/// `path` ending in .csv or .svg, or without either: both are added. Throws Error kUsage for "-".
CurvePaths curve_paths(const std::string& path);

/// The table, CSV with a header, and the picture, SVG with logarithmic axes. unit: what widths are in.
/// Throws  Error kFileWrite.
void write_trade_curve(const CurvePaths& paths, const std::vector<TradePoint>& curve,
                       const std::string& unit);

}  // namespace ndhull
