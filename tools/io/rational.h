// Rational numbers of any length, as cdd and lrs write them.
#pragma once

#include <optional>
#include <string_view>

namespace ndhull {

/// The double nearest to p/q, halves to even; infinite or 0 where that is beyond doubles, and of subnormal
/// results within one unit.
///
/// Shapes   p and q: digits with or without a sign in front, as many as there are.
/// Returns  nothing when one of them is no whole number, or q is 0.
std::optional<double> nearest_quotient(std::string_view p, std::string_view q);

}  // namespace ndhull
