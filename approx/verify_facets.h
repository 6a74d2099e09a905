// The parts of a verification; approx/verify.h has the whole.
#pragma once

#include "approx/verify.h"

namespace ndhull {

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

/// kFacets, kVertices, kNormals, kInner, kRidges, kInterior: what can be told facet by facet. Ids that name
/// nothing are failures, not accidents.
void verify_facets(const PointView& points, const HullClaims& hull, DoubtfulSign doubtful,
                   Verification& result);

/// kOrientation. Precondition: the complex is sound, rank = dimension >= 2.
void verify_orientation(const PointView& points, const HullClaims& hull, Verification& result);

}  // namespace ndhull
