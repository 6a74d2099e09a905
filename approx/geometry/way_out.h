// Where few planes of a hull leave a region that is as good as open.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace ndhull {

/// The direction in which planes leave a way out of a hull, or nothing. A region that reaches a thousand times
/// further than the hull, along an axis of the frame, is as good as open: the normals of few wide facets may be
/// balanced, or span the space, by the tilt alone that a fit gave them.
///
/// Shapes  planes: rows of `rank` numbers, one or more, dual planes in the hull's frame.
/// Returns a unit vector of the frame.
/// Cost    3 rank + 1 linear programs with a column for each plane.
std::optional<std::vector<double>> find_way_out(std::span<const double> planes, std::size_t rank);

}  // namespace ndhull
