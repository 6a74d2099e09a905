// Counting bits is one instruction where the machine has it, and a table look-up elsewhere: compiled once for
// each instruction set (Highway).
#include "core/whole_facets/incidence_kernels.h"

#include <algorithm>
#include <bit>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/whole_facets/incidence_kernels.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

using Rows = std::span<const std::uint64_t* const>;

class RidgeSearch {
 public:
  RidgeSearch(Rows rows, std::size_t words, std::size_t least)
      : rows_(rows), words_(words), least_(least), known_(rows.size()) {}

  std::uint64_t run(std::vector<FacetPair>& pairs) {
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
      list_largest(i);
      list_candidates(i);
      for (const Candidate& candidate : candidates_) {
        const std::uint64_t* own = common_.data() + candidate.at;
        if (is_within_largest(own)) continue;
        largest_.insert(largest_.end(), own, own + words_);
        known_[candidate.facet].push_back(i);
        pairs.push_back({i, candidate.facet});
      }
    }
    return work_;
  }

 private:
  struct Candidate {
    std::size_t size, at;
    std::uint32_t facet;
  };

  /// What facet i has in common with those before it that it shares a ridge with.
  void list_largest(std::uint32_t i) {
    largest_.clear();
    for (const std::uint32_t other : known_[i])
      for (std::size_t w = 0; w < words_; ++w) largest_.push_back(rows_[i][w] & rows_[other][w]);
  }

  /// What it has in common with those behind it, most points first.
  void list_candidates(std::uint32_t i) {
    candidates_.clear();
    common_.resize((rows_.size() + 1) * words_);
    const std::uint64_t* own = rows_[i];
    std::size_t at = 0;
    for (std::uint32_t j = i + 1; j < rows_.size(); ++j) {
      const std::uint64_t* other = rows_[j];
      std::size_t size = 0;
      for (std::size_t w = 0; w < words_; ++w) {
        common_[at + w] = own[w] & other[w];
        size += static_cast<std::size_t>(std::popcount(common_[at + w]));
      }
      if (size < least_) continue;
      candidates_.push_back({size, at, j});
      at += words_;
    }
    work_ += (rows_.size() - i) * words_ + 8 * candidates_.size();
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
      return a.size != b.size ? a.size > b.size : a.facet < b.facet;
    });
  }

  bool is_within_largest(const std::uint64_t* own) {
    for (std::size_t at = 0; at < largest_.size(); at += words_) {
      std::uint64_t missing = 0;
      for (std::size_t w = 0; w < words_ && missing == 0; ++w) missing = own[w] & ~largest_[at + w];
      if (missing != 0) continue;
      work_ += at / words_ + 1;
      return true;
    }
    work_ += largest_.size() / words_ + 1;
    return false;
  }

  Rows rows_;
  std::size_t words_, least_;
  std::vector<std::vector<std::uint32_t>> known_;  // of each facet, those before it that share a ridge
  std::vector<Candidate> candidates_;
  std::vector<std::uint64_t> common_, largest_;
  std::uint64_t work_ = 0;
};

std::uint64_t search_ridges(Rows rows, std::size_t words, std::size_t least, std::vector<FacetPair>& pairs) {
  return RidgeSearch(rows, words, least).run(pairs);
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

std::uint64_t find_ridges(std::span<const std::uint64_t* const> rows, std::size_t words, std::size_t least,
                          std::vector<FacetPair>& pairs) {
  pairs.clear();
  return NDHULL_BEST_OF(search_ridges)(rows, words, least, pairs);
}

}  // namespace ndhull
#endif
