// The growth complex: simplices with their vertices, neighbours and dual planes, in flat tables.
//
// Invariants (core/complex/complex_check.h tests the first three)
//   * neighbour k of a simplex is opposite its vertex k, and shares the other rank-1 vertices;
//   * the relation is symmetric and closed: no neighbour is none;
//   * replacing a vertex never changes the order of the others, so the orientation of the vertex rows is
//     the same for all simplices;
//   * a simplex without points outside has outside_head 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// What a row of the tables holds just now.
enum class SimplexState : std::uint8_t {
  kFree = 0,  ///< not in use
  kLive = 1,  ///< part of the hull
};

/// Simplicial facets as parallel rows: row s of each table is SimplexId s.
///
/// Shapes  planes: rows x rank, the dual vertex a with a.y = 1 on the facet in the frame's coordinates.
///         topology: rows x 2 rank, first the vertices (PointId values), then the neighbours.
/// Memory  16 rank + 5 bytes a row: 133 bytes in 8-d.
struct SimplicialComplex {
  std::size_t rank = 0;
  std::size_t row_count = 0;  ///< rows in use or free; after `compact` all of them are live
  HugeArray<double> planes;
  HugeArray<std::uint32_t> topology;
  HugeArray<SimplexState> state;
  HugeArray<std::uint32_t>
      outside_head;  ///< first point of the outside set + 1, 0 when empty; none after `compact`

  SimplicialComplex() = default;
  SimplicialComplex(std::size_t rank_of_points, std::size_t capacity)
      : rank(rank_of_points),
        planes(capacity * rank_of_points),
        topology(capacity * 2 * rank_of_points),
        state(capacity),
        outside_head(capacity) {}

  std::span<const double> plane(SimplexId simplex) const {
    return {planes.data() + std::size_t{simplex.value} * rank, rank};
  }
  std::span<const PointId> vertices(SimplexId simplex) const {
    return {reinterpret_cast<const PointId*>(topology.data() + std::size_t{simplex.value} * 2 * rank), rank};
  }
  std::span<const SimplexId> neighbours(SimplexId simplex) const {
    return {
        reinterpret_cast<const SimplexId*>(topology.data() + std::size_t{simplex.value} * 2 * rank + rank),
        rank};
  }
};

/// Simplices without planes, those of each facet one after the other.
struct GroupedComplex {
  SimplicialComplex complex;
  std::vector<std::uint32_t> facet_begin;  ///< facets + 1 entries: rows of the complex
};

/// One flag for each of `point_count` points: is it a vertex of a live simplex among rows `begin` to, not
/// including, `end`? `most`: no more are. Cost  O(rows rank), by all threads, less where so many points are;
/// a byte a point.
std::vector<bool> find_corners(const SimplicialComplex& complex, std::size_t begin, std::size_t end,
                               std::size_t point_count, std::size_t most = SIZE_MAX);

/// Row `from` is now row `to`.
struct RowMove {
  std::uint32_t from, to;
};

/// Growth is over: renumbers the live rows to 0 .. n-1, the last ones to the places of free ones, and gives
/// the rest of the memory and that of the outside sets back. Returns the rows that moved. Cost O(rows), 4
/// bytes a row of scratch.
std::vector<RowMove> compact(SimplicialComplex& complex);

/// Puts the vertices and neighbours of row old_of_new[r] into row r, for all live rows of a compacted
/// complex, and renames the neighbours. The first `planes_kept` planes stay where they are; the memory of the
/// others serves to copy rows through, where it is enough, and is given back. Rows that stay cost one
/// comparison; the others are copied twice at most.
void permute_topology(SimplicialComplex& complex, std::span<const std::uint32_t> old_of_new,
                      std::size_t planes_kept);

/// The hull of points on a line through 0, of which some are on either side: its two ends.
///
/// Shapes  coordinates: `count` of them.
SimplicialComplex make_segment(const double* coordinates, std::size_t count);

}  // namespace ndhull
