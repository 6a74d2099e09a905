// Points in columns, a vector of them at a time. Every sum is in the order of its columns, products rounded
// first.
#include "approx/reduction/sample_shape_kernel.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/reduction/sample_shape_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void whiten_in_vectors(const WhiteningTables& tables, const double* HWY_RESTRICT columns, std::size_t count,
                       double* HWY_RESTRICT z, double* HWY_RESTRICT length_sq) {
  const hn::CappedTag<double, 8> tag;
  const std::size_t lanes = hn::Lanes(tag), rank = tables.rank, dimension = tables.dimension;
  for (std::size_t first = 0; first < count; first += lanes) {
    auto sum_sq = hn::Zero(tag);
    for (std::size_t row = 0; row < rank; ++row) {
      auto y = hn::Set(tag, -tables.mean[row]);
      const std::size_t from = tables.is_diagonal ? row : 0, to = tables.is_diagonal ? row + 1 : dimension;
      for (std::size_t k = from; k < to; ++k) {
        const auto entry = hn::Set(tag, tables.map[row * dimension + k]);
        y = hn::Add(y, hn::Mul(entry, hn::LoadU(tag, columns + k * kWhitenedPoints + first)));
      }
      for (std::size_t k = 0; k < row; ++k) {
        const auto entry = hn::Set(tag, tables.factor[row * rank + k]);
        y = hn::Sub(y, hn::Mul(entry, hn::LoadU(tag, z + k * kWhitenedPoints + first)));
      }
      const auto solved = hn::Mul(y, hn::Set(tag, tables.inverse_pivots[row]));
      hn::StoreU(solved, tag, z + row * kWhitenedPoints + first);
      sum_sq = hn::Add(sum_sq, hn::Mul(solved, solved));
    }
    hn::StoreU(sum_sq, tag, length_sq + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void whiten_columns(const WhiteningTables& tables, const double* columns, std::size_t count, double* z,
                    double* length_sq) {
  NDHULL_BEST_OF(whiten_in_vectors)(tables, columns, count, z, length_sq);
}

}  // namespace ndhull
#endif
