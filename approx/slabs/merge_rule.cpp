#include "approx/slabs/merge_rule.h"

#include <atomic>
#include <cmath>
#include <limits>

namespace ndhull {
namespace {

double dot(const double* a, const double* b, std::size_t rank) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rank; ++k) sum += a[k] * b[k];
  return sum;
}

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double load(double& entry) { return std::atomic_ref<double>(entry).load(std::memory_order_relaxed); }
void store(double& entry, double value) {
  std::atomic_ref<double>(entry).store(value, std::memory_order_relaxed);
}

}  // namespace

bool MergeRule::wants(const FittedPlane& a, std::span<const double> centrum_a, const FittedPlane& b,
                      std::span<const double> centrum_b) const {
  const std::size_t rank = centrum_a.size();
  if (max_cosine <= 1.0 && dot(a.normal.data(), b.normal.data(), rank) > max_cosine) return true;
  if (centrum_radius <= 0.0) return false;
  return dot(b.normal.data(), centrum_a.data(), rank) - b.middle() > -centrum_radius ||
         dot(a.normal.data(), centrum_b.data(), rank) - a.middle() > -centrum_radius;
}

std::vector<double> centrum_on_plane(const WidthSpace& space, std::span<const std::uint32_t> vertices,
                                     const FittedPlane& plane) {
  const std::size_t rank = space.rank();
  std::vector<double> centrum(rank, 0.0);
  for (const std::uint32_t vertex : vertices) {
    for (std::size_t k = 0; k < rank; ++k) centrum[k] += space.row(vertex)[k];
  }
  for (double& entry : centrum) entry /= static_cast<double>(vertices.size());
  const double rise = plane.middle() - dot(centrum.data(), plane.normal.data(), rank);
  for (std::size_t k = 0; k < rank; ++k) centrum[k] += rise * plane.normal[k];
  return centrum;
}

SimplexRule::SimplexRule(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
                         bool is_convex)
    : complex_(complex),
      space_(space),
      rule_(rule),
      is_convex_(is_convex),
      distances_(complex.row_count, kUnknown),
      rises_(complex.row_count, is_convex ? 0.0 : kUnknown) {}

void SimplexRule::set_plane(SimplexId seed, const FittedPlane& plane, RulePlane& compared) const {
  const std::size_t rank = space_.rank();
  std::vector<std::uint32_t> rows;
  for (const PointId id : complex_.vertices(seed)) rows.push_back(space_.row_of(id));
  const std::vector<double> centrum = centrum_on_plane(space_, rows, plane);
  compared.middle = plane.middle();
  compared.facing.resize(rank);
  compared.centrum.resize(rank);
  space_.facing(plane.normal.data(), compared.facing.data());
  space_.facing(centrum.data(), compared.centrum.data());
}

double SimplexRule::distance_of(SimplexId simplex) const {
  double distance = load(distances_[simplex.value]);
  if (std::isnan(distance)) {
    distance = space_.distance_of(complex_.plane(simplex));
    store(distances_[simplex.value], distance);
  }
  return distance;
}

void SimplexRule::learn_height(SimplexId simplex, double height) const {
  if (!is_convex_) store(rises_[simplex.value], 0.5 * std::max(0.0, height - distance_of(simplex)));
}

double SimplexRule::rise_of(SimplexId simplex, PlaneFitWork& work) const {
  const double rise = load(rises_[simplex.value]);
  if (!std::isnan(rise)) return rise;
  std::vector<double> normal(space_.rank());
  space_.normal_of(complex_.plane(simplex), normal.data());
  const std::uint32_t vertex[] = {space_.row_of(complex_.vertices(simplex)[0])};
  learn_height(simplex, measure_plane(space_, normal, vertex, work).height);
  return load(rises_[simplex.value]);
}

bool SimplexRule::wants(SimplexId simplex, double mean_dot, const RulePlane& plane,
                        PlaneFitWork& work) const {
  const std::size_t rank = space_.rank();
  const double rise = rise_of(simplex, work);
  const bool is_for_cosine = rule_.max_cosine <= 1.0;
  double along = mean_dot - plane.middle;  // of the simplex's middle on its own plane
  if (rise > 0.0 || is_for_cosine) {
    const double cosine =
        distance_of(simplex) * dot(plane.facing.data(), complex_.plane(simplex).data(), rank);
    if (is_for_cosine && cosine > rule_.max_cosine) return true;
    along += rise * cosine;
  }
  if (rule_.centrum_radius <= 0.0) return false;
  if (along > -rule_.centrum_radius) return true;
  const double above = dot(plane.centrum.data(), complex_.plane(simplex).data(), rank) - 1.0;
  return distance_of(simplex) * above - rise > -rule_.centrum_radius;
}

}  // namespace ndhull
