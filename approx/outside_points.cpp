#include "approx/outside_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace ndhull {
namespace {

/// A point that is less than W above the simplex it lies over may be this much more above another one. Taking
/// those in as well costs 2.3 times the facets on 10^5 sphere points in 8-d with W 0.3.
constexpr double kOutsideSlack = 1.045;

}  // namespace

bool put_back_above(CertifiedGrowth& growth, double width) {
  const SimplicialComplex& complex = growth.work().complex;
  const std::size_t rank = complex.rank;
  struct Height {  // of a simplex's plane above the centre: a gauge times this is a distance
    double height;
    std::uint32_t row;
  };
  std::vector<Height> heights;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] == SimplexState::kLive)
      heights.push_back({height_above(growth.work(), row, 1.0), row});
  }
  std::sort(heights.begin(), heights.end(), [](const Height& a, const Height& b) {
    return a.height != b.height ? a.height > b.height : a.row < b.row;
  });
  std::vector<double> planes(heights.size() * rank);
  for (std::size_t i = 0; i < heights.size(); ++i)
    std::copy_n(complex.plane(SimplexId{heights[i].row}).data(), rank, planes.data() + i * rank);
  std::vector<LocatedPoint> above(growth.left_out().size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, above.size(), 256), [&](const auto& range) {
    for (std::size_t p = range.begin(); p != range.end(); ++p) {
      const LocatedPoint& point = growth.left_out()[p];
      const double* y = growth.coordinates() + std::size_t{point.point.value} * rank;
      double best = width;
      // No plane sees the point at a larger gauge than the one it was located over.
      for (std::size_t i = 0; i < heights.size() && heights[i].height * point.gauge > best; ++i) {
        double gauge = -1.0;
        for (std::size_t k = 0; k < rank; ++k) gauge += planes[i * rank + k] * y[k];
        if (gauge * heights[i].height <= best) continue;
        best = gauge * heights[i].height;
        above[p] = {point.point, SimplexId{heights[i].row}, gauge};
      }
    }
  });
  std::erase_if(above, [](const LocatedPoint& point) { return !point.point.valid(); });
  if (above.empty()) return false;
  // The furthest alone: the simplices that they bring may well be all that the others need.
  double worst = 0.0;
  const auto height = [&](const LocatedPoint& point) {
    return height_above(growth.work(), point.simplex.value, point.gauge);
  };
  for (const LocatedPoint& point : above) worst = std::max(worst, height(point));
  if (worst <= kOutsideSlack * width) return false;
  std::erase_if(above, [&](const LocatedPoint& point) { return height(point) < 0.5 * (width + worst); });
  growth.put_back(above);
  return true;
}

}  // namespace ndhull
