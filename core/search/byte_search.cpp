// Searches among points in bytes, compiled for each instruction set and chosen at run time.
#include <cmath>

#include "core/machine/simd_targets.h"
#include "core/search/byte_points.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/byte_search.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "core/dimension_switch.h"
#include "core/machine/blocks.h"
#include "core/machine/mask_bits-inl.h"
#include "core/machine/prefetch.h"

#ifndef NDHULL_BYTE_SEARCH_
#define NDHULL_BYTE_SEARCH_
namespace ndhull {

/// A direction, rounded. With w its entries in half extents times `factor`, t those of a point from the
/// middle, and m the rounded w, m = scale w + rest, and `rest` is orthogonal to w. So of a point with
/// w.t >= b
///   m.t >= scale b - |rest| sqrt(reach^2 - (b / |w|)^2):
/// points as far along the direction as the best one have little of their length across it.
struct ByteDirection {
  const double* normal = nullptr;
  FurthestPoint best;
  double at_middle = 0.0;             ///< product of the middle
  double factor = 0.0, length = 0.0;  ///< of w
  double scale = 0.0, rest = 0.0;
  double zero = 0.0;       ///< the sum of the middle
  double slack = 0.0;      ///< no sum is off by more because the point was rounded
  double reach = 0.0;      ///< of the points
  std::int32_t least = 0;  ///< smaller sums are of points whose products are below the best
  std::array<std::int16_t, BytePoints::kMaxDimension / 2> weights{};  ///< both bytes of each pair of columns

  /// A NaN leaves nothing out.
  void raise_least() {
    constexpr double kAll = -32768.0, kNone = 32767.0;  // no sum is as large
    const double b = (best.dot - at_middle) * factor, along = b / length;
    const double across = along > 0.0 ? std::sqrt(std::max(reach * reach - along * along, 0.0)) : reach;
    const double sum = zero + BytePoints::kBytesOfHalf * (scale * b - rest * across) - slack;
    least = static_cast<std::int32_t>(sum > kAll ? std::min(std::floor(sum), kNone) : kAll);
  }
};

/// What a search works with; memory that is used again.
struct ByteSearchMemory {
  std::vector<std::int16_t> maxima;     ///< of the chunks of a segment, whole vectors, for each direction
  std::size_t tried = 0;                ///< candidates in all
  std::vector<std::size_t> candidates;  ///< places
};

}  // namespace ndhull
#endif

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Sums = hn::CappedTag<std::int16_t, BytePoints::kTile>;
using Pairs = hn::RebindToUnsigned<Sums>;

/// The sum of both products of each pair of an unsigned and a signed byte. It fits 16 bits: no entries of a
/// direction are more than 127 together.
HWY_INLINE hn::VFromD<Sums> pair_products(hn::VFromD<Pairs> points, hn::VFromD<Sums> weights) {
#if HWY_ARCH_X86 && HWY_MAX_BYTES == 64
  return hn::VFromD<Sums>{_mm512_maddubs_epi16(points.raw, weights.raw)};
#elif HWY_ARCH_X86 && HWY_MAX_BYTES == 32
  return hn::VFromD<Sums>{_mm256_maddubs_epi16(points.raw, weights.raw)};
#else
  const Sums tag;
  const auto first = hn::BitCast(tag, hn::And(points, hn::Set(Pairs(), 255)));
  const auto second = hn::BitCast(tag, hn::ShiftRight<8>(points));
  return hn::Add(hn::Mul(first, hn::ShiftRight<8>(hn::ShiftLeft<8>(weights))),
                 hn::Mul(second, hn::ShiftRight<8>(weights)));
#endif
}

