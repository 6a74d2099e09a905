#include "core/whole_facets/face_pulling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/ids.h"
#include "core/whole_facets/double_description.h"

namespace ndhull {
namespace {

using Words = std::span<const std::uint64_t>;

std::size_t count_bits(Words words) {
  std::size_t count = 0;
  for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

bool is_within(const std::uint64_t* inner, const std::uint64_t* outer, std::size_t words) {
  std::uint64_t missing = 0;
  for (std::size_t w = 0; w < words; ++w) missing |= inner[w] & ~outer[w];
  return missing == 0;
}

std::uint64_t saturating_sum(std::uint64_t a, std::uint64_t b) {
  return a > std::numeric_limits<std::uint64_t>::max() - b ? std::numeric_limits<std::uint64_t>::max()
                                                           : a + b;
}

/// Faces by their vertices.
class FaceIndex {
 public:
  explicit FaceIndex(std::size_t words) : words_(words) {}

  /// The face with these vertices; without one, `next`, which these are the vertices of from now on.
  std::uint32_t find_or_add(Words bits, std::uint32_t next) {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : bits) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
    const auto [begin, end] = faces_.equal_range(hash);
    for (auto at = begin; at != end; ++at)
      if (std::equal(bits.begin(), bits.end(),
                     bits_.begin() + static_cast<std::ptrdiff_t>(at->second * words_)))
        return at->second;
    faces_.emplace(hash, next);
    bits_.insert(bits_.end(), bits.begin(), bits.end());
    return next;
  }

 private:
  std::size_t words_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> faces_;
  std::vector<std::uint64_t> bits_;  // of the faces in their order
};

/// What is known of a face on the way down to its own faces.
struct Level {
  std::vector<double> basis;          // k x rank, orthonormal
  std::vector<std::uint64_t> facets;  // bits of its facets
  std::vector<std::uint32_t> planes;  // a hull's facet that cuts each out
  std::vector<double> gradient;       // of the plane looked at, in the basis
  std::vector<std::uint32_t> children;
};

class Puller {
 public:
  Puller(const FacetIncidence& hull, const double* points, std::uint64_t work)
      : hull_(hull),
        points_(points),
        words_(hull.words),
        rank_(hull.rank),
        work_left_(work),
        index_(words_),
        levels_(hull.rank) {
    pulled_.rank = rank_;
  }

  PulledFaces run() {
    for (std::uint32_t facet = 0; facet < hull_.count(); ++facet) {
      const auto start = [&] { start_facet(facet, levels_[rank_ - 1]); };
      const std::uint32_t face = pull(hull_.bits(facet), rank_ - 1, start);
      if (is_exhausted_) break;
      pulled_.facets.push_back(face);
    }
    return std::move(pulled_);
  }

 private:
  void start_facet(std::uint32_t facet, Level& level) {
    level.planes.clear();
    level.facets.clear();
    for (const std::uint32_t other : hull_.neighbours[facet]) {
      level.planes.push_back(other);
      for (std::size_t w = 0; w < words_; ++w)
        level.facets.push_back(hull_.bits(facet)[w] & hull_.bits(other)[w]);
    }
    std::vector<double> identity(rank_ * rank_, 0.0);
    for (std::size_t k = 0; k < rank_; ++k) identity[k * (rank_ + 1)] = 1.0;
    std::vector<double> gradient(hull_.plane(facet).begin(), hull_.plane(facet).end());
    drop_direction(identity, rank_, gradient, level.basis);
  }

  /// An orthonormal basis of what is across `direction`, given in the basis `rows`: a Householder reflection
  /// takes the first axis to it, and the images of the others stay.
  void drop_direction(const std::vector<double>& rows, std::size_t count, std::vector<double>& direction,
                      std::vector<double>& across) {
    double length_sq = 0.0;
    for (const double entry : direction) length_sq += entry * entry;
    const double length = std::copysign(std::sqrt(length_sq), direction[0]);
    direction[0] += length;
    const double factor = 1.0 / (length * direction[0]);  // 2 / |direction|^2
    std::vector<double>& image = image_;
    image.assign(rank_, 0.0);
    for (std::size_t r = 0; r < count; ++r)
      for (std::size_t c = 0; c < rank_; ++c) image[c] += direction[r] * rows[r * rank_ + c];
    across.resize((count - 1) * rank_);
    for (std::size_t r = 1; r < count; ++r)
      for (std::size_t c = 0; c < rank_; ++c)
        across[(r - 1) * rank_ + c] = rows[r * rank_ + c] - factor * direction[r] * image[c];
  }

