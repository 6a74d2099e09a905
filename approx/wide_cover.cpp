#include "approx/wide_cover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>

#include "approx/slab_bits_kernel.h"
#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/ids.h"

namespace ndhull {
namespace {

/// Walks over fewer simplices in a slab are as quick; so they are where the square of what a slab holds is
/// fewer times the number of simplices.
constexpr double kFewMembers = 256.0, kWorthPasses = 6.0;
/// Where slabs turn out to be more than this, for each time that a simplex is to be held, most are small, and
/// walks are quicker.
std::size_t most_slabs(std::size_t simplices) { return 80 + std::min<std::size_t>(1024, simplices / 200); }
/// Of each slab some so many simplices are in the sample.
constexpr double kSampledMembers = 240.0;
/// One simplex in so many says how large slabs are.
constexpr std::size_t kStrideAtFirst = 16;
constexpr std::size_t kRowsAtATime = 1024;
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
  // Passes over the sample for each 64 slabs take time that falls with the square of what a slab holds.
  if (members < kFewMembers || members * members < kWorthPasses * static_cast<double>(complex_.row_count))
    return std::nullopt;
  if (vertices_.empty()) list_vertices();
  start(std::clamp<std::size_t>(static_cast<std::size_t>(members / kSampledMembers), 1, 64));
  // Slabs to choose from cost little here.
  const unsigned times = effort.choices > 1 ? 5 : 2;
  const int rechoices = effort.choices > 1 ? 4 : 1;
  const std::size_t most = times * most_slabs(seeds_.live_count());
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
  Covering covering;
  covering.facet_of.assign(complex_.row_count, kNone);
  const std::vector<std::uint32_t> outside = assign(chosen, width, covering);
  if (outside.empty()) return covering;
  take_part(outside);
  grow_until_held(1, SIZE_MAX, width, effort);
  assign_others(outside, choose(outside), covering);
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
      add_slabs(seeds, width, effort);
      std::erase_if(open_, [&](std::uint32_t row) { return hits[row] >= round; });
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

void WideCover::add_slabs(std::span<const SeedChoice> seeds, double width, const CoverEffort& effort) {
  const std::size_t first = slabs_.size();
  grow_slabs(seeds, width, effort);
  std::vector<std::vector<std::uint32_t>> found(seeds.size());
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) { find_held<d>(first, found); });
  for (const std::vector<std::uint32_t>& rows : found) seeds_.add_slab(rows);
}

/// What of the open simplices the slabs from `first` on hold.
template <std::size_t D>
void WideCover::find_held(std::size_t first, std::vector<std::vector<std::uint32_t>>& found) const {
  for (std::size_t w = first / 64; 64 * w < slabs_.size(); ++w) {
    const std::uint64_t* word = bits_.data() + w * space_.vertex_count();
    const std::uint64_t asked = 64 * w < first ? ~std::uint64_t{0} << (first % 64) : ~std::uint64_t{0};
    for (const std::uint32_t row : open_) {
      const std::uint16_t* ids = vertices_.data() + std::size_t{row} * D;
      std::uint64_t common = asked;
      for (std::size_t k = 0; k < D; ++k) common &= word[ids[k]];
      visit_bits(common, [&](std::size_t bit) { found[64 * w + bit - first].push_back(row); });
    }
  }
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

/// Calls visit(block, row, words) with the chosen slabs that hold the row, in blocks of rows.
template <class Visit>
void WideCover::visit_slabs_of_rows(std::span<const std::uint32_t> chosen, const Visit& visit) const {
  const std::vector<std::uint64_t> bits = bits_of(chosen);
  const std::size_t words = words_for(chosen.size());
  for_each_block(complex_.row_count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> held_by((end - begin) * words);
    intersect_rows(bits.data(), words, vertices_.data() + begin * complex_.rank, complex_.rank, end - begin,
                   held_by.data());
    for (std::size_t row = begin; row < end; ++row) {
      if (complex_.state[row] != SimplexState::kLive) continue;
      visit(begin / kRowsAtATime, static_cast<std::uint32_t>(row),
            std::span(held_by).subspan((row - begin) * words, words));
    }
  });
}

