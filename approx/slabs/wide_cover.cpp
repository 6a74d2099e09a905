#include "approx/slabs/wide_cover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>

#include "approx/slabs/slab_bits_kernel.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Walks over fewer simplices in a slab are as quick; slabs are large where the square of what one holds is
/// so many times the number of simplices.
constexpr double kFewMembers = 200.0, kWorthPasses = 6.0;
/// Where slabs turn out to be more than this, most are small, and walks are quicker: large slabs, for each
/// time that a simplex is to be held, and others.
std::size_t most_large_slabs(std::size_t simplices) {
  return 80 + std::min<std::size_t>(1024, simplices / 200);
}
std::size_t most_slabs(std::size_t simplices) { return simplices / 50; }
/// Depths of vertices in slabs that are worth a table. [bytes]
constexpr std::size_t kMostDepths = std::size_t{1} << 26;
/// Of each large slab some so many simplices are in the sample; of others so many at least, and of all slabs
/// together about so many: the sample is looked at once for each 64 slabs.
constexpr double kSampledMembers = 240.0, kFewestSampled = 12.0, kSample = 40'000.0;
/// One simplex in so many says how large slabs are.
constexpr std::size_t kStrideAtFirst = 16;
constexpr std::size_t kRowsAtATime = 1024;
/// So few facets may be joined afterwards, of which more are narrow enough where simplices lie high in them.
constexpr std::size_t kFewToJoin = 256;
/// Depths as bytes: the width is kDeepest of them.
constexpr std::uint8_t kDeepest = 254, kNotIn = 255;

std::vector<std::uint32_t> joined(const std::vector<std::vector<std::uint32_t>>& parts) {
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

template <class Visit>
void visit_bits(std::uint64_t word, const Visit& visit) {
  for (; word != 0; word &= word - 1) visit(static_cast<std::size_t>(std::countr_zero(word)));
}

}  // namespace

WideCover::WideCover(const SimplicialComplex& complex, const WidthSpace& space, const SlabGrower& grower,
                     SlabSeeds& seeds, std::function<SlabScratch&()> scratch)
    : complex_(complex), space_(space), grower_(grower), seeds_(seeds), scratch_(std::move(scratch)) {}

std::optional<Covering> WideCover::cover(double width, const CoverEffort& effort) {
  const double members = members_at_first(width, effort);
  const std::size_t simplices = seeds_.live_count();
  const auto live = static_cast<double>(simplices);
  const bool are_large = members * members >= kWorthPasses * live, looks_harder = effort.choices > 1;
  // Of large slabs it costs little to have some to choose from; of others walks find more in the same time.
  if (members < kFewMembers || (looks_harder && !are_large)) return std::nullopt;
  const unsigned times = looks_harder ? 5 : are_large ? 2 : 1;
  const int rechoices = looks_harder ? 4 : 1;
  const std::size_t most = times * (are_large ? most_large_slabs(simplices) : most_slabs(simplices));
  if (most_slabs(simplices) * space_.vertex_count() > kMostDepths && !are_large) return std::nullopt;
  if (vertices_.empty()) list_vertices();
  const double stride =
      are_large ? members / kSampledMembers : std::min(members / kFewestSampled, live / kSample);
  start(std::clamp<std::size_t>(static_cast<std::size_t>(stride), 1, 64));
  std::vector<std::uint32_t> chosen;
  for (int round = 0;; ++round) {
    grow_until_held(times, most, width, effort);
    if (slabs_.size() > most) return std::nullopt;
    chosen = choose(sample_);
    if (round == rechoices) break;
    const std::vector<std::uint32_t> outside = rows_outside(chosen);
    if (outside.empty()) break;
    take_part(outside);
  }
  by_height_ = looks_harder || chosen.size() <= kFewToJoin;
  Covering covering;
  covering.facet_of.assign(complex_.row_count, kNone);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < complex_.row_count; ++row)
    if (complex_.state[row] == SimplexState::kLive) rows.push_back(row);
  const std::vector<std::uint32_t> outside = assign(chosen, rows, width, covering);
  if (outside.empty()) return covering;
  take_part(outside);
  grow_until_held(1, SIZE_MAX, width, effort);
  assign(choose(outside), outside, width, covering);
  return covering;
}