  /// The face's number. `prepare` fills levels_[k] with its facets and its basis, if they are needed.
  template <class Prepare>
  std::uint32_t pull(Words bits, std::size_t k, const Prepare& prepare) {
    const auto next = static_cast<std::uint32_t>(pulled_.faces.size());
    const std::uint32_t number = index_.find_or_add(bits, next);
    if (number != next) return number;
    pulled_.faces.emplace_back();
    constexpr std::uint64_t kStepsOfFace = 32;
    spend(kStepsOfFace + words_);
    if (count_bits(bits) == k + 1) {
      add_simplex(bits, k, number);
    } else {
      prepare();
      add_cones(bits, k, number);
    }
    return number;
  }

  void add_simplex(Words bits, std::size_t k, std::uint32_t number) {
    PulledFaces::Face& face = pulled_.faces[number];
    face.begin = narrow_id(pulled_.entries.size());
    face.count = static_cast<std::uint32_t>(k + 1);
    face.is_simplex = true;
    face.simplices = 1;
    for (std::size_t w = 0; w < words_; ++w)
      for (std::uint64_t left = bits[w]; left != 0; left &= left - 1)
        pulled_.entries.push_back(static_cast<std::uint32_t>(64 * w) +
                                  static_cast<std::uint32_t>(std::countr_zero(left)));
    face.measure = parallelotope(pulled_.entries_of(face));
    spend(k * k * rank_);
  }

