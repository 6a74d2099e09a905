// The hull of its vertices, star by star: what is around one vertex is a hull of one dimension less.
//
// Idea. The simplices that hold a vertex v are the facets of its vertex figure: the lines from v to the other
// vertices, cut by a plane that parts v from them, are the points of a hull of dimension rank - 1. Each is
// grown by itself (core/growth/growth), fits into the second cache, and is forgotten; a simplex is kept by
// the star of its first vertex. So a hull of which only the vertices are known takes rank times the work of
// growing it whole, shared among threads without waiting, and a tenth of the memory.
//
// Proof. Each star is closed. If every simplex is found in the stars of all its rank vertices, each ridge is
// in two simplices of the stars of its vertices, so that what was kept is a closed complex, and convex where
// the stars are. That is seen from sums of a number for each simplex, chosen at random: those of all stars
// are rank times those of what was kept, and by chance with a probability of 2^-64.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/complex/simplex_rows.h"

namespace ndhull {

struct StarOptions {
  std::uint64_t most_rows = std::uint64_t{1} << 28;  ///< more simplices, and it is given up
  std::uint64_t most_table_rows = 0;                 ///< the same for the tables of one star; 0: no limit
  /// Asked after each star, by any thread: give up? Tells how many stars there are by then, and simplices.
  std::function<bool(std::size_t, std::uint64_t)> gives_up = {};
};

/// The simplices of the hull of `vertices`. Nothing where it was given up, and where the stars do not make a
/// closed complex: data are degenerate.
///
/// Shapes  vertices: any number up to SimplexRows::kMostVertices x rank, rank >= 3, each a vertex of their
///         hull. normals: the same; n.(x - v) < 0 for vertex v and every other x, the clearer the better.
/// Cost    rank times the simplices, each as long as in growth; the memory of a star for each thread, and
///         2 (rank - 1) bytes a simplex.
/// Source  vertex figures: Grünbaum. Convex Polytopes. 2nd ed., 2003, section 3.4.
std::optional<SimplexRows> grow_stars(std::size_t rank, std::span<const double> vertices,
                                      std::span<const double> normals, const StarOptions& options);

}  // namespace ndhull