/// Simplices in a slab, by a few slabs and some of the simplices.
double WideCover::members_at_first(double width, const CoverEffort& effort) {
  slabs_.clear();
  bits_.clear();
  seeds_.clear();
  seeds_.open(1);
  const std::span<const SeedChoice> seeds = seeds_.next_batch();
  if (seeds.empty()) return 0.0;
  grow_slabs(seeds, width, effort);
  std::size_t held = 0, looked_at = 0;
  for (std::uint32_t row = 0; row < complex_.row_count; row += kStrideAtFirst) {
    if (complex_.state[row] != SimplexState::kLive) continue;
    std::uint64_t common = ~std::uint64_t{0};
    for (const PointId id : complex_.vertices(SimplexId{row})) common &= bits_[space_.row_of(id)];
    held += static_cast<std::size_t>(std::popcount(common));
    ++looked_at;
  }
  const double share = static_cast<double>(held) / static_cast<double>(std::max<std::size_t>(1, looked_at));
  return share * static_cast<double>(seeds_.live_count()) / static_cast<double>(seeds.size());
}

void WideCover::list_vertices() {
  vertices_.resize(complex_.row_count * complex_.rank, 0);
  for_each_block(complex_.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
      if (complex_.state[row] != SimplexState::kLive) continue;
      const auto ids = complex_.vertices(SimplexId{row});
      for (std::size_t k = 0; k < ids.size(); ++k)
        vertices_[row * ids.size() + k] = static_cast<std::uint16_t>(space_.row_of(ids[k]));
    }
  });
}

/// No slabs, and a sample of one simplex in `stride`.
void WideCover::start(std::size_t stride) {
  slabs_.clear();
  bits_.clear();
  sample_.clear();
  seeds_.clear(stride);
  const std::span<const std::uint8_t> hits = seeds_.hits();
  for (std::uint32_t row = 0; row < complex_.row_count; ++row)
    if (hits[row] == 0) sample_.push_back(row);
}

void WideCover::grow_until_held(unsigned times, std::size_t most, double width, const CoverEffort& effort) {
  const std::span<const std::uint8_t> hits = seeds_.hits();
  for (unsigned round = 1; round <= times; ++round) {
    seeds_.open(round);
    open_.clear();
    std::copy_if(sample_.begin(), sample_.end(), std::back_inserter(open_),
                 [&](std::uint32_t row) { return hits[row] < round; });
    while (slabs_.size() <= most) {
      const std::span<const SeedChoice> seeds = seeds_.next_batch();
      if (seeds.empty()) break;
      add_slabs(seeds, round, width, effort);
    }
  }
}

void WideCover::grow_slabs(std::span<const SeedChoice> seeds, double width, const CoverEffort& effort) {
  const std::size_t first = slabs_.size(), vertices = space_.vertex_count();
  slabs_.resize(first + seeds.size());
  for_each_block(seeds.size(), 1, [&](std::size_t i, std::size_t) {
    SlabScratch& scratch = scratch_();
    VertexSlab& slab = slabs_[first + i];
    slab.seed = seeds_.best_of(seeds[i], width, scratch.fit);
    grower_.find_vertices_of(slab, width, effort, scratch);
  });
  bits_.resize((slabs_.size() + 63) / 64 * vertices, 0);
  for (std::size_t slab = first; slab < slabs_.size(); ++slab) {
    std::uint64_t* word = bits_.data() + slab / 64 * vertices;
    for (const std::uint32_t vertex : slabs_[slab].vertices) word[vertex] |= std::uint64_t{1} << (slab % 64);
  }
}