/// Live rows that none of the chosen slabs holds.
std::vector<std::uint32_t> WideCover::rows_outside(std::span<const std::uint32_t> chosen) const {
  std::vector<std::vector<std::uint32_t>> of_block(complex_.row_count / kRowsAtATime + 1);
  visit_slabs_of_rows(chosen,
                      [&](std::size_t block, std::uint32_t row, std::span<const std::uint64_t> words) {
                        std::uint64_t any = 0;
                        for (const std::uint64_t word : words) any |= word;
                        if (any == 0) of_block[block].push_back(row);
                      });
  return joined(of_block);
}

/// Adds the chosen slabs to the facets, and puts each row into that in which it lies highest. Returns the
/// live rows that none of them holds.
std::vector<std::uint32_t> WideCover::assign(std::span<const std::uint32_t> chosen, double width,
                                             Covering& covering) {
  const std::size_t vertices = space_.vertex_count();
  std::vector<std::uint8_t> depths(chosen.size() * vertices, kNotIn);
  for (std::size_t c = 0; c < chosen.size(); ++c) {
    const VertexSlab& slab = slabs_[chosen[c]];
    for (std::size_t i = 0; i < slab.vertices.size(); ++i) {
      const double part = std::clamp(slab.depths[i] / width, 0.0, 1.0);
      depths[c * vertices + slab.vertices[i]] = static_cast<std::uint8_t>(std::ceil(part * kDeepest));
    }
    covering.planes.push_back(slab.plane);
  }
  std::vector<std::vector<std::uint32_t>> outside(complex_.row_count / kRowsAtATime + 1);
  call_with_dimension<2, kMaxRank>(complex_.rank, [&](auto d) {
    visit_slabs_of_rows(chosen,
                        [&](std::size_t block, std::uint32_t row, std::span<const std::uint64_t> words) {
                          const std::uint16_t* ids = vertices_.data() + std::size_t{row} * d;
                          std::uint32_t highest = kNone;
                          std::uint8_t least = kNotIn;
                          for (std::size_t w = 0; w < words.size(); ++w) {
                            visit_bits(words[w], [&](std::size_t bit) {
                              const std::uint8_t* depth_of = depths.data() + (64 * w + bit) * vertices;
                              std::uint8_t depth = 0;
                              for (std::size_t k = 0; k < d; ++k) depth = std::max(depth, depth_of[ids[k]]);
                              highest = depth < least ? static_cast<std::uint32_t>(64 * w + bit) : highest;
                              least = std::min(depth, least);
                            });
                          }
                          covering.facet_of[row] = highest;
                          if (highest == kNone) outside[block].push_back(row);
                        });
  });
  return joined(outside);
}

/// The same for few rows that the chosen slabs hold, in the first of them that does.
void WideCover::assign_others(std::span<const std::uint32_t> rows, std::span<const std::uint32_t> chosen,
                              Covering& covering) {
  const auto first = static_cast<std::uint32_t>(covering.planes.size());
  for (const std::uint32_t slab : chosen) covering.planes.push_back(slabs_[slab].plane);
  const std::vector<std::uint64_t> bits = bits_of(chosen);
  const std::size_t words = words_for(chosen.size());
  std::vector<std::uint64_t> held_by(words);
  for (const std::uint32_t row : rows) {
    intersect_rows(bits.data(), words, vertices_of(row), complex_.rank, 1, held_by.data());
    const auto word = std::find_if(held_by.begin(), held_by.end(), [](std::uint64_t w) { return w != 0; });
    const auto at = static_cast<std::uint32_t>(64 * (word - held_by.begin()) + std::countr_zero(*word));
    covering.facet_of[row] = first + at;
  }
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
