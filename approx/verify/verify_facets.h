// The parts of a verification; approx/verify/verify.h has the whole.
#pragma once

#include "approx/verify/hull_claims.h"
#include "approx/verify/verification.h"
#include "core/plane_value.h"
#include "core/points.h"

namespace ndhull {

/// kFacets, kVertices, kNormals, kInner, kRidges, kInterior: what can be told facet by facet. Ids that name
/// nothing are failures, not accidents.
void verify_facets(const PointView& points, const HullClaims& hull, DoubtfulSign doubtful,
                   Verification& result);

/// kOrientation. Precondition: the complex is sound, rank = dimension >= 2.
void verify_orientation(const PointView& points, const HullClaims& hull, Verification& result);

}  // namespace ndhull