/// Rounds a direction. Its entries times `factor` are rounded to integers whose sizes are 127 at most
/// together.
inline void round_direction(const BytePoints& points, const double* normal, ByteDirection& direction) {
  constexpr double kMostTogether = 127.0;
  constexpr double kDoubleRounding = 64.0 * 0x1p-53;  // of what is computed here, and of products; generous
  const std::size_t dimension = points.dimension();
  std::array<double, BytePoints::kMaxDimension> entries, rounded{};
  double together = 0.0, size = 0.0, at_middle = 0.0;
  for (std::size_t k = 0; k < dimension; ++k) {
    entries[k] = normal[k] * points.half()[k];
    together += std::abs(entries[k]);
    size += std::abs(normal[k] * points.middle()[k]) + std::abs(entries[k]);
    at_middle += normal[k] * points.middle()[k];
  }
  const double factor = (kMostTogether - 0.5 * static_cast<double>(dimension)) / together;
  double sum = 0.0, of_points = 0.0, along = 0.0, length_sq = 0.0;
  direction.weights = {};
  for (std::size_t k = 0; k < dimension; ++k) {
    entries[k] *= factor;
    rounded[k] = std::abs(entries[k]) <= kMostTogether ? std::nearbyint(entries[k]) : 0.0;
    const auto byte = static_cast<std::uint16_t>(static_cast<std::int32_t>(rounded[k]) & 255);
    auto& pair = direction.weights[k / 2];
    pair = static_cast<std::int16_t>(static_cast<std::uint16_t>(pair) | (byte << (k % 2 * 8)));
    sum += rounded[k];
    of_points += std::abs(rounded[k]) * points.rounding()[k];
    along += rounded[k] * entries[k];
    length_sq += entries[k] * entries[k];
  }
  direction.scale = along / length_sq;
  double rest_sq = 0.0;  // keeps NaN
  for (std::size_t k = 0; k < dimension; ++k) {
    const double rest = rounded[k] - direction.scale * entries[k];
    rest_sq += rest * rest;
  }
  const double rounding = kDoubleRounding * size * factor + 1e-4;
  direction.normal = normal;
  direction.at_middle = at_middle;
  direction.factor = std::isfinite(factor) ? factor : NAN;
  direction.length = std::sqrt(length_sq);
  direction.rest = std::sqrt(rest_sq);
  direction.zero = BytePoints::kBytesOfHalf * sum;
  direction.slack = BytePoints::kBytesOfHalf * (of_points + rounding);
  direction.reach = points.reach();
  direction.raise_least();
}

/// The products of kPairs pairs of columns of one tile, from lane `at` on.
template <std::size_t kPairs>
HWY_INLINE hn::VFromD<Sums> tile_sums(const std::uint16_t* tile, const hn::VFromD<Sums>* weights,
                                      std::size_t at) {
  const Pairs pairs;
  auto sum = pair_products(hn::LoadU(pairs, tile + at), weights[0]);
  for (std::size_t p = 1; p < kPairs; ++p)
    sum = hn::Add(sum, pair_products(hn::LoadU(pairs, tile + p * BytePoints::kTile + at), weights[p]));
  return sum;
}

/// Directions that share a pass over the points: as many as have their weights in registers.
template <std::size_t kPairs>
constexpr std::size_t kTogether = kPairs <= 5 ? 4 : 2;

/// How many numbers are kept of the largest sums of a chunk, and how many chunks fill a vector with them.
HWY_INLINE std::size_t kept_lanes() { return std::min<std::size_t>(8, hn::Lanes(Sums())); }
HWY_INLINE std::size_t chunks_in_vector() { return hn::Lanes(Sums()) / kept_lanes(); }

template <class Tag>
HWY_INLINE void store_kept(Tag tag, hn::VFromD<Tag> largest, std::int16_t* to) {
#if HWY_ARCH_X86 && HWY_MAX_BYTES >= 32
  if constexpr (hn::MaxLanes(Tag()) > 8) {
    const hn::Half<Tag> half;
    return store_kept(half, hn::Max(hn::LowerHalf(half, largest), hn::UpperHalf(half, largest)), to);
  }
#endif
  hn::StoreU(largest, tag, to);
}

/// The largest sums of each chunk, for some directions.
template <std::size_t kPairs>
HWY_NOINLINE void fill_maxima(const BytePoints& points, std::size_t first_chunk, std::size_t chunks,
                              const ByteDirection* directions, std::int16_t* maxima, std::size_t stride) {
  constexpr std::size_t kCount = kTogether<kPairs>;
  const Sums tag;
  const Pairs pairs;
  hn::VFromD<Sums> weights[kCount][kPairs];
  for (std::size_t i = 0; i < kCount; ++i)
    for (std::size_t p = 0; p < kPairs; ++p) weights[i][p] = hn::Set(tag, directions[i].weights[p]);
  const std::uint16_t* tile = points.tile(first_chunk * BytePoints::kTilesInChunk);
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    hn::VFromD<Sums> largest[kCount];
    for (auto& entry : largest) entry = hn::Set(tag, -32768);
    for (std::size_t t = 0; t < BytePoints::kTilesInChunk; ++t) {
      for (std::size_t at = 0; at < BytePoints::kTile; at += hn::Lanes(tag)) {
        hn::VFromD<Pairs> columns[kPairs];
        for (std::size_t p = 0; p < kPairs; ++p)
          columns[p] = hn::LoadU(pairs, tile + p * BytePoints::kTile + at);
        for (std::size_t i = 0; i < kCount; ++i) {
          auto sum = pair_products(columns[0], weights[i][0]);
          for (std::size_t p = 1; p < kPairs; ++p)
            sum = hn::Add(sum, pair_products(columns[p], weights[i][p]));
          largest[i] = hn::Max(largest[i], sum);
        }
      }
      tile += kPairs * BytePoints::kTile;
    }
    for (std::size_t i = 0; i < kCount; ++i)
      store_kept(tag, largest[i], maxima + i * stride + chunk * kept_lanes());
  }
}

