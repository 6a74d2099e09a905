// How much the outer planes of a hull enclose: what an intersection of them pays for having fewer planes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "approx/hull.h"

namespace ndhull {

/// A volume, or why there is none.
struct OuterVolume {
  std::optional<double> volume;  ///< input units to the power of the rank
  std::string reason;            ///< without a volume: one line
};

/// Volume of the polytope below the certified outer planes of `facets` (none: of all facets), about the
/// hull's interior point; inside the affine subspace when the hull is flat.
///
/// Returns   no volume when the planes do not bound a region, or when it has more than about max_simplices
///           vertices (its vertices as simplices of the dual hull).
/// Error     as measure_polytope's.
/// Cost      the dual hull, then the faces of all dimensions; memory some 2^rank times 8 bytes a vertex.
OuterVolume outer_volume(const Hull& hull, std::span<const FacetId> facets, std::uint64_t max_simplices);

}  // namespace ndhull
