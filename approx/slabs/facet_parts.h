// Facets hang together: what covers a hull with slabs leaves some in several parts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Of each facet's connected parts the largest stays, the others go to a neighbouring facet that can hold
/// them within `width`, the one below whose plane they lie highest. Those that none can hold stay where they
/// are.
///
/// Shapes  depth_of: per row of the complex, how deep below its facet's plane it reaches, rounded up; of what
///         moves it is set. is_asked: per facet, not 0: it may have several parts; empty: all may. Planes
///         that were not measured and are needed are measured: their low is infinite.
/// Cost    each ridge of these facets twice, by all threads, and the parts that move again.
void gather_strays(const SimplicialComplex& complex, const WidthSpace& space, double width,
                   Covering& covering, std::vector<float>& depth_of, PlaneFitWork& work,
                   std::span<const std::uint8_t> is_asked = {});

}  // namespace ndhull
