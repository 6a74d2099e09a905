#include "approx/merge_rule.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "core/blocks.h"

namespace ndhull {
namespace {

double dot(const double* a, const double* b, std::size_t rank) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rank; ++k) sum += a[k] * b[k];
  return sum;
}

bool is_asked_for(const MergeRule& rule, std::size_t rank, const double* normal_a, double height_a,
                  const double* centrum_a, const double* normal_b, double height_b, const double* centrum_b) {
  if (rule.max_cosine <= 1.0 && dot(normal_a, normal_b, rank) > rule.max_cosine) return true;
  if (rule.centrum_radius <= 0.0) return false;
  return dot(normal_b, centrum_a, rank) - height_b > -rule.centrum_radius ||
         dot(normal_a, centrum_b, rank) - height_a > -rule.centrum_radius;
}

}  // namespace

bool MergeRule::wants(const FittedPlane& a, std::span<const double> centrum_a, const FittedPlane& b,
                      std::span<const double> centrum_b) const {
  return is_asked_for(*this, centrum_a.size(), a.normal.data(), a.middle(), centrum_a.data(), b.normal.data(),
                      b.middle(), centrum_b.data());
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

SimplexRule::SimplexRule(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule)
    : complex_(complex),
      space_(space),
      rule_(rule),
      normals_(complex.row_count * complex.rank),
      centrums_(complex.row_count * complex.rank),
      heights_(complex.row_count) {
  const std::size_t rank = complex.rank;
  tbb::enumerable_thread_specific<PlaneFitWork> work;
  for_each_block(complex.row_count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row != end; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      const SimplexId simplex{static_cast<std::uint32_t>(row)};
      std::vector<double> normal(rank);
      space.normal_of(complex.plane(simplex), normal.data());
      const std::uint32_t vertex[] = {space.row_of(complex.vertices(simplex)[0])};
      const FittedPlane plane = measure_plane(space, normal, vertex, work.local());
      heights_[row] = plane.middle();
      const std::vector<double> centrum = centrum_on(simplex, plane);
      std::copy(normal.begin(), normal.end(), normals_.begin() + static_cast<std::ptrdiff_t>(row * rank));
      std::copy(centrum.begin(), centrum.end(), centrums_.begin() + static_cast<std::ptrdiff_t>(row * rank));
    }
  });
}

std::vector<double> SimplexRule::centrum_on(SimplexId simplex, const FittedPlane& plane) const {
  std::vector<std::uint32_t> rows;
  for (const PointId id : complex_.vertices(simplex)) rows.push_back(space_.row_of(id));
  return centrum_on_plane(space_, rows, plane);
}

bool SimplexRule::wants(SimplexId simplex, const FittedPlane& plane, std::span<const double> centrum) const {
  const std::size_t rank = space_.rank(), row = simplex.value;
  return is_asked_for(rule_, rank, normals_.data() + row * rank, heights_[row], centrums_.data() + row * rank,
                      plane.normal.data(), plane.middle(), centrum.data());
}

}  // namespace ndhull
