#include "core/whole_facets/pulled_complex.h"

#include <algorithm>
#include <bit>
#include <string>

#include "core/error.h"
#include "core/ids.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

class ComplexMaker {
 public:
  ComplexMaker(const PulledFaces& faces, std::span<const std::uint32_t> first_rows)
      : faces_(faces), first_rows_(first_rows), rank_(faces.rank) {}

  GroupedComplex run() {
    const std::uint64_t count = count_simplices(faces_);
    constexpr std::uint64_t kMostSimplices = std::uint64_t{1} << 27;
    if (count > kMostSimplices) {
      throw Error(ErrorCode::kTooManySimplices,
                  "the facets have " + std::to_string(count) + " simplices, expected at most " +
                      std::to_string(kMostSimplices) + "; ask for facets, vertices or planes only");
    }
    made_.complex = SimplicialComplex(rank_, count);
    made_.complex.row_count = count;
    made_.facet_begin.push_back(0);
    for (const std::uint32_t facet : faces_.facets) {
      list(facet);
      made_.facet_begin.push_back(next_);
    }
    std::copy(first_rows_.begin(), first_rows_.end(), first_vertices_.begin());
    for (std::uint32_t row = 0; row < count; ++row) {
      std::copy_n(first_vertices_.data() + row * rank_, rank_, vertices(row));
      made_.complex.state[row] = SimplexState::kLive;
    }
    match();
    orient();
    made_.complex.planes = HugeArray<double>();
    made_.complex.outside_head = HugeArray<std::uint32_t>();
    return std::move(made_);
  }

 private:
  std::uint32_t* vertices(std::size_t row) { return made_.complex.topology.data() + row * 2 * rank_; }
  std::uint32_t* neighbours(std::size_t row) { return vertices(row) + rank_; }

  /// The simplices of a face as cones over those of its faces, under the apexes so far.
  void list(std::uint32_t number) {
    const PulledFaces::Face& face = faces_.faces[number];
    const std::span<const std::uint32_t> entries = faces_.entries_of(face);
    if (face.is_simplex) {
      first_vertices_.insert(first_vertices_.end(), apexes_.begin(), apexes_.end());
      first_vertices_.insert(first_vertices_.end(), entries.begin(), entries.end());
      ++next_;
      return;
    }
    apexes_.push_back(entries[0]);
    for (const std::uint32_t child : entries.subspan(1)) list(child);
    apexes_.pop_back();
  }

  /// Pairs the two simplices at each ridge: open addressing by the sum of random numbers of its vertices.
  void match() {
    const std::size_t rows = made_.complex.row_count;
    std::uint32_t highest = 0;
    for (const std::uint32_t id : first_vertices_) highest = std::max(highest, id);
    PortableRandom random(1);
    std::vector<std::uint64_t> number(std::size_t{highest} + 1);
    for (std::uint64_t& entry : number) {
      entry = static_cast<std::uint64_t>(random.unit() * 0x1p53) << 11;
      entry ^= static_cast<std::uint64_t>(random.unit() * 0x1p53);
    }
    struct Slot {
      std::uint64_t key;
      std::uint32_t row = kNone, place = 0;
      bool is_paired = false;
    };
    std::vector<Slot> slots(std::bit_ceil(rows * rank_ + 1));
    const int shift = std::countl_zero(slots.size() - 1);
    std::size_t pairs = 0;
    for (std::uint32_t row = 0; row < rows; ++row) {
      std::uint64_t sum = 0;
      for (std::size_t k = 0; k < rank_; ++k) sum += number[vertices(row)[k]];
      for (std::uint32_t k = 0; k < rank_; ++k) {
        const std::uint64_t key = sum - number[vertices(row)[k]];
        std::size_t at = (key * 0x9e3779b97f4a7c15) >> shift;
        while (slots[at].row != kNone &&
               !(slots[at].key == key && is_same_ridge(row, k, slots[at].row, slots[at].place)))
          at = (at + 1) & (slots.size() - 1);
        if (slots[at].row == kNone) {
          slots[at] = {.key = key, .row = row, .place = k};
        } else {
          NDHULL_CHECK(!slots[at].is_paired);
          slots[at].is_paired = true;
          ++pairs;
          neighbours(row)[k] = slots[at].row;
          neighbours(slots[at].row)[slots[at].place] = row;
        }
      }
    }
    NDHULL_CHECK(2 * pairs == rows * rank_);
  }

  bool is_same_ridge(std::uint32_t a, std::size_t place_a, std::uint32_t b, std::size_t place_b) {
    for (std::size_t k = 0; k < rank_; ++k) {
      if (k == place_a) continue;
      const std::uint32_t *row = vertices(b), *end = row + rank_;
      const std::uint32_t* at = std::find(row, end, vertices(a)[k]);
      if (at == end || at == row + place_b) return false;
    }
    return true;
  }

  /// From the first row over neighbours: one that replaces a vertex of the other, with the rest in the same
  /// places, has the opposite orientation, so as they stand they must differ by an odd permutation.
  void orient() {
    std::vector<bool> is_oriented(made_.complex.row_count, false);
    std::vector<std::uint32_t> queue{0};
    is_oriented[0] = true;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t row = queue[i];
      for (std::size_t k = 0; k < rank_; ++k) {
        const std::uint32_t next = neighbours(row)[k];
        if (is_oriented[next]) continue;
        is_oriented[next] = true;
        queue.push_back(next);
        if (is_odd(row, k, next)) continue;
        std::swap(vertices(next)[0], vertices(next)[1]);
        std::swap(neighbours(next)[0], neighbours(next)[1]);
      }
    }
  }

  /// Is the permutation from `row`, with its vertex k replaced, to `next` odd?
  bool is_odd(std::uint32_t row, std::size_t k, std::uint32_t next) {
    places_.resize(rank_);
    for (std::size_t i = 0; i < rank_; ++i) {
      const std::uint32_t* own = vertices(row);
      const std::uint32_t* at = std::find(own, own + rank_, vertices(next)[i]);
      places_[i] = at == own + rank_ ? k : static_cast<std::size_t>(at - own);
    }
    bool odd = false;
    for (std::size_t i = 0; i < rank_; ++i)
      for (std::size_t j = i + 1; j < rank_; ++j) odd ^= places_[i] > places_[j];
    return odd;
  }

  const PulledFaces& faces_;
  std::span<const std::uint32_t> first_rows_;
  std::size_t rank_;
  GroupedComplex made_;
  std::uint32_t next_ = 0;
  std::vector<std::uint32_t> apexes_, first_vertices_;
  std::vector<std::size_t> places_;
};

}  // namespace

GroupedComplex make_complex(const PulledFaces& faces, std::span<const std::uint32_t> first_rows) {
  return ComplexMaker(faces, first_rows).run();
}

}  // namespace ndhull