/// One direction in one segment.
template <std::size_t kPairs>
class SegmentSearch {
 public:
  SegmentSearch(const BytePoints& points, std::size_t first_chunk, std::size_t chunks,
                const std::int16_t* maxima, ByteDirection& direction, ByteSearchMemory& memory)
      : points_(points),
        first_chunk_(first_chunk),
        chunks_(chunks),
        vectors_((chunks + chunks_in_vector() - 1) / chunks_in_vector()),
        maxima_(maxima),
        direction_(direction),
        memory_(memory) {
    for (std::size_t p = 0; p < kPairs; ++p) weights_[p] = hn::Set(tag_, direction.weights[p]);
  }

  // The points of the largest sum first: they leave few others.
  void run() {
    auto largest = hn::Set(tag_, -32768);
    for (std::size_t at = 0; at < vectors_; ++at) largest = hn::Max(largest, maxima(at));
    const std::int32_t top = hn::GetLane(hn::MaxOfLanes(tag_, largest));
    if (top < direction_.least) return;
    list_candidates(top);
    try_candidates();
    list_candidates(direction_.least);
    try_candidates();
  }

 private:
  HWY_INLINE hn::VFromD<Sums> maxima(std::size_t vector) const {
    return hn::LoadU(tag_, maxima_ + vector * hn::Lanes(tag_));
  }

  void list_candidates(std::int32_t least) {
    const auto low = hn::Set(tag_, static_cast<std::int16_t>(least));
    const std::uint64_t of_chunk = (std::uint64_t{1} << kept_lanes()) - 1;
    constexpr std::size_t kBits = 64;
    memory_.candidates.clear();
    for (std::size_t begin = 0; begin < vectors_; begin += kBits) {
      std::uint64_t near = 0;  // which are near cannot be predicted
      for (std::size_t at = begin; at < std::min(begin + kBits, vectors_); ++at)
        near |= std::uint64_t{!hn::AllTrue(tag_, hn::Lt(maxima(at), low))} << (at - begin);
      for (; near != 0; near &= near - 1) {
        const std::size_t at = begin + static_cast<std::size_t>(__builtin_ctzll(near));
        std::uint64_t bits = bits_of_mask(tag_, hn::Not(hn::Lt(maxima(at), low)));
        while (bits != 0) {
          const std::size_t chunk = static_cast<std::size_t>(__builtin_ctzll(bits)) / kept_lanes();
          bits &= ~(of_chunk << chunk * kept_lanes());
          const std::size_t in_segment = at * chunks_in_vector() + chunk;
          if (in_segment < chunks_) list_in_chunk(first_chunk_ + in_segment, low);
        }
      }
    }
  }

  HWY_INLINE void list_in_chunk(std::size_t chunk, hn::VFromD<Sums> low) {
    for (std::size_t t = 0; t < BytePoints::kTilesInChunk; ++t) {
      const std::size_t tile = chunk * BytePoints::kTilesInChunk + t;
      for (std::size_t at = 0; at < BytePoints::kTile; at += hn::Lanes(tag_)) {
        const auto is_below = hn::Lt(tile_sums<kPairs>(points_.tile(tile), weights_, at), low);
        if (hn::AllTrue(tag_, is_below)) continue;
        for (std::uint64_t bits = bits_of_mask(tag_, hn::Not(is_below)); bits != 0; bits &= bits - 1) {
          const std::size_t place =
              tile * BytePoints::kTile + at + static_cast<std::size_t>(__builtin_ctzll(bits));
          if (place >= points_.rows().count) break;
          prefetch(points_.rows().row(place));
          memory_.candidates.push_back(place);
        }
      }
    }
  }

