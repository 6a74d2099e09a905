// When the exact hull is a better answer than an approximate one.
#pragma once

#include <cstdint>
#include <optional>

#include "approx/accuracy.h"
#include "approx/hull.h"

namespace ndhull {

/// With more facets than these the exact hull is no better than an approximate one that has so many; 0: it is
/// not compared for that.
std::uint64_t most_exact_facets(const ResolvedAccuracy& lengths, const Accuracy& accuracy,
                                std::uint64_t facets);

/// Is the exact hull worth growing as well? For widths near rounding, which were missed; and where so many
/// points share planes that few facets may hold all of them, which coverings by slabs need not find.
///
/// may_be_few: may_be_few_facets (approx/facets/exact_facets.h) of `hull`'s complex and most_exact_facets.
///
/// Returns   how many simplices it may have to be compared, 0: any number; nothing: it is not worth it. Of
///           shared planes, where facets are few, some times those that the approximate hull has.
std::optional<std::uint64_t> simplices_of_exact(const Hull& hull, bool may_be_few, const HullOptions& options,
                                                const ResolvedAccuracy& lengths);

/// Is the complete hull `exact` what was asked for rather than `hull`? For a width that both keep, the one of
/// fewer facets; else the narrower one, of facets no more than were asked for.
bool is_exact_better(const Hull& exact, const Hull& hull, const Accuracy& accuracy,
                     const ResolvedAccuracy& lengths);

}  // namespace ndhull
