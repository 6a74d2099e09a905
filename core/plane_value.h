// The value of a plane at a point, with a proven error bound and a sign that is never wrong.
#pragma once

#include <cstddef>
#include <span>

namespace ndhull {

/// A plane and a distance claimed for it: value(x) = normal . (x - reference) + offset - claimed * unit.
/// Positive: x is above the parallel plane at `claimed`. All numbers are exactly the doubles given.
struct CentredPlane {
  std::span<const double> normal;     ///< of any length but zero
  std::span<const double> reference;  ///< as many numbers, or empty for the origin
  double offset = 0.0;
  double claimed = 0.0;  ///< [distance] in some length unit
  double unit = 1.0;     ///< input units in one length unit
};

/// A value and a bound of its absolute error.
struct BoundedValue {
  double value;
  double error;
  /// The sign of value is the true one; error 0 says that value is exact, or its only rounding.
  bool certain() const { return value > error || value < -error || error == 0.0; }
};

/// In double arithmetic. error is infinite or NaN, so never certain, where a term overflows.
/// Cost  about 4 d operations.
BoundedValue plane_value_double(const CentredPlane& plane, std::span<const double> point);

/// With pairs of doubles, about 100 bits. Source: Joldes, Muller, Popescu. Tight and rigorous error bounds
/// for basic building blocks of double-word arithmetic. ACM TOMS 44(2), 2017.
/// Cost  about 25 d operations and d fused multiply-adds.
BoundedValue plane_value_extended(const CentredPlane& plane, std::span<const double> point);

/// What follows double arithmetic where that leaves the sign open.
enum class DoubtfulSign {
  kExtendedThenExact,  ///< pairs of doubles, and exact arithmetic if these leave it open too
  kExact,              ///< exact arithmetic at once
};

/// The refined value: the same double for the same arguments on every machine, its sign exact. Pairs of
/// doubles or exact arithmetic whatever the double value is.
double plane_value(const CentredPlane& plane, std::span<const double> point, DoubtfulSign doubtful);

/// The sign of the value as a number: double arithmetic where it is certain, otherwise `plane_value`.
double plane_sign(const CentredPlane& plane, std::span<const double> point, DoubtfulSign doubtful);

}  // namespace ndhull
