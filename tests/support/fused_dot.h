// The dot product the kernels are compared with, bit by bit.
#pragma once

#include <cmath>
#include <cstddef>

namespace ndhull {

/// One fused multiply-add a term, from the first: the order of the kernels' sums. dimension >= 1.
inline double fused_dot(const double* a, const double* b, std::size_t dimension) {
  double sum = a[0] * b[0];
  for (std::size_t k = 1; k < dimension; ++k) sum = std::fma(a[k], b[k], sum);
  return sum;
}

}  // namespace ndhull