void WideCover::add_slabs(std::span<const SeedChoice> seeds, unsigned round, double width,
                          const CoverEffort& effort) {
  const std::size_t first = slabs_.size();
  grow_slabs(seeds, width, effort);
  std::vector<std::vector<std::uint32_t>> found(seeds.size());
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) { find_held<d>(first, round, found); });
  for (const std::vector<std::uint32_t>& rows : found) seeds_.add_slab(rows);
}

/// What of the open simplices the slabs from `first` on hold. Those that `round` slabs hold then are open no
/// more.
template <std::size_t D>
void WideCover::find_held(std::size_t first, unsigned round, std::vector<std::vector<std::uint32_t>>& found) {
  const std::span<const std::uint8_t> hits = seeds_.hits();
  const std::size_t vertices = space_.vertex_count(), begin = first / 64, end = (slabs_.size() + 63) / 64;
  std::size_t count = 0;
  for (const std::uint32_t row : open_) {
    const std::uint16_t* ids = vertices_.data() + std::size_t{row} * D;
    unsigned held = 0;
    for (std::size_t w = begin; w < end; ++w) {
      const std::uint64_t* word = bits_.data() + w * vertices;
      std::uint64_t common = w == begin ? ~std::uint64_t{0} << (first % 64) : ~std::uint64_t{0};
      for (std::size_t k = 0; k < D; ++k) common &= word[ids[k]];
      if (common == 0) continue;
      visit_bits(common, [&](std::size_t bit) {
        found[64 * w + bit - first].push_back(row);
        ++held;
      });
    }
    if (held == 0 || hits[row] + held < round) open_[count++] = row;
  }
  open_.resize(count);
}

/// Slabs that together hold these rows.
std::vector<std::uint32_t> WideCover::choose(std::span<const std::uint32_t> rows) const {
  const std::size_t words = words_for(slabs_.size()), rank = complex_.rank;
  std::vector<std::uint32_t> all(slabs_.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<std::uint64_t> bits = bits_of(all);
  std::vector<std::uint32_t> slabs, end_of(rows.size());  // row by row: the slabs that hold it
  std::vector<std::uint8_t> hits(complex_.row_count, 0);
  std::vector<MemberRange> ranges(slabs_.size());
  std::vector<std::uint16_t> ids(kRowsAtATime * rank);
  std::vector<std::uint64_t> held_by(kRowsAtATime * words);
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < rows.size(); begin += kRowsAtATime) {
    const std::size_t here = std::min(kRowsAtATime, rows.size() - begin);
    for (std::size_t i = 0; i < here; ++i)
      std::copy_n(vertices_of(rows[begin + i]), rank, ids.data() + i * rank);
    intersect_rows(bits.data(), words, ids.data(), rank, here, held_by.data());
    for (std::size_t i = 0; i < here; ++i) {
      const std::size_t first = count;
      if (slabs.size() < count + slabs_.size()) slabs.resize(2 * slabs.size() + slabs_.size());
      for (std::size_t w = 0; w < words; ++w) {
        visit_bits(held_by[i * words + w],
                   [&](std::size_t bit) { slabs[count++] = static_cast<std::uint32_t>(64 * w + bit); });
      }
      for (std::size_t k = first; k < count; ++k) ++ranges[slabs[k]].end;
      hits[rows[begin + i]] = static_cast<std::uint8_t>(std::min<std::size_t>(count - first, 255));
      end_of[begin + i] = static_cast<std::uint32_t>(count);
    }
  }
  std::size_t begin = 0;
  for (MemberRange& range : ranges) {
    range.begin = begin;
    begin += range.end;
    range.end = range.begin;
  }
  std::vector<std::uint32_t> members(count);
  for (std::size_t i = 0, k = 0; i < rows.size(); ++i)
    for (; k < end_of[i]; ++k) members[ranges[slabs[k]].end++] = rows[i];
  return choose_slabs(ranges, members, hits);
}

