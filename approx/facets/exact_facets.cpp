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

/// The part of the ridges that are flat, of some simplices all over the rows; 0 where less than a quarter of the
/// vertices was shifted. Planes are those of growth, which shifts have turned, of thin simplices by many shifts:
/// what is taken for flat is therefore more than that.
double share_of_flat_ridges(const GrowthWork& work, const double* points) {
  if (4 * work.shifted_points.size() < work.counters.insertions) return 0.0;
  constexpr std::size_t kSimplices = 256;
  constexpr double kShifts = 1000.0;
  const SimplicialComplex& complex = work.complex;
  const std::size_t step = std::max<std::size_t>(1, complex.row_count / kSimplices);
  std::size_t ridges = 0, flat = 0;
  for (std::size_t row = 0; row < complex.row_count; row += step) {
    if (complex.state[row] != SimplexState::kLive) continue;
    const SimplexId simplex{static_cast<std::uint32_t>(row)};
    const auto plane = complex.plane(simplex);
    for (const SimplexId neighbour : complex.neighbours(simplex)) {
      const PointId opposite = vertex_opposite(complex, neighbour.value, simplex.value);
      const double* point = points + std::size_t{opposite.value} * complex.rank;
      const double gauge = std::inner_product(plane.begin(), plane.end(), point, -1.0);
      ++ridges;
      flat += std::abs(gauge) <= kShifts * work.options.shift ? 1 : 0;
    }
  }
  return ridges == 0 ? 0.0 : static_cast<double>(flat) / static_cast<double>(ridges);
}

}  // namespace

bool shares_planes(const GrowthWork& work, const double* points) {
  constexpr double kMany = 1.0 / 8.0;
  return share_of_flat_ridges(work, points) >= kMany;
}

double fewest_exact_facets(const GrowthWork& work, const double* points) {
  const auto simplices = static_cast<double>(work.complex.row_count - work.free_count);
  // Each ridge is that of two simplices.
  const double flat = share_of_flat_ridges(work, points) * static_cast<double>(work.rank) / 2.0;
  return simplices * std::max(0.0, 1.0 - flat);
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
  const auto is_alone = [](std::uint32_t cluster) { return cluster == FacetId::kNone; };
  // Without a ridge in a plane there is no table.
  if (clusters.cluster_of.empty()) return complex.row_count;
  return clusters.count + static_cast<std::uint64_t>(std::ranges::count_if(clusters.cluster_of, is_alone));
}

}  // namespace ndhull
