#include "approx/facets/exact_facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/facets/coplanar_merge.h"
#include "approx/facets/sliver_merge.h"
#include "core/complex/determinants.h"

namespace ndhull {
namespace {

/// What compact needs of it.
SimplicialComplex copy_of(const SimplicialComplex& complex) {
  const std::size_t rows = complex.row_count, rank = complex.rank;
  SimplicialComplex copy(rank, rows);
  copy.row_count = rows;
  std::copy_n(complex.planes.data(), rows * rank, copy.planes.data());
  std::copy_n(complex.topology.data(), rows * 2 * rank, copy.topology.data());
  std::copy_n(complex.state.data(), rows, copy.state.data());
  return copy;
}

void turn_outwards(std::span<double> determinants) {
  double sum = 0.0;
  for (const double determinant : determinants) sum += determinant;
  if (sum >= 0.0) return;
  for (double& determinant : determinants) determinant = -determinant;
}

/// A quarter of the vertices was shifted.
bool has_many_shifted(const GrowthWork& work) {
  return 4 * work.shifted_points.size() >= work.counters.insertions;
}

/// Simplices all over the rows, and which of their neighbours are in a plane with them. Planes are those of
/// growth, which shifts have turned, of thin simplices by many shifts: what is taken for flat is therefore
/// more than that.
class FlatSample {
 public:
  FlatSample(const GrowthWork& work, const double* points)
      : complex_(work.complex), points_(points), tolerance_(kShifts * work.options.shift) {
    const std::size_t step = complex_.row_count / kSimplices + 1;
    for (std::size_t row = 0; row < complex_.row_count; row += step)
      if (complex_.state[row] == SimplexState::kLive) rows_.push_back(static_cast<std::uint32_t>(row));
  }

  /// The part of their ridges that are flat.
  double share_of_flat_ridges() const {
    std::size_t flat = 0;
    for (const std::uint32_t row : rows_)
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{row}))
        if (is_in_plane(row, row, neighbour.value)) ++flat;
    return static_cast<double>(flat) / static_cast<double>(rows_.size() * complex_.rank);
  }

  /// Is the mean of one over the size of a simplex' facet clearly above this? Larger facets count for
  /// nothing.
  bool has_mean_above(double bound) {
    constexpr std::size_t kLarge = 64;
    constexpr double kErrors = 3.0;
    seen_by_.assign(complex_.row_count, FacetId::kNone);
    double sum = 0.0, squares = 0.0;
    for (const std::uint32_t row : rows_) {
      const std::size_t size = facet_size(row, kLarge);
      const double part = size < kLarge ? 1.0 / static_cast<double>(size) : 0.0;
      sum += part;
      squares += part * part;
    }
    const auto count = static_cast<double>(rows_.size());
    const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean);
    return mean - kErrors * std::sqrt(variance / count) > bound;
  }

 private:
  static constexpr std::size_t kSimplices = 256;
  static constexpr double kShifts = 1000.0;

  /// Is the vertex of `neighbour` that is opposite `simplex` in the plane of `seed`?
  bool is_in_plane(std::uint32_t seed, std::uint32_t simplex, std::uint32_t neighbour) const {
    const auto plane = complex_.plane(SimplexId{seed});
    const PointId opposite = vertex_opposite(complex_, neighbour, simplex);
    const double* point = points_ + std::size_t{opposite.value} * complex_.rank;
    return std::abs(std::inner_product(plane.begin(), plane.end(), point, -1.0)) <= tolerance_;
  }

  /// Simplices that can be reached from this in its plane, `most` or about so many.
  std::size_t facet_size(std::uint32_t seed, std::size_t most) {
    facet_.assign(1, seed);
    seen_by_[seed] = seed;
    for (std::size_t i = 0; i < facet_.size() && facet_.size() < most; ++i) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{facet_[i]})) {
        if (seen_by_[neighbour.value] == seed || !is_in_plane(seed, facet_[i], neighbour.value)) continue;
        seen_by_[neighbour.value] = seed;
        facet_.push_back(neighbour.value);
      }
    }
    return facet_.size();
  }

  const SimplicialComplex& complex_;
  const double* points_;
  double tolerance_;
  std::vector<std::uint32_t> rows_, facet_, seen_by_;
};

}  // namespace

bool shares_planes(const GrowthWork& work, const double* points) {
  constexpr double kMany = 1.0 / 8.0;
  return has_many_shifted(work) && FlatSample(work, points).share_of_flat_ridges() >= kMany;
}

bool may_be_few_facets(const GrowthWork& work, const double* points, std::uint64_t most) {
  const std::size_t simplices = work.complex.row_count - work.free_count;
  if (!has_many_shifted(work) || simplices <= most) return simplices <= most;
  return !FlatSample(work, points).has_mean_above(static_cast<double>(most) / static_cast<double>(simplices));
}

std::vector<std::uint8_t> find_shifted(const GrowthWork& work) {
  std::vector<std::uint8_t> is_shifted(work.shifted_points.empty() ? 0 : work.point_count);
  for (const std::uint32_t id : work.shifted_points) is_shifted[id] = 1;
  return is_shifted;
}

void solve_outwards(SimplicialComplex& complex, const double* points,
                    std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  if (complex.rank == 1) {
    for (std::size_t row = 0; row < complex.row_count; ++row)
      determinants[row] = std::abs(1.0 / complex.planes[row]);
    return;
  }
  solve_simplices(complex, points, is_shifted, determinants);
  turn_outwards(determinants);
}

void find_outwards(SimplicialComplex& complex, const double* points, std::span<double> determinants,
                   const BlockWork& also) {
  if (!find_determinants(complex, points, determinants, also))
    return solve_outwards(complex, points, {}, determinants);
  turn_outwards(determinants);
}

std::uint64_t count_exact_facets(const GrowthWork& work, const double* points) {
  const std::vector<std::uint8_t> is_shifted = find_shifted(work);
  if (is_shifted.empty()) return work.complex.row_count - work.free_count;
  SimplicialComplex complex = copy_of(work.complex);
  compact(complex);
  std::vector<double> determinants(complex.row_count);
  solve_outwards(complex, points, is_shifted, determinants);
  const FacetClusters clusters =
      merge_coplanar(complex, points, is_shifted, determinants, kShiftsInPlane * work.options.shift);
  return clusters.facets_of(complex.row_count);
}

}  // namespace ndhull