/// These rows join the sample.
void WideCover::take_part(std::span<const std::uint32_t> rows) {
  const std::size_t vertices = space_.vertex_count(), words = (slabs_.size() + 63) / 64;
  for (const std::uint32_t row : rows) {
    std::size_t count = 0;
    for (std::size_t w = 0; w < words; ++w) {
      std::uint64_t common = ~std::uint64_t{0};
      for (std::size_t k = 0; k < complex_.rank; ++k) common &= bits_[w * vertices + vertices_of(row)[k]];
      count += static_cast<std::size_t>(std::popcount(common));
    }
    sample_.push_back(row);
    seeds_.take_part(row, count);
  }
}

/// Row by row of the space: which of these slabs it is in.
std::vector<std::uint64_t> WideCover::bits_of(std::span<const std::uint32_t> slabs) const {
  const std::size_t words = words_for(slabs.size());
  std::vector<std::uint64_t> bits(space_.vertex_count() * words, 0);
  for (std::size_t s = 0; s < slabs.size(); ++s)
    for (const std::uint32_t vertex : slabs_[slabs[s]].vertices)
      bits[vertex * words + s / 64] |= std::uint64_t{1} << (s % 64);
  return bits;
}

/// Live rows that none of the chosen slabs holds.
std::vector<std::uint32_t> WideCover::rows_outside(std::span<const std::uint32_t> chosen) const {
  const std::vector<std::uint64_t> bits = bits_of(chosen);
  const std::size_t words = words_for(chosen.size()), rank = complex_.rank;
  std::vector<std::vector<std::uint32_t>> of_block(complex_.row_count / kRowsAtATime + 1);
  for_each_block(complex_.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> held_by((end - begin) * words);
    intersect_rows(bits.data(), words, vertices_.data() + begin * rank, rank, end - begin, held_by.data());
    for (std::size_t row = begin; row < end; ++row) {
      if (complex_.state[row] != SimplexState::kLive) continue;
      std::uint64_t any = 0;
      for (std::size_t w = 0; w < words; ++w) any |= held_by[(row - begin) * words + w];
      if (any == 0) of_block[begin / kRowsAtATime].push_back(static_cast<std::uint32_t>(row));
    }
  });
  return joined(of_block);
}

/// Of each chosen slab the depth of each vertex, in 254ths of the width.
std::vector<std::uint8_t> WideCover::depths_in(std::span<const std::uint32_t> chosen, double width) const {
  const std::size_t vertices = space_.vertex_count();
  std::vector<std::uint8_t> depths(chosen.size() * vertices, kNotIn);
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const VertexSlab& slab = slabs_[chosen[c]];
    for (std::size_t i = 0; i < slab.vertices.size(); ++i) {
      const double part = std::clamp(slab.depths[i] / width, 0.0, 1.0);
      depths[c * vertices + slab.vertices[i]] = static_cast<std::uint8_t>(std::ceil(part * kDeepest));
    }
  }
  return depths;
}

/// Adds the chosen slabs to the facets, and puts into them what of these rows they hold. Returns the others.
std::vector<std::uint32_t> WideCover::assign(std::span<const std::uint32_t> chosen,
                                             std::span<const std::uint32_t> rows, double width,
                                             Covering& covering) {
  for (const std::uint32_t slab : chosen) covering.planes.push_back(slabs_[slab].plane);
  std::vector<std::uint32_t> outside;
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
    outside = assign_in<d>(chosen, rows, depths_in(chosen, width), covering);
  });
  return outside;
}

