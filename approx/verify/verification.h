// What a verification found, claim by claim.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

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

/// Adds what `b`, of later facets, found.
void join_records(ClaimRecord& a, const ClaimRecord& b);

/// Counts one check; `describe` is called for the first failure only.
template <class Describe>
void record_check(ClaimRecord& record, bool holds, const Describe& describe, double excess = 0.0) {
  ++record.checks;
  if (holds) return;
  if (record.failures++ == 0) record.first_failure = describe();
  if (excess > record.worst_excess) record.worst_excess = excess;
}

/// "found 1.5, claimed 1", in 17 digits.
std::string found_and_claimed(double found, double claimed);

}  // namespace ndhull
