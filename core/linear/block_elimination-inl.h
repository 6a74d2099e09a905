// Small linear systems, one in each vector lane. Included once per target.

#if defined(NDHULL_BLOCK_ELIMINATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef NDHULL_BLOCK_ELIMINATION_INL_H_
#undef NDHULL_BLOCK_ELIMINATION_INL_H_
#else
#define NDHULL_BLOCK_ELIMINATION_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<double>;
using Lane = hn::Vec<Tag>;

/// Up to here loops over a matrix are unrolled. Larger ones would be 14 to 51 kB of instructions, and no
/// quicker.
constexpr std::size_t kMostUnrolled = 10;

/// `call` with each of [first, last).
template <bool kUnrolled, class Call>
HWY_INLINE void for_each_index(std::size_t first, std::size_t last, const Call& call) {
  if constexpr (kUnrolled) {
    HWY_UNROLL(16)  // all of it: at most kMostUnrolled
    for (std::size_t i = first; i < last; ++i) call(i);
  } else {
    for (std::size_t i = first; i < last; ++i) call(i);
  }
}

/// Solves matrix[.][0..D) x = matrix[.][D] in each lane; the matrix is overwritten. Returns the
/// determinant. Gaussian elimination with partial pivoting (Golub, Van Loan. Matrix Computations, 4th
/// ed., 3.4). Row exchanges are blends: each row below that has a larger entry is exchanged with the pivot
/// row in turn, which leaves the largest there. A singular system gives infinities or NaN in its lane.
/// Without pivots it takes less than half the time, and loses as many digits as the smallest diagonal entry
/// it meets is small: `smallest`.
template <std::size_t D, bool kPivots = true>
HWY_INLINE Lane eliminate(Lane (&matrix)[D][D + 1], Lane (&x)[D], Lane* smallest = nullptr) {
  constexpr bool kUnrolled = D <= kMostUnrolled;
  const Tag tag;
  Lane determinant = hn::Set(tag, 1.0);
  if (!kPivots) *smallest = hn::Set(tag, HUGE_VAL);
  for_each_index<kUnrolled>(0, D, [&](std::size_t column) HWY_ATTR {
    for (std::size_t row = column + 1; kPivots && row < D; ++row) {
      const auto larger = hn::Gt(hn::Abs(matrix[row][column]), hn::Abs(matrix[column][column]));
      determinant = hn::IfThenElse(larger, hn::Neg(determinant), determinant);
      for (std::size_t k = column; k <= D; ++k) {
        const Lane upper = matrix[column][k], lower = matrix[row][k];
        matrix[column][k] = hn::IfThenElse(larger, lower, upper);
        matrix[row][k] = hn::IfThenElse(larger, upper, lower);
      }
    }
    determinant = hn::Mul(determinant, matrix[column][column]);
    if (!kPivots) *smallest = hn::Min(*smallest, hn::Abs(matrix[column][column]));
    const Lane inverse = hn::Div(hn::Set(tag, 1.0), matrix[column][column]);
    for_each_index<kUnrolled>(column + 1, D, [&](std::size_t row) HWY_ATTR {
      const Lane factor = hn::Neg(hn::Mul(matrix[row][column], inverse));
      for_each_index<kUnrolled>(column + 1, D + 1, [&](std::size_t k) HWY_ATTR {
        matrix[row][k] = hn::MulAdd(factor, matrix[column][k], matrix[row][k]);
      });
    });
  });
  for (std::size_t row = D; row-- > 0;) {
    Lane rest = matrix[row][D];
    for (std::size_t k = row + 1; k < D; ++k) rest = hn::NegMulAdd(matrix[row][k], x[k], rest);
    x[row] = hn::Div(rest, matrix[row][row]);
  }
  return determinant;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
