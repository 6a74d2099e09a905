#include <algorithm>
#include <cmath>

#include "approx/plane_polytope.h"
#include "core/error.h"

namespace ndhull {
namespace {

std::uint64_t mixed(std::uint64_t id) {  // splitmix64's output function
  std::uint64_t z = (id + 1) * 0x9E37'79B9'7F4A'7C15u;
  z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
  z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
  return z ^ (z >> 31);
}

/// Faces of one dimension: those planes meet in face f that stand in row f, ascending.
struct FaceLevel {
  std::size_t width = 0;               // planes of a face: rank less its dimension
  std::vector<std::uint32_t> planes;   // faces x width
  std::vector<std::uint32_t> base;     // the vertex of the face with the lowest number
  std::vector<std::uint32_t> corners;  // faces x (dimension + 1): vertices that span the face, base first
  std::vector<double> measure;         // of the face's dimension; 0: its vertices span less

  std::size_t size() const { return base.size(); }
  const std::uint32_t* row(std::size_t face) const { return planes.data() + face * width; }
};

/// Sets of planes and their numbers, by open addressing.
class FaceIndex {
 public:
  explicit FaceIndex(FaceLevel& level) : level_(level), slots_(1024, 0) {}

  /// The face with these planes; a new one when there is none. `hash` is the XOR of their mixed ids.
  std::uint32_t find_or_add(const std::uint32_t* planes, std::uint64_t hash, std::uint32_t base) {
    if (2 * level_.size() >= slots_.size()) grow();
    std::size_t at = hash & (slots_.size() - 1);
    for (; slots_[at] != 0; at = (at + 1) & (slots_.size() - 1)) {
      const std::uint32_t face = slots_[at] - 1;
      if (!std::equal(planes, planes + level_.width, level_.row(face))) continue;
      level_.base[face] = std::min(level_.base[face], base);
      return face;
    }
    level_.planes.insert(level_.planes.end(), planes, planes + level_.width);
    level_.base.push_back(base);
    hashes_.push_back(hash);
    slots_[at] = static_cast<std::uint32_t>(level_.size());
    return slots_[at] - 1;
  }

 private:
  void grow() {
    slots_.assign(slots_.size() * 4, 0);
    for (std::uint32_t face = 0; face < level_.size(); ++face) {
      std::size_t at = hashes_[face] & (slots_.size() - 1);
      while (slots_[at] != 0) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = face + 1;
    }
  }

  FaceLevel& level_;
  std::vector<std::uint32_t> slots_;  // face + 1
  std::vector<std::uint64_t> hashes_;
};

class Measurer {
 public:
  Measurer(const PlanesAboutOrigin& planes, const PlanePolytope& polytope)
      : planes_(planes), polytope_(polytope), rank_(planes.rank), frame_(rank_ * rank_), rest_(rank_) {}

  PolytopeMeasure measure() {
    PolytopeMeasure result;
    result.facet_areas.assign(planes_.heights.size(), 0.0);
    FaceLevel level = vertices();
    while (level.width > 0) {
      if (level.width == 1) {
        for (std::size_t face = 0; face < level.size(); ++face) {
          result.facet_areas[level.planes[face]] = level.measure[face];
          result.area += level.measure[face];
        }
      }
      level = next(level);
    }
    result.volume = level.measure.empty() ? 0.0 : level.measure[0];
    return result;
  }

 private:
  FaceLevel vertices() const {
    FaceLevel level;
    level.width = rank_;
    level.planes = polytope_.planes;
    level.base = polytope_.vertex_of;
    level.corners = polytope_.vertex_of;
    level.measure.assign(level.size(), 1.0);
    for (std::size_t face = 0; face < level.size(); ++face) {
      const auto begin = level.planes.begin() + static_cast<std::ptrdiff_t>(face * rank_);
      std::sort(begin, begin + static_cast<std::ptrdiff_t>(rank_));
    }
    return level;
  }

