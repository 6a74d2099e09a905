// A tile stays in the first-level cache while all directions pass over it. What happens for one product is a
// multiply-add; a comparison is made once for two vectors and a group of directions, and lanes are looked at
// one by one only where one of them is above its threshold.
#include "approx/rays/direction_scan_kernel.h"

#include <algorithm>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "approx/rays/direction_scan_kernel.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Looks at single products of one direction.
void note_products(const ScanTiles& tiles, const float* values, std::size_t first_slot, std::size_t lanes,
                   std::uint32_t direction, DirectionState& state, std::vector<NearPoint>& near) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    if (!(values[lane] > state.threshold) || first_slot + lane >= tiles.size()) continue;
    const std::uint32_t id = tiles.id(first_slot + lane);
    if (id == state.skip) continue;
    if (values[lane] > state.furthest_product || state.furthest == DirectionQuery::kNoPoint) {
      state.furthest = id;
      state.furthest_product = values[lane];
    }
    if (values[lane] > state.refute) {
      state.is_refuted = true;
      state.threshold = state.refute = values[lane];
    } else if (!state.is_refuted) {
      near.push_back({direction, id});
    }
  }
}

void scan_tiles_in_vectors(const ScanTiles& tiles, std::size_t begin, std::size_t end,
                           const float* HWY_RESTRICT directions, DirectionState* states, std::size_t count,
                           std::vector<NearPoint>& near) {
  const hn::CappedTag<float, 16> tag;
  const std::size_t lanes = hn::Lanes(tag);
  const std::size_t dimension = tiles.dimension();
  HWY_ALIGN float values[2 * HWY_MAX_BYTES / sizeof(float)];
  for (std::size_t tile = begin; tile < end; ++tile) {
    for (std::size_t first = 0; first < count; first += kDirectionGroup) {
      DirectionState* const group = states + first;
      std::uint32_t last_tile = 0;
      for (std::size_t one = 0; one < kDirectionGroup; ++one) {
        last_tile = std::max(last_tile, group[one].end_tile);
      }
      if (tile >= last_tile) continue;
      const float* HWY_RESTRICT row0 = directions + first * dimension;
      const float* HWY_RESTRICT row1 = row0 + dimension;
      const float* HWY_RESTRICT row2 = row1 + dimension;
      const float* HWY_RESTRICT row3 = row2 + dimension;
      for (std::size_t slot = 0; slot < kScanTile; slot += 2 * lanes) {
        const float* HWY_RESTRICT x = tiles.tile(tile) + slot;
        auto v00 = hn::Zero(tag), v01 = v00, v10 = v00, v11 = v00;
        auto v20 = v00, v21 = v00, v30 = v00, v31 = v00;
        for (std::size_t k = 0; k < dimension; ++k, x += kScanTile) {
          const auto x0 = hn::LoadU(tag, x), x1 = hn::LoadU(tag, x + lanes);
          const auto a0 = hn::Set(tag, row0[k]), a1 = hn::Set(tag, row1[k]);
          const auto a2 = hn::Set(tag, row2[k]), a3 = hn::Set(tag, row3[k]);
          v00 = hn::MulAdd(a0, x0, v00);
          v01 = hn::MulAdd(a0, x1, v01);
          v10 = hn::MulAdd(a1, x0, v10);
          v11 = hn::MulAdd(a1, x1, v11);
          v20 = hn::MulAdd(a2, x0, v20);
          v21 = hn::MulAdd(a2, x1, v21);
          v30 = hn::MulAdd(a3, x0, v30);
          v31 = hn::MulAdd(a3, x1, v31);
        }
        const auto above0 = hn::Gt(hn::Max(v00, v01), hn::Set(tag, group[0].threshold));
        const auto above1 = hn::Gt(hn::Max(v10, v11), hn::Set(tag, group[1].threshold));
        const auto above2 = hn::Gt(hn::Max(v20, v21), hn::Set(tag, group[2].threshold));
        const auto above3 = hn::Gt(hn::Max(v30, v31), hn::Set(tag, group[3].threshold));
        const auto any = hn::Or(hn::Or(above0, above1), hn::Or(above2, above3));
        if (hn::AllFalse(tag, any)) continue;
        const std::size_t first_slot = tile * kScanTile + slot;
        const auto note = [&](std::size_t one, auto above, auto low, auto high) {
          if (hn::AllFalse(tag, above)) return;
          hn::Store(low, tag, values);
          hn::Store(high, tag, values + lanes);
          note_products(tiles, values, first_slot, 2 * lanes, static_cast<std::uint32_t>(first + one),
                        group[one], near);
        };
        note(0, above0, v00, v01);
        note(1, above1, v10, v11);
        note(2, above2, v20, v21);
        note(3, above3, v30, v31);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void scan_tiles(const ScanTiles& tiles, std::size_t begin, std::size_t end, const float* directions,
                DirectionState* states, std::size_t count, std::vector<NearPoint>& near) {
  NDHULL_BEST_OF(scan_tiles_in_vectors)(tiles, begin, end, directions, states, count, near);
}
}  // namespace ndhull
#endif