// Each simplex goes into the slab in which it lies highest, or, in a third of the time, slabs grow from their
// seeds, all at the same time, in passes over the rows as they stand in memory: facets hang together then,
// and most simplices are looked at in one or two slabs. What that does not reach goes where it lies highest.
template <std::size_t D>
std::vector<std::uint32_t> WideCover::assign_in(std::span<const std::uint32_t> chosen,
                                                std::span<const std::uint32_t> rows,
                                                const std::vector<std::uint8_t>& depths, Covering& covering) {
  const std::size_t vertices = space_.vertex_count();
  const auto first = static_cast<std::uint32_t>(covering.planes.size() - chosen.size());
  std::vector<std::uint32_t>& facet_of = covering.facet_of;
  const auto depth_in = [&](std::uint32_t c, std::uint32_t row) {
    const std::uint8_t* depth_of = depths.data() + c * vertices;
    const std::uint16_t* ids = vertices_.data() + std::size_t{row} * D;
    std::uint8_t depth = 0;
    for (std::size_t k = 0; k < D; ++k) depth = std::max(depth, depth_of[ids[k]]);
    return depth;
  };
  const auto join_neighbour = [&](std::uint32_t row) {
    std::uint32_t last = kNone;
    for (const SimplexId neighbour : complex_.neighbours(SimplexId{row})) {
      const std::uint32_t facet = facet_of[neighbour.value];
      if (facet == kNone || facet < first || facet == last) continue;
      last = facet;
      if (depth_in(facet - first, row) == kNotIn) continue;
      facet_of[row] = facet;
      return true;
    }
    return false;
  };
  std::vector<std::uint32_t> left(rows.begin(), rows.end());
  if (!by_height_) {
    for (std::uint32_t c = 0; c < chosen.size(); ++c) {
      const std::uint32_t seed = slabs_[chosen[c]].seed;
      if (facet_of[seed] == kNone && depth_in(c, seed) != kNotIn) facet_of[seed] = first + c;
    }
    std::size_t before = 0;
    do {
      before = left.size();
      std::erase_if(left, [&](std::uint32_t row) { return facet_of[row] != kNone || join_neighbour(row); });
      std::reverse(left.begin(), left.end());
    } while (!left.empty() && 16 * (before - left.size()) >= before);
  }
  const std::vector<std::uint64_t> bits = bits_of(chosen);
  const std::size_t words = words_for(chosen.size());
  for_each_block(left.size(), kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> held_by(words);
    for (const std::uint32_t row : std::span(left).subspan(begin, end - begin)) {
      intersect_rows(bits.data(), words, vertices_of(row), D, 1, held_by.data());
      std::uint8_t least = kNotIn;
      for (std::size_t w = 0; w < words; ++w) {
        visit_bits(held_by[w], [&](std::size_t bit) {
          const auto c = static_cast<std::uint32_t>(64 * w + bit);
          const std::uint8_t depth = depth_in(c, row);
          facet_of[row] = depth < least ? first + c : facet_of[row];
          least = std::min(depth, least);
        });
      }
    }
  });
  std::erase_if(left, [&](std::uint32_t row) { return facet_of[row] != kNone; });
  std::sort(left.begin(), left.end());
  return left;
}

void WideCover::find_depths(const Covering& covering, std::span<float> depth_of) const {
  const std::size_t vertices = space_.vertex_count(), count = covering.planes.size();
  std::vector<std::uint8_t> is_in(count * vertices, 0);
  for (std::uint32_t row = 0; row < covering.facet_of.size(); ++row) {
    if (covering.facet_of[row] == kNone) continue;
    std::uint8_t* of_facet = is_in.data() + covering.facet_of[row] * vertices;
    for (std::size_t k = 0; k < complex_.rank; ++k) of_facet[vertices_of(row)[k]] = 1;
  }
  std::vector<float> depths(count);
  std::vector<std::uint32_t> rows;
  for (std::size_t facet = 0; facet < count; ++facet) {
    rows.clear();
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex)
      if (is_in[facet * vertices + vertex] != 0) rows.push_back(vertex);
    const FittedPlane& plane = covering.planes[facet];
    if (rows.empty()) continue;
    depths[facet] = rounded_up_depth(std::max(0.0, plane.height - lowest_dot(space_, plane.normal, rows)));
  }
  for (std::size_t row = 0; row < covering.facet_of.size(); ++row)
    if (covering.facet_of[row] != kNone) depth_of[row] = depths[covering.facet_of[row]];
}

}  // namespace ndhull