  /// The faces one dimension higher, not measured yet, and the number of each face's faces above it: row f
  /// without plane k is parents[f * width + k].
  FaceLevel faces_above(const FaceLevel& level, std::vector<std::uint32_t>& parents) const {
    FaceLevel higher;
    higher.width = level.width - 1;
    FaceIndex index(higher);
    parents.resize(level.size() * level.width);
    std::vector<std::uint32_t> rest(level.width);
    for (std::size_t face = 0; face < level.size(); ++face) {
      const std::uint32_t* const row = level.row(face);
      std::uint64_t all = 0;
      for (std::size_t k = 0; k < level.width; ++k) all ^= mixed(row[k]);
      for (std::size_t k = 0; k < level.width; ++k) {
        std::copy(row, row + k, rest.begin());
        std::copy(row + k + 1, row + level.width, rest.begin() + static_cast<std::ptrdiff_t>(k));
        parents[face * level.width + k] =
            index.find_or_add(rest.data(), all ^ mixed(row[k]), level.base[face]);
      }
    }
    return higher;
  }

  FaceLevel next(const FaceLevel& level) {
    std::vector<std::uint32_t> parents;
    FaceLevel higher = faces_above(level, parents);
    const std::size_t dimension = rank_ - higher.width;
    const double share = 1.0 / static_cast<double>(dimension);
    higher.measure.assign(higher.size(), 0.0);
    std::vector<double> largest_term(higher.size(), 0.0);
    std::vector<std::uint32_t> largest_facet(higher.size(), 0);
    for (std::uint32_t face = 0; face < level.size(); ++face) {
      const std::uint32_t* const own_parents = parents.data() + std::size_t{face} * level.width;
      // Seen from a vertex of its own a face has no height.
      const auto adds_to = [&](std::uint32_t parent) { return higher.base[parent] != level.base[face]; };
      if (level.measure[face] == 0.0 || std::none_of(own_parents, own_parents + level.width, adds_to))
        continue;
      make_frame(level.corners.data() + face * dimension, dimension);
      for (const std::uint32_t* parent = own_parents; parent != own_parents + level.width; ++parent) {
        if (!adds_to(*parent)) continue;
        const double height = distance_from_frame(higher.base[*parent], dimension - 1);
        const double term = share * level.measure[face] * height;
        higher.measure[*parent] += term;
        if (term <= largest_term[*parent]) continue;
        largest_term[*parent] = term;
        largest_facet[*parent] = face;
      }
    }
    for (std::size_t face = 0; face < higher.size(); ++face) {
      higher.corners.push_back(higher.base[face]);
      const auto below = level.corners.begin() + static_cast<std::ptrdiff_t>(largest_facet[face] * dimension);
      higher.corners.insert(higher.corners.end(), below, below + static_cast<std::ptrdiff_t>(dimension));
    }
    return higher;
  }

  const double* vertex(std::uint32_t id) const { return polytope_.vertices.data() + id * rank_; }

  /// What is left of `rest_` outside the first `count` directions of the frame. Twice is enough (Giraud,
  /// Langou, Rozloznik. The loss of orthogonality in the Gram-Schmidt orthogonalization process. 2005).
  double length_outside(std::size_t count) {
    double length_sq = 0.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j < count; ++j) {
        const double* const direction = frame_.data() + j * rank_;
        double dot = 0.0;
        for (std::size_t i = 0; i < rank_; ++i) dot += direction[i] * rest_[i];
        for (std::size_t i = 0; i < rank_; ++i) rest_[i] -= dot * direction[i];
      }
    }
    for (const double value : rest_) length_sq += value * value;
    return std::sqrt(length_sq);
  }

  double distance_from_frame(std::uint32_t id, std::size_t directions) {
    for (std::size_t i = 0; i < rank_; ++i) rest_[i] = vertex(id)[i] - origin_[i];
    return length_outside(directions);
  }

  /// Orthonormal directions of the span of `count` vertices.
  void make_frame(const std::uint32_t* corners, std::size_t count) {
    origin_ = vertex(corners[0]);
    for (std::size_t k = 1; k < count; ++k) {
      const double length = distance_from_frame(corners[k], k - 1);
      for (std::size_t i = 0; i < rank_; ++i)
        frame_[(k - 1) * rank_ + i] = length > 0.0 ? rest_[i] / length : 0.0;
    }
  }

  const PlanesAboutOrigin& planes_;
  const PlanePolytope& polytope_;
  std::size_t rank_;
  const double* origin_ = nullptr;
  std::vector<double> frame_, rest_;
};

}  // namespace

PolytopeMeasure measure_polytope(const PlanesAboutOrigin& planes, const PlanePolytope& polytope) {
  NDHULL_CHECK(polytope.bounded);
  return Measurer(planes, polytope).measure();
}

}  // namespace ndhull
