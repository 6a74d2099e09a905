// Where few planes of a hull bound a region that is as good as open.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace ndhull {

/// The direction in which a region that planes bound reaches a thousand times further than the hull, along an
/// axis of the frame, or nothing: the normals of few wide facets may be balanced, or span the space, by the
/// tilt alone that a fit gave them.
///
/// Shapes  planes: rows of `rank` numbers, one or more, dual planes in the hull's frame.
/// Returns a unit vector of the frame.
/// Cost    2 rank linear programs with a column for each plane.
std::optional<std::vector<double>> find_far_reach(std::span<const double> planes, std::size_t rank);

}  // namespace ndhull
