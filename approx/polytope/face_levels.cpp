#include "approx/polytope/face_levels.h"

#include <algorithm>

#include "core/machine/prefetch.h"
#include "core/scramble.h"

namespace ndhull {
namespace {

/// A set of planes that is looked up: face `face` of the level below without its plane `left_out`.
struct FaceKey {
  std::uint64_t hash;
  std::uint32_t face;
  std::uint32_t left_out;
};

/// Sets of planes and their numbers, by open addressing.
class FaceIndex {
 public:
  FaceIndex(FaceLevel& level, std::size_t expected) : level_(level) {
    std::size_t capacity = 1024;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.resize(capacity);
  }

  /// Fetches what `find_or_add` reads first, and next.
  void prefetch_slot(std::uint64_t hash) const { prefetch(&slots_[place_of(hash)]); }
  void prefetch_row(std::uint64_t hash) const {
    const Slot& slot = slots_[place_of(hash)];
    if (slot.face != 0) prefetch(level_.row(slot.face - 1));
  }

  /// The face with the planes of row `row` but for one; a new one when there is none. `base` is a vertex of
  /// it.
  std::uint32_t find_or_add(const FaceKey& key, const std::uint32_t* row, std::uint32_t base) {
    if (2 * (level_.size() + 1) >= slots_.size()) grow();
    const auto tag = static_cast<std::uint32_t>(key.hash >> 32);
    std::size_t at = place_of(key.hash);
    for (; slots_[at].face != 0; at = (at + 1) & (slots_.size() - 1)) {
      const std::uint32_t face = slots_[at].face - 1;
      if (slots_[at].tag != tag || !is_row_without(level_.row(face), row, key.left_out)) continue;
      level_.base[face] = std::min(level_.base[face], base);
      return face;
    }
    for (std::size_t k = 0; k <= level_.width; ++k) {
      if (k != key.left_out) level_.planes.push_back(row[k]);
    }
    level_.base.push_back(base);
    hashes_.push_back(key.hash);
    slots_[at] = {tag, static_cast<std::uint32_t>(level_.size())};
    return slots_[at].face - 1;
  }

 private:
  struct Slot {
    std::uint32_t tag = 0;
    std::uint32_t face = 0;  // + 1
  };

  std::size_t place_of(std::uint64_t hash) const { return hash & (slots_.size() - 1); }

  bool is_row_without(const std::uint32_t* planes, const std::uint32_t* row, std::size_t left_out) const {
    bool is_same = true;
    for (std::size_t k = 0; k < level_.width; ++k) is_same &= planes[k] == row[k + (k >= left_out ? 1 : 0)];
    return is_same;
  }

  void grow() {
    slots_.assign(slots_.size() * 4, Slot());
    for (std::uint32_t face = 0; face < level_.size(); ++face) {
      std::size_t at = place_of(hashes_[face]);
      while (slots_[at].face != 0) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = {static_cast<std::uint32_t>(hashes_[face] >> 32), face + 1};
    }
  }

  FaceLevel& level_;
  std::vector<Slot> slots_;
  std::vector<std::uint64_t> hashes_;
};

}  // namespace

FaceLevels::FaceLevels(const PlanesAboutOrigin& planes, const PlanePolytope& polytope, const WorkEnd& end)
    : polytope_(polytope), end_(end), rank_(planes.rank) {
  for (std::size_t id = 0; id < planes.heights.size(); ++id)
    plane_hash_.push_back(scramble(id * kScrambleStep));
}

FaceLevel FaceLevels::vertices() const {
  FaceLevel level;
  level.width = rank_;
  level.planes = polytope_.planes;
  level.base = polytope_.vertex_of;
  for (std::size_t face = 0; face < level.size(); ++face) {
    const auto begin = level.planes.begin() + static_cast<std::ptrdiff_t>(face * rank_);
    std::sort(begin, begin + static_cast<std::ptrdiff_t>(rank_));
  }
  return level;
}

FaceLevel FaceLevels::above(const FaceLevel& level, std::vector<std::uint32_t>& parents) const {
  constexpr std::size_t kFacesAhead = 16;
  FaceLevel higher;
  higher.width = level.width - 1;
  FaceIndex index(higher, level.size());
  parents.resize(level.size() * level.width);
  std::vector<FaceKey> keys;
  for (std::size_t begin = 0; begin < level.size() && !end_.is_here(); begin += kFacesAhead) {
    keys.clear();
    for (std::size_t face = begin; face < std::min(begin + kFacesAhead, level.size()); ++face) {
      const std::uint32_t* const row = level.row(face);
      std::uint64_t all = 0;
      for (std::size_t k = 0; k < level.width; ++k) all ^= plane_hash_[row[k]];
      for (std::size_t k = 0; k < level.width; ++k) {
        keys.push_back(
            {all ^ plane_hash_[row[k]], static_cast<std::uint32_t>(face), static_cast<std::uint32_t>(k)});
        index.prefetch_slot(keys.back().hash);
      }
    }
    for (const FaceKey& key : keys) index.prefetch_row(key.hash);
    for (const FaceKey& key : keys) {
      parents[key.face * level.width + key.left_out] =
          index.find_or_add(key, level.row(key.face), level.base[key.face]);
    }
  }
  return higher;
}

}  // namespace ndhull
