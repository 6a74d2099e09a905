#include "core/complex_check.h"

#include <algorithm>
#include <vector>

namespace ndhull {
namespace {

/// Sorted vertices of the ridge opposite slot `slot`.
std::vector<std::uint32_t> ridge_of(std::span<const PointId> vertices, std::size_t slot) {
  std::vector<std::uint32_t> ids;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (k != slot) ids.push_back(vertices[k].value);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// Parity of the permutation that sorts `ids`: 0 even, 1 odd. Counts inversions: rank is small.
unsigned parity(std::span<const PointId> ids, std::size_t without) {
  unsigned inversions = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = i + 1; j < ids.size(); ++j) {
      if (i != without && j != without && ids[i] > ids[j]) ++inversions;
    }
  }
  return inversions % 2;
}

class Checker {
 public:
  explicit Checker(const SimplicialComplex& complex) : complex_(complex) {}

  ComplexCheck run() {
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      if (complex_.state[row] == SimplexState::kFree) continue;
      ++result_.simplices;
      check_vertices(row);
      check_neighbours(row);
    }
    check_ridges_are_unique();
    check_connected();
    return result_;
  }

 private:
  void report(const char* what, std::uint32_t row, std::size_t slot) {
    if (result_.problems++ == 0) {
      result_.first_problem =
          "simplex " + std::to_string(row) + " slot " + std::to_string(slot) + ": " + std::string(what);
    }
  }

  void check_vertices(std::uint32_t row) {
    const auto sorted = ridge_of(complex_.vertices(SimplexId{row}), complex_.rank);
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) report("repeats a vertex", row, 0);
  }

  void check_neighbours(std::uint32_t row) {
    const auto vertices = complex_.vertices(SimplexId{row});
    const auto neighbours = complex_.neighbours(SimplexId{row});
    for (std::size_t slot = 0; slot < complex_.rank; ++slot) {
      const std::uint32_t other = neighbours[slot].value;
      if (other >= complex_.row_count || complex_.state[other] == SimplexState::kFree || other == row) {
        report("has no live neighbour", row, slot);
        continue;
      }
      const auto other_vertices = complex_.vertices(SimplexId{other});
      const auto other_neighbours = complex_.neighbours(SimplexId{other});
      bool found = false;
      for (std::size_t back = 0; back < complex_.rank && !found; ++back) {
        if (other_neighbours[back].value != row) continue;
        if (ridge_of(vertices, slot) != ridge_of(other_vertices, back)) continue;
        found = true;
        // Induced orientations of the common ridge must differ: (-1)^slot times the sorting parity.
        const unsigned mine = (parity(vertices, slot) + static_cast<unsigned>(slot)) % 2;
        const unsigned theirs = (parity(other_vertices, back) + static_cast<unsigned>(back)) % 2;
        // In one dimension the two ends have the empty ridge in common, which has no orientation.
        if (mine == theirs && complex_.rank > 1) report("is oriented against its neighbour", row, slot);
      }
      if (!found) report("is not named back across the same ridge", row, slot);
    }
  }

  /// Ridges are brought together by a hash of their vertex sets; equal hashes are compared in full.
  void check_ridges_are_unique() {
    struct Ridge {
      std::uint64_t key;
      std::uint32_t row, slot;
    };
    std::vector<Ridge> ridges;
    ridges.reserve(result_.simplices * complex_.rank);
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      if (complex_.state[row] == SimplexState::kFree) continue;
      const auto vertices = complex_.vertices(SimplexId{row});
      std::uint64_t sum = 0;
      for (const PointId id : vertices) sum += mix(id.value);
      for (std::uint32_t slot = 0; slot < complex_.rank; ++slot) {
        ridges.push_back({sum - mix(vertices[slot].value), row, slot});
      }
    }
    std::sort(ridges.begin(), ridges.end(),
              [](const Ridge& a, const Ridge& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
    for (std::size_t begin = 0, end = 0; begin < ridges.size(); begin = end) {
      const auto ridge = [&](std::size_t i) {
        return ridge_of(complex_.vertices(SimplexId{ridges[i].row}), std::size_t{ridges[i].slot});
      };
      for (end = begin; end < ridges.size() && ridges[end].key == ridges[begin].key; ++end) {
      }
      std::size_t shared = 0;
      for (std::size_t i = begin; i < end; ++i) shared += ridge(i) == ridge(begin) ? 1u : 0u;
      if (shared != 2 || end - begin != 2) {
        report("a ridge belongs to other than two simplices", ridges[begin].row, ridges[begin].slot);
      }
    }
  }

  static std::uint64_t mix(std::uint64_t x) {  // MurmurHash3's finalizer (Appleby)
    x = (x + 1) * 0xFF51'AFD7'ED55'8CCDu;
    x = (x ^ (x >> 33)) * 0xC4CE'B9FE'1A85'EC53u;
    return x ^ (x >> 33);
  }

  void check_connected() {
    std::vector<bool> reached(complex_.row_count, false);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t row = 0; row < complex_.row_count && queue.empty(); ++row) {
      if (complex_.state[row] != SimplexState::kFree) queue.push_back(row);
    }
    if (queue.empty()) return;
    reached[queue[0]] = true;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const SimplexId next : complex_.neighbours(SimplexId{queue[i]})) {
        if (next.value >= complex_.row_count || reached[next.value]) continue;
        reached[next.value] = true;
        queue.push_back(next.value);
      }
    }
    if (queue.size() != result_.simplices)
      report("is all that the first simplex reaches", queue[0], queue.size());
  }

  const SimplicialComplex& complex_;
  ComplexCheck result_;
};

}  // namespace

ComplexCheck check_complex(const SimplicialComplex& complex) { return Checker(complex).run(); }

}  // namespace ndhull
