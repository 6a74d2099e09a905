
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "approx/polytope/face_levels.h"
#include "approx/polytope/plane_polytope.h"
#include "approx/polytope/signed_measure.h"
#include "core/dimension_switch.h"
#include "core/error.h"
#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"
#include "core/machine/blocks.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

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
    back_ = upper * permutation.transpose() * lengths.asDiagonal();
    for (const double factor : thickness) {
      int of_factor = 0, of_product = 0;
      fraction_ = std::frexp(fraction_ * std::frexp(factor, &of_factor), &of_product);
      exponent_ += of_factor + of_product;
    }
  }

  bool is_thin() const { return !values_.empty(); }
  /// Precondition: is_thin().
  const std::vector<double>& values() const { return values_; }
  /// The planes' unit normals under the map.
  std::vector<double> normals(const std::vector<double>& as_they_are) const {
    RowMatrix rows = as_rows(as_they_are, static_cast<std::size_t>(back_.cols())) * back_.transpose();
    rows.rowwise().normalize();
    return {rows.data(), rows.data() + rows.size()};
  }
  /// Of the polytope as it is, from that of the even one.
  double volume(double even) const { return std::ldexp(fraction_ * even, exponent_); }

 private:
  /// [ratio] of thicknesses. What is lost goes with its square: here the twelfth digit.
  static constexpr double kThin = 1e-2;

  std::vector<double> values_;
  Eigen::MatrixXd back_;
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

/// A level of faces, measured.
struct MeasuredLevel {
  FaceLevel faces;
  std::vector<std::uint32_t> corners;  // faces x (dimension + 1): vertices that span the face, base first
  std::vector<double> measure;         // of the face's dimension; 0: its vertices span less
};

/// Measures face by face, without signs.
class Measurer {
 public:
  /// `vertices`: the polytope's, or their images; `normals` the planes' in the same coordinates.
  Measurer(const FaceLevels& levels, const std::vector<double>& vertices, const std::vector<double>& normals,
           std::size_t rank)
      : levels_(levels), vertices_(vertices), normals_(normals), rank_(rank) {}

  PolytopeMeasure measure() {
    PolytopeMeasure result;
    MeasuredLevel level;
    level.faces = levels_.vertices();
    level.corners = level.faces.base;
    level.measure.assign(level.faces.size(), 1.0);
    while (level.faces.width > 0) {
      if (level.faces.width == 1) {
        result.area = std::accumulate(level.measure.begin(), level.measure.end(), 0.0);
        is_closed_ = is_closed(level, result.area);
      }
      level = next(level);
      if (levels_.has_ended()) return {levels_.end_status(), 0.0, 0.0};
    }
    result.volume = level.measure.empty() ? 0.0 : level.measure[0];
    return result;
  }

  /// Are the facets' areas, along their normals, in balance, as those of a polytope are?
  bool is_closed() const { return is_closed_; }

 private:
  /// [ratio] of areas. Where no face was folded 1e-13 was the largest seen, else 1e-9 to 1e-2.
  static constexpr double kClosed = 1e-12;

  bool is_closed(const MeasuredLevel& facets, double area) const {
    std::vector<double> sum(rank_, 0.0);
    for (std::size_t facet = 0; facet < facets.faces.size(); ++facet) {
      for (std::size_t k = 0; k < rank_; ++k)
        sum[k] += facets.measure[facet] * normals_[*facets.faces.row(facet) * rank_ + k];
    }
    return std::all_of(sum.begin(), sum.end(),
                       [&](double value) { return std::abs(value) <= kClosed * area; });
  }

  /// Terms of the faces' measures in those above: height times measure over dimension, 0 for a face that has
  /// the other's base among its vertices: seen from there it has no height.
  template <std::size_t D>
  std::vector<double> terms_of(const MeasuredLevel& level, const FaceLevel& higher,
                               const std::vector<std::uint32_t>& parents) const {
    const std::size_t width = level.faces.width, dimension = rank_ - higher.width;
    std::vector<double> terms(parents.size(), 0.0);
    for_each_block(level.faces.size(), 1024, [&](std::size_t begin, std::size_t end) {
      if (levels_.has_ended()) return;
      FaceFrame<D> frame(vertices_);
      for (std::size_t face = begin; face != end; ++face) {
        if (level.measure[face] == 0.0) continue;
        bool is_set = false;
        for (std::size_t k = face * width; k < (face + 1) * width; ++k) {
          const std::uint32_t base = higher.base[parents[k]];
          if (base == level.faces.base[face]) continue;
          if (!is_set) frame.set(level.corners.data() + face * dimension, dimension);
          is_set = true;
          terms[k] = level.measure[face] * frame.distance(base) / static_cast<double>(dimension);
        }
      }
    });
    return terms;
  }

