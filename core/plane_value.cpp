// Three steps, each used only where the one before leaves the sign open: doubles, pairs of doubles, exact
// numbers.
//
// Error bounds. u = 2^-53; S = sum |n_k| |x_k - r_k| + |offset| + |claimed unit|, all terms as computed.
//   double     x_k - r_k and each product add one relative error u to a term, the d + 1 additions at most
//              (d + 1) u: (d + 3) u S. The bound takes (d + 8) u S, which covers the rounding of S itself.
//   extended   the difference x - r is a pair without error. A product of pair and double errs by at most 2
//              u^2 of itself, an addition of pairs by at most 4 u^2 (|a| + |b|) in absolute terms, also where
//              they cancel. Partial sums are at most S (1 + tiny), so the total is below (8 d + 24) u^2 S;
//              the bound takes (d + 4) 2^-100 S = 64 (d + 4) u^2 S.
// Where no operation on pairs loses a bit, as with integers and most points exactly on a plane, error is 0.
// Each operation may besides lose one subnormal, 2^-1074: kSubnormal per term is far more than that.

#include "core/plane_value.h"

#include <cmath>

#include "core/exact_orientation.h"

namespace ndhull {
namespace {

constexpr double kUnitRoundoff = 0x1p-53;
constexpr double kExtendedRoundoff = 0x1p-100;
constexpr double kSubnormal = 0x1p-1068;
/// The low half of a product has its last bit at most 106 places below the first.
constexpr double kSmallestExactProduct = 0x1p-960;

constexpr double kNearOverflow = 1e300;

/// high + low, |low| at most half an ulp of high.
struct Pair {
  double high = 0.0;
  double low = 0.0;
};

Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

Pair fast_two_sum(double large, double small) {
  const double sum = large + small;
  return {sum, small - (sum - large)};
}

/// Algorithm 6 of the source: correct also where the pairs cancel. Clears `exact` when a bit is lost.
Pair add(const Pair& a, const Pair& b, bool& exact) {
  const Pair high = two_sum(a.high, b.high);
  const Pair low = two_sum(a.low, b.low);
  const Pair middle = two_sum(high.low, low.high);
  const Pair sum = fast_two_sum(high.high, middle.high);
  const Pair rest = two_sum(low.low, sum.low);
  exact = exact && middle.low == 0.0 && rest.low == 0.0;
  return fast_two_sum(sum.high, rest.high);
}

/// Clears `exact` when a bit may be lost: small products may underflow.
Pair multiply(const Pair& a, double b, bool& exact) {
  Pair product = two_product(a.high, b);
  if (a.low != 0.0 || (std::fabs(product.high) < kSmallestExactProduct && a.high != 0.0 && b != 0.0)) {
    exact = false;
  }
  product.low = std::fma(a.low, b, product.low);
  return fast_two_sum(product.high, product.low);
}

double reference_of(const CentredPlane& plane, std::size_t k) {
  return plane.reference.empty() ? 0.0 : plane.reference[k];
}

}  // namespace

BoundedValue plane_value_double(const CentredPlane& plane, std::span<const double> point) {
  const double claim = plane.claimed * plane.unit;
  double value = plane.offset - claim;
  double magnitude = std::fabs(plane.offset) + std::fabs(claim);
  for (std::size_t k = 0; k < plane.normal.size(); ++k) {
    const double term = plane.normal[k] * (point[k] - reference_of(plane, k));
    value += term;
    magnitude += std::fabs(term);
  }
  const auto terms = static_cast<double>(plane.normal.size() + 8);
  return {value, terms * (kUnitRoundoff * magnitude + kSubnormal)};
}

BoundedValue plane_value_extended(const CentredPlane& plane, std::span<const double> point) {
  bool exact = true;
  const Pair claim = multiply({-plane.claimed, 0.0}, plane.unit, exact);
  Pair value = add({plane.offset, 0.0}, claim, exact);
  double magnitude = std::fabs(plane.offset) + std::fabs(claim.high);
  for (std::size_t k = 0; k < plane.normal.size(); ++k) {
    const Pair term = multiply(two_sum(point[k], -reference_of(plane, k)), plane.normal[k], exact);
    value = add(value, term, exact);
    magnitude += std::fabs(term.high);
  }
  if (exact && magnitude < kNearOverflow) return {value.high, 0.0};
  const auto terms = static_cast<double>(plane.normal.size() + 4);
  return {value.high, terms * (kExtendedRoundoff * magnitude + kSubnormal)};
}

double plane_value(const CentredPlane& plane, std::span<const double> point, DoubtfulSign doubtful) {
  if (doubtful == DoubtfulSign::kExact) return exact_plane_value(plane, point);
  const BoundedValue extended = plane_value_extended(plane, point);
  return extended.certain() ? extended.value : exact_plane_value(plane, point);
}

double plane_sign(const CentredPlane& plane, std::span<const double> point, DoubtfulSign doubtful) {
  const BoundedValue value = plane_value_double(plane, point);
  return value.certain() ? value.value : plane_value(plane, point, doubtful);
}

}  // namespace ndhull
