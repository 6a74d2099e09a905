// Is it worth growing a hull to drop points that are inside it?
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/points.h"

namespace ndhull {

/// Is a point of a small sample inside a small hull of it? If none is, as on spheres, a larger hull holds
/// hardly any either.
///
/// Shapes   sample: rows x d, finite, d in 2 .. 16. seed: of the hull's shifts.
/// Returns  true also when the sample spans less than d dimensions.
/// Cost     growth to 128 simplices a dimension, and locating some 512 points.
bool holds_some_of(const PointView& sample, std::uint64_t seed);

}  // namespace ndhull