  MeasuredLevel next(const MeasuredLevel& level) const {
    std::vector<std::uint32_t> parents;
    MeasuredLevel higher{levels_.above(level.faces, parents), {}, {}};
    if (levels_.has_ended()) return higher;
    const std::size_t faces = higher.faces.size(), dimension = rank_ - higher.faces.width;
    const std::vector<double> terms = call_with_dimension<1, kMaxRank>(
        rank_, [&](auto d) { return terms_of<d>(level, higher.faces, parents); });
    higher.measure.assign(faces, 0.0);
    std::vector<double> largest_term(faces, 0.0);
    std::vector<std::uint32_t> largest_facet(faces, 0);
    for (std::size_t k = 0; k < parents.size(); ++k) {
      const std::uint32_t parent = parents[k];
      higher.measure[parent] += terms[k];
      if (terms[k] <= largest_term[parent]) continue;
      largest_term[parent] = terms[k];
      largest_facet[parent] = static_cast<std::uint32_t>(k / level.faces.width);
    }
    higher.corners.reserve(faces * (dimension + 1));
    for (std::size_t face = 0; face < faces; ++face) {
      higher.corners.push_back(higher.faces.base[face]);
      const auto below = level.corners.begin() + static_cast<std::ptrdiff_t>(largest_facet[face] * dimension);
      higher.corners.insert(higher.corners.end(), below, below + static_cast<std::ptrdiff_t>(dimension));
    }
    return higher;
  }

  const FaceLevels& levels_;
  const std::vector<double>& vertices_;
  const std::vector<double>& normals_;
  std::size_t rank_;
  bool is_closed_ = true;
};

/// By signed sums, where these are cheap; elsewhere they are for polytopes with folded faces.
PolytopeMeasure measure_faces(std::size_t rank, const PlanePolytope& polytope, const FaceLevels& levels,
                              const std::vector<double>& vertices, const std::vector<double>& normals) {
  constexpr std::size_t kSignedRank = 9;
  const bool prefers_signs = rank >= 2 && rank <= kSignedRank;  // a dual simplex of one point has no order
  if (prefers_signs) {
    if (const auto measure = measure_signed(rank, polytope, levels, vertices, normals)) return *measure;
  }
  Measurer measurer(levels, vertices, normals, rank);
  const PolytopeMeasure measure = measurer.measure();
  if (measure.status != HullStatus::kComplete || measurer.is_closed()) return measure;
  const PolytopeMeasure none{HullStatus::kMemoryLimit, 0.0, 0.0};
  if (prefers_signs) return none;
  return measure_signed(rank, polytope, levels, vertices, normals).value_or(none);
}

/// Simplices a vertex from which on the hull of the vertices is tried first.
constexpr std::size_t kSimplicesOfVertex = 4;

/// Of the hull of the vertices, when that is no larger than the dual hull.
std::optional<PolytopeMeasure> measure_by_hull(std::size_t rank, const PlanePolytope& polytope,
                                               const HullOptions& limits) {
  const std::size_t vertices = polytope.vertex_count(rank), simplices = polytope.vertex_of.size();
  if (rank < 2 || simplices < kSimplicesOfVertex * vertices) return std::nullopt;
  HullOptions options;
  options.limits = limits.limits;
  options.limits.max_facets = simplices;
  options.threads = limits.threads;
  options.stop = limits.stop;
  const Hull hull = convex_hull(PointView::row_major(polytope.vertices.data(), vertices, rank), options);
  if (hull.status != HullStatus::kComplete || hull.rank < rank) return std::nullopt;
  return PolytopeMeasure{HullStatus::kComplete, hull.volume, hull.area};
}

}  // namespace

double bytes_of_measure(std::size_t rank, std::size_t simplices) {
  constexpr double kBytesOfFace = 20.0;
  return std::ldexp(kBytesOfFace, static_cast<int>(rank)) * static_cast<double>(simplices);
}

PolytopeMeasure measure_polytope(const PlanesAboutOrigin& planes, const PlanePolytope& polytope,
                                 const HullOptions& options, bool wants_area) {
  NDHULL_CHECK(polytope.bounded);
  const WorkEnd end(options.limits.max_seconds, options.stop);
  if (const auto measure = measure_by_hull(planes.rank, polytope, options)) return *measure;
  const double bytes = bytes_of_measure(planes.rank, polytope.vertex_of.size());
  if (options.limits.max_memory_bytes > 0 && bytes > static_cast<double>(options.limits.max_memory_bytes))
    return {HullStatus::kMemoryLimit, 0.0, 0.0};
  const FaceLevels levels(planes, polytope, end);
  const auto measured = [&](const std::vector<double>& vertices, const std::vector<double>& normals) {
    return measure_faces(planes.rank, polytope, levels, vertices, normals);
  };
  const EvenVertices even(planes.rank, polytope.vertices);
  if (!even.is_thin()) return measured(polytope.vertices, planes.normals);
  // The large facets of a plate lose digits by the map: its rounding is that of the plate's thickness.
  PolytopeMeasure measure{HullStatus::kComplete, 0.0, 0.0};
  if (wants_area) measure = measured(polytope.vertices, planes.normals);
  if (measure.status != HullStatus::kComplete) return measure;
  const PolytopeMeasure of_even = measured(even.values(), even.normals(planes.normals));
  return {of_even.status, even.volume(of_even.volume), measure.area};
}

}  // namespace ndhull
