// Simplices one by one against their neighbours, then all ridges brought together, then a walk over all.
//
// A row's vertices are sorted once: a ridge is that row without one entry. Sorting a row takes a permutation
// of some parity; the one that sorts the ridge opposite slot k, which stands in place p of the sorted row,
// differs by k - p exchanges. So the orientation that a row induces on the ridge, (-1)^k times the parity of
// the ridge, is the row's own parity times (-1)^p.
#include "core/complex/complex_check.h"

#include <algorithm>
#include <vector>

#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

constexpr std::size_t kRowsInBlock = 4096, kRowsAhead = 4;

/// Appends what `later`, of later simplices, found.
void join(ComplexCheck& check, const ComplexCheck& later) {
  if (check.problems == 0) check.first_problem = later.first_problem;
  check.simplices += later.simplices;
  check.problems += later.problems;
}

void report(ComplexCheck& check, const char* what, std::uint32_t row, std::size_t slot) {
  if (check.problems++ == 0) {
    check.first_problem =
        "simplex " + std::to_string(row) + " slot " + std::to_string(slot) + ": " + std::string(what);
  }
}

std::uint64_t mix(std::uint64_t x) {  // MurmurHash3's finalizer (Appleby)
  x = (x + 1) * 0xFF51'AFD7'ED55'8CCDu;
  x = (x ^ (x >> 33)) * 0xC4CE'B9FE'1A85'EC53u;
  return x ^ (x >> 33);
}

class Checker {
 public:
  explicit Checker(const SimplicialComplex& complex) : complex_(complex), rank_(complex.rank) {}

  ComplexCheck run() {
    sort_rows();
    check_rows();
    check_ridges_are_unique();
    check_connected();
    return result_;
  }

 private:
  bool is_free(std::uint32_t row) const { return complex_.state[row] == SimplexState::kFree; }
  const std::uint32_t* vertices(std::uint32_t row) const {
    return complex_.topology.data() + std::size_t{row} * 2 * rank_;
  }
  const std::uint32_t* neighbours(std::uint32_t row) const { return vertices(row) + rank_; }
  const std::uint32_t* sorted(std::uint32_t row) const { return sorted_.data() + std::size_t{row} * rank_; }
  /// Where a vertex of the row stands in the sorted one.
  std::size_t place_of(std::uint32_t row, std::uint32_t vertex) const {
    return static_cast<std::size_t>(std::find(sorted(row), sorted(row) + rank_, vertex) - sorted(row));
  }

