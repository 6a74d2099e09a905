// Do planes bound a region, and which more would they need? The outer planes of a selection of facets need
// not: the few largest facets of a hull often leave a way out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// So many facets of which none is wider than the hull is high everywhere bound a region.
inline constexpr std::size_t kSurelyBounded = 1000;

/// Where the polyhedron {x : normal_i . x <= offset_i} goes to infinity, whatever the offsets are.
struct Boundedness {
  bool bounded = false;
  /// Not bounded: a unit vector u, along which no normal points, and which stays in the subspace.
  std::vector<double> direction;
  /// Not bounded: the largest normal_i . u of a unit normal; 0 up to rounding. Without normals 0.
  double margin = 0.0;
};

/// Decides whether the normals positively span the space: only then do they bound a region.
///
/// Shapes  normals: rows x dimension, of any length but zero. equations: as Hull::subspace_equations, rows of
///         dimension + 1 numbers; empty when the region is full-dimensional.
/// Method  The normals are mapped linearly so that they spread evenly (the answer does not change); then
///         each of rank + 1 directions that span the space positively must be a combination of normals with
///         weights >= 0. One linear program each; the dual of one that fails is the direction.
/// Limit   Normals that after the map reach less than 1e-10 far in some direction count as open. Of more than
///         16,384 an even part says what is even, unless it leaves a direction open.
/// Cost    rank + 1 linear programs with rank rows and a column for each normal; of many normals that bound a
///         region for that part of them.
Boundedness find_open_direction(std::span<const double> normals, std::size_t dimension,
                                std::span<const double> equations = {});

/// The same of some rows, those selected, of the normals of one body: some thousand of all of them are spread
/// evenly with these. The map of a few planes of a merged cube makes their rounding as long as the rest: they
/// would bound a region 1e13 times the cube.
Boundedness find_open_direction_of(std::span<const double> normals, std::size_t dimension,
                                   std::span<const std::uint32_t> selected,
                                   std::span<const double> equations = {});

/// Rows of `normals`, apart from those selected, that bound a region together with these; few: found by
/// linear programs that use as little as they can of new normals, several times, then thinned until none
/// can be spared. Ascending; empty when the selection bounds a region already. Deterministic.
///
/// Shapes  as above; selected: rows, none twice. All normals together must bound a region, else all rows
///         that are not selected are returned.
std::vector<std::uint32_t> complete_to_bounded(std::span<const double> normals, std::size_t dimension,
                                               std::span<const std::uint32_t> selected,
                                               std::span<const double> equations = {});

}  // namespace ndhull
