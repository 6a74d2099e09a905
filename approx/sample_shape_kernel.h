// The vector loop of whitening.
#pragma once

#include <cstddef>

namespace ndhull {

/// Points that are whitened together. Memory  with up to 16 columns they stay in the first-level cache.
inline constexpr std::size_t kWhitenedPoints = 64;

/// What SampleShape has, as pointers.
struct WhiteningTables {
  std::size_t rank, dimension;
  bool is_diagonal;
  const double *centre, *map, *mean, *factor, *inverse_pivots;
};

/// As SampleShape::whiten. Behind the last point z and length_sq are anything.
void whiten_points(const WhiteningTables& tables, const double* points, std::size_t count, double* z,
                   double* length_sq);

}  // namespace ndhull