  /// By insertion: each exchange of two that stand beside each other turns the parity.
  void sort_rows() {
    sorted_.resize(complex_.row_count * rank_);
    is_odd_.resize(complex_.row_count);
    for_each_block(complex_.row_count, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        std::uint32_t* const ids = sorted_.data() + row * rank_;
        std::copy_n(vertices(static_cast<std::uint32_t>(row)), rank_, ids);
        unsigned exchanges = 0;
        for (std::size_t i = 1; i < rank_; ++i)
          for (std::size_t j = i; j > 0 && ids[j - 1] > ids[j]; --j, ++exchanges)
            std::swap(ids[j - 1], ids[j]);
        is_odd_[row] = exchanges % 2;
      }
    });
  }

  void check_rows() {
    std::vector<ComplexCheck> parts((complex_.row_count + kRowsInBlock - 1) / kRowsInBlock);
    for_each_block(complex_.row_count, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      ComplexCheck& part = parts[begin / kRowsInBlock];
      for (std::size_t row = begin; row < end; ++row) {
        ask_for_neighbours(static_cast<std::uint32_t>(std::min(row + kRowsAhead, end - 1)));
        if (!is_free(static_cast<std::uint32_t>(row))) check_row(static_cast<std::uint32_t>(row), part);
      }
    });
    for (const ComplexCheck& part : parts) join(result_, part);
  }

  void ask_for_neighbours(std::uint32_t row) const {
    for (std::size_t slot = 0; slot < rank_; ++slot) {
      const std::size_t other = neighbours(row)[slot];
      if (other >= complex_.row_count) continue;
      prefetch(complex_.topology.data() + other * 2 * rank_, 2 * rank_);
      prefetch(sorted_.data() + other * rank_, rank_);
    }
  }

  void check_row(std::uint32_t row, ComplexCheck& part) const {
    ++part.simplices;
    if (std::adjacent_find(sorted(row), sorted(row) + rank_) != sorted(row) + rank_)
      report(part, "repeats a vertex", row, 0);
    for (std::size_t slot = 0; slot < rank_; ++slot) {
      const std::uint32_t other = neighbours(row)[slot];
      if (other >= complex_.row_count || is_free(other) || other == row) {
        report(part, "has no live neighbour", row, slot);
        continue;
      }
      const std::size_t place = place_of(row, vertices(row)[slot]);
      bool is_named_back = false;
      for (std::size_t back = 0; back < rank_ && !is_named_back; ++back) {
        if (neighbours(other)[back] != row) continue;
        const std::size_t other_place = place_of(other, vertices(other)[back]);
        if (!have_same_ridge(row, place, other, other_place)) continue;
        is_named_back = true;
        // In one dimension the two ends have the empty ridge in common, which has no orientation.
        if (is_turned(row, place) == is_turned(other, other_place) && rank_ > 1)
          report(part, "is oriented against its neighbour", row, slot);
      }
      if (!is_named_back) report(part, "is not named back across the same ridge", row, slot);
    }
  }

  /// Without the vertices in these places of the sorted rows.
  bool have_same_ridge(std::uint32_t row, std::size_t place, std::uint32_t other,
                       std::size_t other_place) const {
    for (std::size_t k = 0; k + 1 < rank_; ++k) {
      if (sorted(row)[k < place ? k : k + 1] != sorted(other)[k < other_place ? k : k + 1]) return false;
    }
    return true;
  }

  /// Does the row induce the other orientation on the ridge than the ridge's sorted vertices have?
  bool is_turned(std::uint32_t row, std::size_t place) const { return (is_odd_[row] + place) % 2 != 0; }

  struct Ridge {
    std::uint64_t key;  ///< of its set of vertices
    std::uint32_t row, slot;
  };

  /// Two simplices that name each other across a ridge have it in common, check_row saw: each such pair is
  /// listed once, and no other may have the same vertices. Ridges are brought together by a hash of these, a
  /// share of all hashes at a time.
  void check_ridges_are_unique() {
    constexpr std::size_t kRidgesAtATime = std::size_t{1} << 17, kMostShares = 32;
    const std::size_t ridges = result_.simplices * rank_ / 2;
    const std::size_t shares = std::clamp<std::size_t>(ridges / kRidgesAtATime, 1, kMostShares);
    std::vector<ComplexCheck> parts(shares);
    for_each_block(shares, 1, [&](std::size_t share, std::size_t) {
      std::vector<Ridge> found;
      found.reserve(ridges / shares + ridges / shares / 8);
      list_ridges(share, shares, found);
      std::sort(found.begin(), found.end(), [](const Ridge& a, const Ridge& b) {
        return a.key != b.key ? a.key < b.key : a.row != b.row ? a.row < b.row : a.slot < b.slot;
      });
      check_listed_once(found, parts[share]);
    });
    for (const ComplexCheck& part : parts) join(result_, part);
  }

  void list_ridges(std::size_t share, std::size_t shares, std::vector<Ridge>& found) const {
    constexpr unsigned kHalf = 32;
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      if (is_free(row)) continue;
      std::uint64_t sum = 0;
      for (std::size_t slot = 0; slot < rank_; ++slot) sum += mix(vertices(row)[slot]);
      for (std::uint32_t slot = 0; slot < rank_; ++slot) {
        if (neighbours(row)[slot] < row) continue;
        const std::uint64_t key = sum - mix(vertices(row)[slot]);
        if (((key >> kHalf) * shares) >> kHalf == share) found.push_back({key, row, slot});
      }
    }
  }

  /// Ridges of one key are compared in full.
  void check_listed_once(const std::vector<Ridge>& ridges, ComplexCheck& part) const {
    for (std::size_t i = 1; i < ridges.size(); ++i) {
      const Ridge &ridge = ridges[i], &before = ridges[i - 1];
      if (ridge.key == before.key && have_same_ridge(ridge.row, place(ridge), before.row, place(before)))
        report(part, "a ridge belongs to other than two simplices", ridge.row, ridge.slot);
    }
  }
  std::size_t place(const Ridge& ridge) const { return place_of(ridge.row, vertices(ridge.row)[ridge.slot]); }

  void check_connected() {
    std::vector<bool> reached(complex_.row_count, false);
    std::vector<std::uint32_t> queue;
    queue.reserve(result_.simplices);
    for (std::uint32_t row = 0; row < complex_.row_count && queue.empty(); ++row) {
      if (!is_free(row)) queue.push_back(row);
    }
    if (queue.empty()) return;
    reached[queue[0]] = true;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      prefetch(neighbours(queue[std::min(i + kRowsAhead, queue.size() - 1)]), rank_);
      for (std::size_t slot = 0; slot < rank_; ++slot) {
        const std::uint32_t next = neighbours(queue[i])[slot];
        if (next >= complex_.row_count || reached[next]) continue;
        reached[next] = true;
        queue.push_back(next);
      }
    }
    if (queue.size() == result_.simplices || result_.problems++ > 0) return;
    result_.first_problem = "simplex " + std::to_string(queue[0]) + ": reaches " +
                            std::to_string(queue.size()) + " of " + std::to_string(result_.simplices) +
                            " simplices";
  }

  const SimplicialComplex& complex_;
  std::size_t rank_;
  std::vector<std::uint32_t> sorted_;  // rows x rank: vertices in ascending order
  std::vector<std::uint8_t> is_odd_;   // per row: the permutation that sorts it
  ComplexCheck result_;
};

}  // namespace

ComplexCheck check_complex(const SimplicialComplex& complex) { return Checker(complex).run(); }

}  // namespace ndhull
