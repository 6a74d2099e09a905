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
  const double *map, *mean, *factor, *inverse_pivots;
};

/// z and |z|^2 of points less the frame's centre, which are in columns of kWhitenedPoints, as z is. Behind
/// the last point they may be anything that is finite.
void whiten_columns(const WhiteningTables& tables, const double* columns, std::size_t count, double* z,
                    double* length_sq);

}  // namespace ndhull
