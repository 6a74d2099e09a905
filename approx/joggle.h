// Joggled input: every coordinate is moved a little at random, so that no decision is near and all facets are
// simplices. The other answer to degenerate input; merging coplanar facets is the better one (the manual of
// Qhull says by a factor of 2000 in width).
//
// Source  Barber, Dobkin, Huhdanpaa. Qhull manual, "Joggled input"; option QJ of Qhull.
#pragma once

#include <cstdint>
#include <vector>

#include "approx/hull.h"
#include "core/points.h"

namespace ndhull {

struct JoggleOptions {
  double size = 0.0;       ///< [distance] a coordinate moves by at most this; 0: default_joggle
  std::uint64_t seed = 1;  ///< of the random numbers
};

/// The hull of joggled points, with planes that hold for the points given.
struct JoggledHull {
  std::vector<double> points;  ///< rows x dimension, joggled: what the facets' planes pass through
  Hull hull;                   ///< of these; outer and inner offsets are widened by `moved`
  double size = 0.0;           ///< [distance] of the joggle in the end
  double moved = 0.0;          ///< [distance] furthest that a point was moved, at most size sqrt(d)
  unsigned retries = 0;        ///< joggles before this one that had a precision problem
};

/// A bound on the rounding of a distance, as Qhull estimates it: 2^-52 (1.01 d min(sqrt(d) M, S) + M) with M
/// the largest absolute coordinate and S the sum over the columns of their largest. [distance]
double joggle_roundoff(const PointView& points);

/// 30,000 times joggle_roundoff, as Qhull: enough for most inputs at the first try. [distance]
double default_joggle(const PointView& points);

/// Growth met a decision within rounding, or the points span fewer dimensions than they have. The rounding of
/// a decision is taken as 2^-52 (d^1.5 + 1) relative to the hull's own size: joggle_roundoff's share of half
/// an extent. Counted are decisions whether a facet is visible from a point that is added, the bulk of what
/// Qhull counts; it also counts nearly singular planes, of which there are none here (approx/DESIGN.md,
/// Joggled input).
bool has_precision_problem(const Hull& hull);

/// Options for hulls whose decisions are watched: facets stay simplices unless a width is asked for.
HullOptions watched_options(const HullOptions& options, std::size_t dimension);

/// Copies the points, every coordinate moved by a number uniform in [-size, size).
std::vector<double> joggled_points(const PointView& points, double size, std::uint64_t seed);

/// Joggles until there is no precision problem: a second time with the same size, then with ten times as much
/// each time, up to a hundredth of the largest extent.
///
/// Returns   also after a limit or a stop was hit: Hull::status tells.
/// Throws    Error as convex_hull; kUsage for a size below joggle_roundoff, with both, or no number; kUsage after 50
///           joggles that all had a problem.
/// Cost      of convex_hull, once for each joggle.
JoggledHull joggled_hull(const PointView& points, const HullOptions& options, const JoggleOptions& joggle);

/// How many of `runs` joggles with seeds seed, seed + 1, .. have a precision problem: option TRn of Qhull.
std::uint64_t count_precision_problems(const PointView& points, const HullOptions& options,
                                       const JoggleOptions& joggle, std::uint64_t runs);

}  // namespace ndhull
