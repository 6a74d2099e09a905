// From a dimension known at run time to one known at compile time.
#pragma once

#include <cstddef>
#include <type_traits>

#include "core/error.h"

namespace ndhull {

/// The highest affine rank that growth is compiled for.
inline constexpr std::size_t kMaxRank = 16;

/// Calls `call` with the std::integral_constant of `dimension`, which is in [First, Last]; anything else is a
/// bug.
template <std::size_t First, std::size_t Last, class Call>
decltype(auto) call_with_dimension(std::size_t dimension, const Call& call) {
  if constexpr (First < Last) {
    if (dimension != First) return call_with_dimension<First + 1, Last>(dimension, call);
  }
  NDHULL_CHECK(dimension == First);
  return call(std::integral_constant<std::size_t, First>{});
}

}  // namespace ndhull