  void try_candidates() {
    FurthestPoint& best = direction_.best;
    memory_.tried += memory_.candidates.size();
    for (const std::size_t place : memory_.candidates) {
      const double product = product_with(points_.rows().row(place));
      if (product > best.dot ||
          (product == best.dot && place < best.row && best.row != FurthestPoint::kNoRow))
        best = {product, static_cast<std::uint32_t>(place)};
    }
    direction_.raise_least();
  }

  /// As vectors would have it: a fused chain where the instruction set has such.
  HWY_INLINE double product_with(const double* point) const {
    const hn::CappedTag<double, 1> tag;
    auto product = hn::Mul(hn::Set(tag, direction_.normal[0]), hn::Set(tag, point[0]));
    for (std::size_t k = 1; k < points_.dimension(); ++k)
      product = hn::MulAdd(hn::Set(tag, direction_.normal[k]), hn::Set(tag, point[k]), product);
    return hn::GetLane(product);
  }

  static constexpr Sums tag_{};
  const BytePoints& points_;
  std::size_t first_chunk_, chunks_, vectors_;
  const std::int16_t* maxima_;
  ByteDirection& direction_;
  ByteSearchMemory& memory_;
  hn::VFromD<Sums> weights_[kPairs];
};

/// Points of a segment stay in the second-level cache while all directions of a block pass over them.
template <std::size_t kPairs>
void search_bytes(const BytePoints& points, std::span<ByteDirection> directions, ByteSearchMemory& memory) {
  constexpr std::size_t kSegmentBytes = std::size_t{3} << 18;
  constexpr std::size_t kChunkBytes = BytePoints::kTile * BytePoints::kTilesInChunk * 2 * kPairs;
  constexpr std::size_t kMostChunks = kSegmentBytes / kChunkBytes, kCount = kTogether<kPairs>;
  const std::size_t all = points.chunk_count(), segments = (all + kMostChunks - 1) / kMostChunks;
  const std::size_t size = (all + segments - 1) / segments;
  // The last vector of a direction may have room left: no sum is as small.
  const std::size_t stride = (size + chunks_in_vector()) * kept_lanes();
  memory.maxima.resize(kCount * stride);
  for (std::size_t first = 0; first < all; first += size) {
    const std::size_t chunks = std::min(size, all - first);
    std::fill(memory.maxima.begin(), memory.maxima.end(), std::int16_t{-32768});
    for (std::size_t begin = 0; begin < directions.size(); begin += kCount) {
      ByteDirection together[kCount];
      const std::size_t used = std::min(kCount, directions.size() - begin);
      for (std::size_t i = 0; i < kCount; ++i) together[i] = directions[begin + std::min(i, used - 1)];
      fill_maxima<kPairs>(points, first, chunks, together, memory.maxima.data(), stride);
      for (std::size_t i = 0; i < used; ++i) {
        SegmentSearch<kPairs>(points, first, chunks, memory.maxima.data() + i * stride, directions[begin + i],
                              memory)
            .run();
      }
    }
  }
}

void find_furthest_in_bytes(const BytePoints& points, std::span<const double> normals,
                            std::span<FurthestPoint> furthest, ByteSearchMemory& memory) {
  std::vector<ByteDirection> directions(furthest.size());
  for (std::size_t i = 0; i < furthest.size(); ++i) {
    directions[i].best = {furthest[i].dot, FurthestPoint::kNoRow};
    round_direction(points, normals.data() + i * points.dimension(), directions[i]);
  }
  call_with_dimension<1, BytePoints::kMaxDimension / 2>(
      points.pairs(), [&](auto pairs) { search_bytes<pairs>(points, directions, memory); });
  for (std::size_t i = 0; i < furthest.size(); ++i) furthest[i] = directions[i].best;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

std::size_t find_furthest(const BytePoints& points, std::span<const double> normals,
                          std::span<FurthestPoint> furthest) {
  constexpr std::size_t kDirectionsAtATime = 32;
  std::vector<std::size_t> tried((furthest.size() + kDirectionsAtATime - 1) / kDirectionsAtATime);
  for_each_block(furthest.size(), kDirectionsAtATime, [&](std::size_t begin, std::size_t end) {
    ByteSearchMemory memory;
    NDHULL_BEST_OF(find_furthest_in_bytes)
    (points, normals.subspan(begin * points.dimension(), (end - begin) * points.dimension()),
     furthest.subspan(begin, end - begin), memory);
    tried[begin / kDirectionsAtATime] = memory.tried;
  });
  return std::accumulate(tried.begin(), tried.end(), std::size_t{0});
}

}  // namespace ndhull
#endif