  /// Volume of the parallelotope that the edges from the first vertex span: heights by Gram-Schmidt, twice.
  double parallelotope(std::span<const std::uint32_t> vertices) {
    std::vector<double>& edges = edges_;
    edges.clear();
    const double* from = points_ + std::size_t{vertices[0]} * rank_;
    double volume = 1.0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      const double* to = points_ + std::size_t{vertices[i]} * rank_;
      edges.resize(i * rank_);
      double* edge = edges.data() + (i - 1) * rank_;
      for (std::size_t c = 0; c < rank_; ++c) edge[c] = to[c] - from[c];
      for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t j = 0; j + 1 < i; ++j) {
          const double* unit = edges.data() + j * rank_;
          double dot = 0.0;
          for (std::size_t c = 0; c < rank_; ++c) dot += unit[c] * edge[c];
          for (std::size_t c = 0; c < rank_; ++c) edge[c] -= dot * unit[c];
        }
      }
      double length_sq = 0.0;
      for (std::size_t c = 0; c < rank_; ++c) length_sq += edge[c] * edge[c];
      const double length = std::sqrt(length_sq);
      volume *= length;
      for (std::size_t c = 0; c < rank_; ++c) edge[c] /= length;
    }
    return volume;
  }

  void add_cones(Words bits, std::size_t k, std::uint32_t number) {
    std::uint32_t apex = 0;
    for (std::size_t w = 0; w < words_; ++w) {
      if (bits[w] == 0) continue;
      apex = static_cast<std::uint32_t>(64 * w) + static_cast<std::uint32_t>(std::countr_zero(bits[w]));
      break;
    }
    Level& level = levels_[k];
    level.children.clear();
    double measure = 0.0;
    std::uint64_t simplices = 0;
    for (std::size_t i = 0; i < level.planes.size() && !is_exhausted_; ++i) {
      const Words facet(level.facets.data() + i * words_, words_);
      if ((facet[apex / 64] >> (apex % 64) & 1) != 0) continue;
      const double height = height_over(level, i, k, apex);
      const std::uint32_t child = pull(facet, k - 1, [&] { descend(level, i, k); });
      level.children.push_back(child);
      measure += height * pulled_.faces[child].measure;
      simplices = saturating_sum(simplices, pulled_.faces[child].simplices);
    }
    PulledFaces::Face& face = pulled_.faces[number];
    face.begin = narrow_id(pulled_.entries.size());
    face.count = static_cast<std::uint32_t>(1 + level.children.size());
    face.measure = measure;
    face.simplices = simplices;
    pulled_.entries.push_back(apex);
    pulled_.entries.insert(pulled_.entries.end(), level.children.begin(), level.children.end());
  }

  /// Of the apex over facet i of the face, within the face. Leaves the plane's gradient in the level.
  double height_over(Level& level, std::size_t i, std::size_t k, std::uint32_t apex) {
    const std::span<const double> plane = hull_.plane(level.planes[i]);
    const double* point = points_ + std::size_t{apex} * rank_;
    double below = 1.0, length_sq = 0.0;
    for (std::size_t c = 0; c < rank_; ++c) below -= plane[c] * point[c];
    level.gradient.assign(k, 0.0);
    for (std::size_t r = 0; r < k; ++r) {
      for (std::size_t c = 0; c < rank_; ++c) level.gradient[r] += level.basis[r * rank_ + c] * plane[c];
      length_sq += level.gradient[r] * level.gradient[r];
    }
    spend(k * rank_ / 4);
    return below / std::sqrt(length_sq);
  }

  /// Facets and basis of facet i of the face, for its own turn.
  void descend(const Level& level, std::size_t i, std::size_t k) {
    Level& next = levels_[k - 1];
    gradient_ = level.gradient;
    drop_direction(level.basis, k, gradient_, next.basis);
    const std::uint64_t* facet = level.facets.data() + i * words_;
    cuts_.clear();
    cut_bits_.clear();
    for (std::size_t j = 0; j < level.planes.size(); ++j) {
      if (j == i) continue;
      const std::size_t at = cut_bits_.size();
      for (std::size_t w = 0; w < words_; ++w) cut_bits_.push_back(facet[w] & level.facets[j * words_ + w]);
      const std::size_t size = count_bits({cut_bits_.data() + at, words_});
      if (size + 1 < k) {  // too few for a facet of dimension k - 2
        cut_bits_.resize(at);
      } else {
        cuts_.push_back({size, at, level.planes[j]});
      }
    }
    spend(level.planes.size() * words_ + k * rank_);
    keep_largest(next);
  }

  /// Of the intersections of one face those that are within no other, largest first; of equal ones one.
  void keep_largest(Level& level) {
    std::sort(cuts_.begin(), cuts_.end(),
              [](const Cut& a, const Cut& b) { return a.size != b.size ? a.size > b.size : a.at < b.at; });
    level.facets.clear();
    level.planes.clear();
    for (const Cut& cut : cuts_) {
      const std::uint64_t* own = cut_bits_.data() + cut.at;
      std::size_t at = 0;
      while (at < level.facets.size() && !is_within(own, level.facets.data() + at, words_)) at += words_;
      spend(2 + at);
      if (at < level.facets.size()) continue;
      level.facets.insert(level.facets.end(), own, own + words_);
      level.planes.push_back(cut.plane);
    }
  }

  void spend(std::uint64_t work) {
    is_exhausted_ = is_exhausted_ || work > work_left_;
    work_left_ -= std::min(work, work_left_);
  }

  const FacetIncidence& hull_;
  const double* points_;
  std::size_t words_, rank_;
  std::uint64_t work_left_;
  bool is_exhausted_ = false;
  FaceIndex index_;
  std::vector<Level> levels_;  // [k]: of the face of dimension k that is looked at
  PulledFaces pulled_;
  std::vector<double> image_, edges_, gradient_;
  struct Cut {
    std::size_t size, at;
    std::uint32_t plane;
  };
  std::vector<Cut> cuts_;  // intersections with the facets beside the face that is looked at
  std::vector<std::uint64_t> cut_bits_;
};

}  // namespace

std::uint64_t count_simplices(const PulledFaces& faces) {
  std::uint64_t count = 0;
  for (const std::uint32_t facet : faces.facets) count = saturating_sum(count, faces.faces[facet].simplices);
  return count;
}

void rename_vertices(PulledFaces& faces, std::span<const std::uint32_t> ids) {
  for (const PulledFaces::Face& face : faces.faces) {
    const std::size_t named = face.is_simplex ? face.count : 1;
    for (std::size_t i = 0; i < named; ++i) {
      std::uint32_t& entry = faces.entries[face.begin + i];
      entry = ids[entry];
    }
  }
}

PulledFaces pull_faces(const FacetIncidence& hull, const double* points, std::uint64_t work) {
  return Puller(hull, points, work).run();
}

}  // namespace ndhull
