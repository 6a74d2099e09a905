#include "approx/geometry/far_reach.h"

#include <cmath>
#include <numeric>

#include "core/linear/column_simplex.h"
#include "core/linear/column_table.h"

namespace ndhull {
namespace {

double norm_of(std::span<const double> vector) {
  return std::sqrt(std::inner_product(vector.begin(), vector.end(), vector.begin(), 0.0));
}

std::vector<double> unit_of(std::span<const double> vector) {
  std::vector<double> result(vector.begin(), vector.end());
  for (double& entry : result) entry /= norm_of(vector);
  return result;
}

}  // namespace

std::optional<std::vector<double>> find_far_reach(std::span<const double> planes, std::size_t rank) {
  constexpr double kFar = 1e3;
  constexpr double kSteps = 0x1p30;  // what differs by rounding alone is equal then: the programs would stall
  ColumnTable normals(rank, planes.size() / rank);
  for (std::size_t plane = 0; plane < normals.count(); ++plane) {
    const std::span<const double> dual = planes.subspan(plane * rank, rank);
    std::vector<double> normal = unit_of(dual);
    for (double& entry : normal) entry = std::nearbyint(entry * kSteps) / kSteps;
    normals.set(plane, normal, 1.0 / norm_of(dual));
  }
  // Weights with which normals add up to an axis: the least sum of weighted distances is the region's reach.
  std::optional<std::vector<double>> furthest;
  double most = kFar;
  for (std::size_t side = 0; side < 2 * rank; ++side) {
    std::vector<double> axis(rank, 0.0);
    axis[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
    ColumnSimplex lp(axis);
    const LpResult reach = solve_lp(lp, [&](const LpQuery& query) { return normals.price(query); });
    if (reach.status == LpStatus::kInfeasible) return unit_of(reach.duals);
    const bool has_stalled = reach.status == LpStatus::kStalled;
    if (has_stalled && reach.infeasibility > 0.0) return axis;  // rounding is all that closes it
    if (reach.objective <= most) continue;
    most = reach.objective;
    furthest = unit_of(reach.duals);
  }
  return furthest;
}

}  // namespace ndhull
