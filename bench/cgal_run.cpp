// CGAL's dD Triangulation (GPL, bench only): the hull is the infinite cells of a triangulation of all points.
#include <CGAL/Epick_d.h>
#include <CGAL/Triangulation.h>
#include <fmt/format.h>

#include <stdexcept>

#include "bench/hull_run.h"

namespace ndhull {
namespace {

template <int kDimension>
HullRun triangulate(const PointSet& points) {
  using Kernel = CGAL::Epick_d<CGAL::Dimension_tag<kDimension>>;
  using Triangulation = CGAL::Triangulation<Kernel>;
  std::vector<typename Kernel::Point_d> rows;
  for (std::size_t row = 0; row < points.rows(); ++row) {
    rows.emplace_back(kDimension, points.row(row).begin(), points.row(row).end());
  }
  HullRun run;
  run.resident_bytes = resident_bytes();
  const Stopwatch watch;
  Triangulation triangulation(kDimension);
  triangulation.insert(rows.begin(), rows.end());
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.peak_bytes = peak_resident_bytes();
  for (auto cell = triangulation.full_cells_begin(); cell != triangulation.full_cells_end(); ++cell) {
    run.facets += triangulation.is_infinite(cell) ? 1U : 0U;
  }
  run.detail = {{"cells", triangulation.number_of_full_cells()}};
  return run;
}

}  // namespace

HullRun run_cgal(const BenchInput& input) {
  const PointSet& points = input.qhull_points();
  switch (points.dimension) {
    case 3: return triangulate<3>(points);
    case 4: return triangulate<4>(points);
    case 5: return triangulate<5>(points);
    case 6: return triangulate<6>(points);
    case 7: return triangulate<7>(points);
    default:
      throw std::runtime_error(fmt::format("CGAL is compared in 3-d to 7-d, not in {}-d", points.dimension));
  }
}

}  // namespace ndhull
