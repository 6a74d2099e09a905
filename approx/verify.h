// A witness: tests everything a hull claims, with code and arithmetic that share nothing with what made it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "approx/hull.h"
#include "approx/hull_claims.h"
#include "core/points.h"

namespace ndhull {

enum class VerifyMode {
  kFloating,  ///< doubles with proven bounds, pairs of doubles where these leave a sign open; may take
              ///< samples
  kExact,     ///< exact arithmetic wherever doubles leave a sign open, all planes and points; orientations
};

/// What a hull claims, in the order of the checks.
enum class Claim {
  kComplex,   ///< the simplices form a closed, oriented, connected complex: a ridge belongs to two of them
  kFacets,    ///< simplices are divided among the facets; facets are neighbours, both ways, exactly where
              ///< simplices are; at least rank neighbours
  kVertices,  ///< ids are input rows; a facet has rank vertices or more, all of its own simplices; a vertex
              ///< of the hull is in rank facets or more; no vertex is left out
  kNormals,   ///< unit length; `offset` is centred_offset within roundoff
  kOuter,     ///< no input point is above a facet's outer plane
  kInner,     ///< no vertex of a facet is below its inner plane
  kRidges,    ///< no vertex of a facet or of its neighbours is above the facet's outer plane
  kInterior,  ///< the interior point is strictly below every facet's plane
  kNumbers,   ///< the hull's maximum and minimum offsets are those of its facets; area and volume positive
  kOrientation,  ///< kExact, full rank: over a simplicial facet's vertices, as exact points, its neighbours'
                 ///< vertices are on the interior point's side, or higher by no more than its
                 ///< width explains (exact_height_test)
  kCount
};
std::string_view to_string(Claim claim);

/// How one claim fared.
struct ClaimRecord {
  std::uint64_t checks = 0;
  std::uint64_t failures = 0;
  bool complete = true;       ///< false: a sample was checked, too much for all
  double worst_excess = 0.0;  ///< [distance] input units: by how much a distance failed at most; 0 otherwise
  std::string first_failure;  ///< one line with ids, the number found and the number claimed
};

/// The result. It says nothing about claims with `checks` 0.
struct Verification {
  VerifyMode mode = VerifyMode::kFloating;
  std::array<ClaimRecord, static_cast<std::size_t>(Claim::kCount)> claims;
  std::uint64_t refined = 0;          ///< pairs of point and outer plane that double arithmetic left open
  std::uint64_t concave_ridges = 0;   ///< kExact: ridges that are not convex as exact points; their facets'
                                      ///< widths explain it unless kOrientation has failures
  double largest_outer_excess = 0.0;  ///< [distance] of all points and outer planes, input units; <= 0 when
                                      ///< kOuter holds: the room that is left

  const ClaimRecord& of(Claim claim) const { return claims[static_cast<std::size_t>(claim)]; }
  ClaimRecord& of(Claim claim) { return claims[static_cast<std::size_t>(claim)]; }
  bool passed() const;
  bool complete() const;
  std::string first_failure() const;  ///< "outer: ..", of the first claim that failed; empty when passed
};

/// Tests the claims of `hull` about `points`, the input it was made from.
///
/// Decisions  each plane is normal . (x - reference) + centred_offset with exactly these doubles, a claimed
///            offset the exact product of offset and input_per_length_unit. No tolerance: a claim that is
///            short by the last bit fails. Both modes decide alike.
/// Samples    kFloating: when facets x points x dimension is above 1e11, every facet against some of the
/// points
///            and every point against some of the facets, at fixed strides; kRidges stays complete. kExact:
///            above 2e6 ridges, or 20,000 nearly flat ones, ridges at a fixed stride. `complete` tells.
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
