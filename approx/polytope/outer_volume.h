// How much the outer planes of a hull enclose: what an intersection of them pays for having fewer planes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include "approx/hull.h"
#include "approx/polytope/plane_polytope.h"

namespace ndhull {

/// The certified outer planes of `facets` (none: of all facets) about the hull's interior point, in
/// orthonormal coordinates of the subspace that the points span, input units.
PlanesAboutOrigin outer_planes_about_interior(const Hull& hull, std::span<const FacetId> facets);

/// Which limit the polytope of so many planes is surely beyond before it is begun; kComplete: none. Few
/// outer planes of a hull are redundant, so that there are many more vertices; and a hull of their dual
/// points looks at the clock only when it has read them.
HullStatus limit_before_outer_polytope(std::size_t rank, std::size_t planes, const Limits& limits);

/// Why there is no measure of the outer polytope whose work ended so.
std::string reason_of_end(HullStatus status, const Limits& limits);

/// A volume, or why there is none.
struct OuterVolume {
  std::optional<double> volume;  ///< input units to the power of the rank
  std::string reason;            ///< without a volume: one line
};

/// Volume of the polytope below the certified outer planes of `facets` (none: of all facets), about the
/// hull's interior point; inside the affine subspace when the hull is flat.
///
/// Returns   no volume when the planes do not bound a region, when it has more than about limits.max_facets
///           vertices (its vertices as simplices of the dual hull), after a request to stop, or when it would
///           take longer, or more memory, than limits say.
/// Error     as measure_polytope's.
/// Cost      of all facets of an exact hull O(facets dimension): its own volume, raised by what the widths
///           allow. Else the dual hull, then the faces of all dimensions; memory some 2^rank times 20 bytes a
///           vertex. Planes too many for max_facets vertices cost nothing.
/// Threads   the result does not depend on their number.
OuterVolume outer_volume(const Hull& hull, std::span<const FacetId> facets, const Limits& limits = {},
                         unsigned threads = 0, const std::stop_token& stop = {});

/// A max_facets with which the volume costs at most about 0.01 s or a fifth of the hull's growth,
/// whichever is more, and no more memory than limits.max_memory_bytes. The same for the same hull on every
/// machine.
std::uint64_t affordable_simplices(const Hull& hull, const Limits& limits = {});

}  // namespace ndhull
