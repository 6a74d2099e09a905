
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>

#include "approx/plane_polytope.h"
#include "core/blocks.h"
#include "core/dense_solve.h"
#include "core/dense_views.h"
#include "core/dimension_switch.h"
#include "core/error.h"
#include "core/stopwatch.h"

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
  void prefetch_slot(std::uint64_t hash) const { __builtin_prefetch(&slots_[place_of(hash)]); }
  void prefetch_row(std::uint64_t hash) const {
    const Slot& slot = slots_[place_of(hash)];
    if (slot.face != 0) __builtin_prefetch(level_.row(slot.face - 1));
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

/// The vertices of a thin polytope under a linear map that makes it about as thick in all directions. As they
/// are they span its faces badly: the rounding of a direction along the plate, times the plate's width, is
/// not small beside its thickness. (Of plates 1e-8 thick with pairs of vertices as close, in 3-d to 5-d, up
/// to half of the volume was lost or found twice.)
class EvenVertices {
 public:
  EvenVertices(std::size_t rank, const std::vector<double>& vertices) {
    RowMatrix rows = as_rows(vertices, rank);
    rows.rowwise() -= rows.colwise().mean().eval();
    const Eigen::VectorXd lengths = rows.colwise().norm().transpose();
    if (rows.rows() < rows.cols() || !(lengths.minCoeff() > 0.0) || !lengths.allFinite()) return;
    rows.array().rowwise() /= lengths.transpose().array();
    const PivotedFactors factors(rows, 1e-14 * static_cast<double>(rank));
    if (factors.rank() < rows.cols()) return;  // thinner than rounding: nothing to be gained
    const Eigen::MatrixXd upper = factors.upper(rows.cols());
    const Eigen::MatrixXd permutation = factors.permutation();
    const Eigen::VectorXd thickness =
        (upper.diagonal().array() * (permutation.transpose() * lengths).array()).abs();
    if (thickness.minCoeff() > kThin * thickness.maxCoeff()) return;
    const RowMatrix even = upper.triangularView<Eigen::Upper>().solve<Eigen::OnTheRight>(rows * permutation);
    values_.assign(even.data(), even.data() + even.size());
    for (const double factor : thickness) {
      int of_factor = 0, of_product = 0;
      fraction_ = std::frexp(fraction_ * std::frexp(factor, &of_factor), &of_product);
      exponent_ += of_factor + of_product;
    }
  }

  bool is_thin() const { return !values_.empty(); }
  /// Precondition: is_thin().
  const std::vector<double>& values() const { return values_; }
  /// Of the polytope as it is, from that of the even one.
  double volume(double even) const { return std::ldexp(fraction_ * even, exponent_); }

 private:
  /// [ratio] of thicknesses. What is lost goes with its square: here the twelfth digit.
  static constexpr double kThin = 1e-2;

  std::vector<double> values_;
  // The determinant of the map back, fraction x 2^exponent: no range is left on the way.
  double fraction_ = 1.0;
  int exponent_ = 0;
};

/// Vertices that span a face, as orthonormal directions from the first of them.
template <std::size_t D>
class FaceFrame {
 public:
  explicit FaceFrame(const std::vector<double>& vertices) : vertices_(vertices) {}

  void set(const std::uint32_t* corners, std::size_t count) {
    origin_ = vertex(corners[0]);
    directions_ = 0;
    for (std::size_t k = 1; k < count; ++k) {
      const double length = distance(corners[k]);
      for (std::size_t i = 0; i < D; ++i) frame_[(k - 1) * D + i] = length > 0.0 ? rest_[i] / length : 0.0;
      directions_ = k;
    }
  }

  /// Of a vertex from the span. What is left after one subtraction is subtracted from once more when it is so
  /// small that rounding shows (Giraud, Langou, Rozloznik. The loss of orthogonality in the Gram-Schmidt
  /// orthogonalization process. 2005).
  double distance(std::uint32_t id) {
    for (std::size_t i = 0; i < D; ++i) rest_[i] = vertex(id)[i] - origin_[i];
    const double before = length();
    subtract_span();
    const double once = length();
    if (once > 0.5 * before) return once;
    subtract_span();
    return length();
  }

 private:
  const double* vertex(std::uint32_t id) const { return vertices_.data() + id * D; }

  double length() const {
    double sum = 0.0;
    for (const double value : rest_) sum += value * value;
    return std::sqrt(sum);
  }

  void subtract_span() {
    for (std::size_t j = 0; j < directions_; ++j) {
      const double* const direction = frame_.data() + j * D;
      double dot = 0.0;
      for (std::size_t i = 0; i < D; ++i) dot += direction[i] * rest_[i];
      for (std::size_t i = 0; i < D; ++i) rest_[i] -= dot * direction[i];
    }
  }

  const std::vector<double>& vertices_;
  std::size_t directions_ = 0;
  const double* origin_ = nullptr;
  std::array<double, D * D> frame_{};
  std::array<double, D> rest_{};
};

class Measurer {
 public:
  /// `vertices`: the polytope's, or their images.
  Measurer(const PlanesAboutOrigin& planes, const PlanePolytope& polytope,
           const std::vector<double>& vertices, const HullOptions& options, Clock::time_point start)
      : polytope_(polytope), vertices_(vertices), options_(options), start_(start), rank_(planes.rank) {
    for (std::size_t id = 0; id < planes.heights.size(); ++id) plane_hash_.push_back(mixed(id));
  }

  PolytopeMeasure measure() {
    PolytopeMeasure result;
    FaceLevel level = vertices();
    while (level.width > 0) {
      if (level.width == 1) result.area = std::accumulate(level.measure.begin(), level.measure.end(), 0.0);
      level = next(level);
      if (is_over()) return {is_late_ ? HullStatus::kTimeLimit : HullStatus::kInterrupted, 0.0, 0.0};
    }
    result.volume = level.measure.empty() ? 0.0 : level.measure[0];
    return result;
  }

 private:
  /// Has work to end? What is made after that is not used.
  bool is_over() const {
    const double limit = options_.limits.max_seconds;
    if (!is_late_ && limit > 0.0 && seconds_since(start_) > limit) is_late_ = true;
    return is_late_ || options_.stop.stop_requested();
  }

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
  /// without plane k is parents[f * width + k]. Some keys at a time, so that memory is fetched ahead.
  FaceLevel faces_above(const FaceLevel& level, std::vector<std::uint32_t>& parents) const {
    constexpr std::size_t kFacesAhead = 16;
    FaceLevel higher;
    higher.width = level.width - 1;
    FaceIndex index(higher, level.size());
    parents.resize(level.size() * level.width);
    std::vector<FaceKey> keys;
    for (std::size_t begin = 0; begin < level.size() && !is_over(); begin += kFacesAhead) {
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

  /// Terms of the faces' measures in those above: height times measure over dimension, 0 for a face that has
  /// the other's base among its vertices: seen from there it has no height.
  template <std::size_t D>
  std::vector<double> terms_of(const FaceLevel& level, const FaceLevel& higher,
                               const std::vector<std::uint32_t>& parents) const {
    const std::size_t dimension = rank_ - higher.width;
    std::vector<double> terms(parents.size(), 0.0);
    for_each_block(level.size(), 1024, [&](std::size_t begin, std::size_t end) {
      if (is_over()) return;
      FaceFrame<D> frame(vertices_);
      for (std::size_t face = begin; face != end; ++face) {
        if (level.measure[face] == 0.0) continue;
        bool is_set = false;
        for (std::size_t k = face * level.width; k < (face + 1) * level.width; ++k) {
          const std::uint32_t base = higher.base[parents[k]];
          if (base == level.base[face]) continue;
          if (!is_set) frame.set(level.corners.data() + face * dimension, dimension);
          is_set = true;
          terms[k] = level.measure[face] * frame.distance(base) / static_cast<double>(dimension);
        }
      }
    });
    return terms;
  }

  FaceLevel next(const FaceLevel& level) const {
    std::vector<std::uint32_t> parents;
    FaceLevel higher = faces_above(level, parents);
    if (is_over()) return higher;
    const std::size_t dimension = rank_ - higher.width;
    const std::vector<double> terms =
        call_with_dimension<1, kMaxRank>(rank_, [&](auto d) { return terms_of<d>(level, higher, parents); });
    higher.measure.assign(higher.size(), 0.0);
    std::vector<double> largest_term(higher.size(), 0.0);
    std::vector<std::uint32_t> largest_facet(higher.size(), 0);
    for (std::size_t k = 0; k < parents.size(); ++k) {
      const std::uint32_t parent = parents[k];
      higher.measure[parent] += terms[k];
      if (terms[k] <= largest_term[parent]) continue;
      largest_term[parent] = terms[k];
      largest_facet[parent] = static_cast<std::uint32_t>(k / level.width);
    }
    higher.corners.reserve(higher.size() * (dimension + 1));
    for (std::size_t face = 0; face < higher.size(); ++face) {
      higher.corners.push_back(higher.base[face]);
      const auto below = level.corners.begin() + static_cast<std::ptrdiff_t>(largest_facet[face] * dimension);
      higher.corners.insert(higher.corners.end(), below, below + static_cast<std::ptrdiff_t>(dimension));
    }
    return higher;
  }

  const PlanePolytope& polytope_;
  const std::vector<double>& vertices_;
  const HullOptions& options_;
  Clock::time_point start_;
  mutable std::atomic<bool> is_late_ = false;
  std::size_t rank_;
  std::vector<std::uint64_t> plane_hash_;
};

/// Simplices a vertex from which on the hull of the vertices is tried first.
constexpr std::size_t kSimplicesOfVertex = 4;

/// Of the hull of the vertices, when that is no larger than the dual hull.
std::optional<PolytopeMeasure> measure_by_hull(std::size_t rank, const PlanePolytope& polytope,
                                               const HullOptions& limits) {
  const std::size_t vertices = polytope.vertex_count(rank), simplices = polytope.vertex_of.size();
  if (rank < 2 || simplices < kSimplicesOfVertex * vertices) return std::nullopt;
  HullOptions options;
  options.limits = {.max_facets = simplices, .max_seconds = limits.limits.max_seconds};
  options.stop = limits.stop;
  const Hull hull = convex_hull(PointView::row_major(polytope.vertices.data(), vertices, rank), options);
  if (hull.status != HullStatus::kComplete || hull.rank < rank) return std::nullopt;
  return PolytopeMeasure{HullStatus::kComplete, hull.volume, hull.area};
}

}  // namespace

PolytopeMeasure measure_polytope(const PlanesAboutOrigin& planes, const PlanePolytope& polytope,
                                 const HullOptions& options, bool wants_area) {
  NDHULL_CHECK(polytope.bounded);
  const Clock::time_point start = Clock::now();
  if (const auto measure = measure_by_hull(planes.rank, polytope, options)) return *measure;
  const auto measured = [&](const std::vector<double>& vertices) {
    return Measurer(planes, polytope, vertices, options, start).measure();
  };
  const EvenVertices even(planes.rank, polytope.vertices);
  if (!even.is_thin()) return measured(polytope.vertices);
  // The large facets of a plate lose digits by the map: its rounding is that of the plate's thickness.
  PolytopeMeasure measure{HullStatus::kComplete, 0.0, 0.0};
  if (wants_area) measure = measured(polytope.vertices);
  if (measure.status != HullStatus::kComplete) return measure;
  const PolytopeMeasure of_even = measured(even.values());
  return {of_even.status, even.volume(of_even.volume), measure.area};
}

}  // namespace ndhull
