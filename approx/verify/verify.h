// A witness: tests everything a hull claims, with code and arithmetic that share nothing with what made it.
#pragma once

#include "approx/hull.h"
#include "approx/verify/hull_claims.h"
#include "approx/verify/verification.h"
#include "core/points.h"

namespace ndhull {

/// Tests the claims of `hull` about `points`, the input it was made from.
///
/// Decisions  each plane is normal . (x - reference) + centred_offset with exactly these doubles, a claimed
///            offset the exact product of offset and input_per_length_unit. No tolerance: a claim that is
///            short by the last bit fails. Both modes decide alike.
/// Samples    kFloating: when facets x points x dimension is above 1e11, every facet against some of the
///            points and every point against some of the facets, at fixed strides; kRidges stays complete.
///            kExact: above 2e6 ridges, or 20,000 nearly flat ones, ridges at a fixed stride. `complete`
///            tells.
/// rank 0     nothing to check. rank < dimension: kOrientation is left out.
/// Cost       kFloating: as scan_planes, and some microseconds a facet. Threads: all of the caller's arena.
Verification verify_hull(const PointView& points, const Hull& hull, VerifyMode mode);

/// Multiplications that kFloating spends on kOuter before it samples: 4 s on one core with AVX-512 (measured:
/// 24-31 of 10^9 a second in 5-12 d), some 10 s with AVX2.
inline constexpr double kMaxOuterWork = 1e11;

/// The same for anything that makes the claims of a hull.
Verification verify_claims(const PointView& points, const HullClaims& hull, VerifyMode mode,
                           double max_outer_work = kMaxOuterWork);

}  // namespace ndhull
