#include "approx/slabs/star_hull.h"

#include <Eigen/Core>
#include <algorithm>
#include <thread>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/far_reach.h"
#include "approx/geometry/hull_distance.h"
#include "approx/reduction/kept_points.h"
#include "approx/slabs/width_space.h"
#include "core/growth/vertex_stars.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

/// A vertex that is nearer than this to the hull of the others is left out too: seen from it, others would
/// lie in directions that rounding decides. [ratio of the size]
constexpr double kClearVertex = 1e-7;

/// Which points are vertices, and in which direction each is furthest.
struct ChosenVertices {
  std::vector<std::uint32_t> rows;    // of the space that they were chosen in
  std::vector<double> normals;        // rows x rank
  std::vector<std::uint32_t> others;  // rows that may be outside
  double distance = 0.0;              // of the furthest, proven
};

bool bounds_region(const RowFacets& facets, std::size_t rank) {
  if (facets.count() <= rank) return false;
  return facets.count() > kSurelyBounded ||
         (find_open_direction(facets.planes, rank).bounded && !find_far_reach(facets.planes, rank));
}

std::vector<PointId> corners_of(const CertifiedGrowth& growth, const SimplicialComplex& complex) {
  const std::vector<bool> is_corner = find_corners(complex, 0, complex.row_count, growth.input().rows);
  std::vector<PointId> corners;
  for (std::uint32_t id = 0; id < is_corner.size(); ++id)
    if (is_corner[id]) corners.push_back(PointId{id});
  return corners;
}

Eigen::MatrixXd columns_of(const WidthSpace& space, std::span<const std::uint32_t> rows) {
  Eigen::MatrixXd columns(static_cast<Index>(space.rank()), static_cast<Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    columns.col(static_cast<Index>(i)) =
        Eigen::Map<const Eigen::VectorXd>(space.row(rows[i]), columns.rows());
  return columns;
}

/// Of each of these rows the gap between it and the hull of the others of them.
std::vector<HullDistance> distances_from_others(const WidthSpace& space,
                                                std::span<const std::uint32_t> rows) {
  const Eigen::MatrixXd all = columns_of(space, rows);
  std::vector<HullDistance> found(rows.size());
  constexpr std::size_t kAtATime = 16;
  for_each_block(rows.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
    Eigen::MatrixXd others = all.rightCols(all.cols() - 1);  // but for column 0
    for (std::size_t i = 0; i < end; ++i) {
      if (i >= begin) found[i] = hull_distance(others, all.col(static_cast<Index>(i)));
      if (static_cast<Index>(i) < others.cols())
        others.col(static_cast<Index>(i)) = all.col(static_cast<Index>(i));
    }
  });
  return found;
}

/// Vertices until all points of the space are less than `enough` from their hull; those of the space come
/// first. Nothing where vertices are not clearly apart.
std::optional<ChosenVertices> choose_vertices(const WidthSpace& space, double enough, std::stop_token stop) {
  const std::size_t rank = space.rank(), count = space.table().count();
  std::vector<PointId> ids(count);
  for (std::uint32_t row = 0; row < count; ++row) ids[row] = PointId{row};
  const PointView points = PointView::row_major(space.row(0), count, rank);
  const KeptPoints kept = keep_points(points, ids, std::vector<double>(rank),
                                      {.count = kMostStarVertices,
                                       .given = space.vertex_count(),
                                       .enough = enough,
                                       .measures_left = true,
                                       .stop = std::move(stop)});
  ChosenVertices chosen;
  chosen.distance = *std::max_element(kept.left.begin(), kept.left.end());
  if (chosen.distance > enough) return std::nullopt;  // too many, or stopped
  // The last first: they have the fewest simplices, and rows with the same first vertices are searched one
  // after the other.
  std::vector<std::uint32_t> rows;
  std::vector<bool> is_kept(count);
  for (const PointId point : kept.points) {
    rows.push_back(point.value);
    is_kept[point.value] = true;
  }
  std::reverse(rows.begin(), rows.end());
  double size = 0.0;
  for (const std::uint32_t row : rows)
    size = std::max(size, Eigen::Map<const Eigen::VectorXd>(space.row(row), static_cast<Index>(rank)).norm());
  const std::vector<HullDistance> gaps = distances_from_others(space, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (gaps[i].lower < kClearVertex * size) {
      chosen.others.push_back(rows[i]);
      continue;
    }
    chosen.rows.push_back(rows[i]);
    for (std::size_t k = 0; k < rank; ++k) chosen.normals.push_back(-gaps[i].gap[static_cast<Index>(k)]);
  }
  if (chosen.rows.size() <= rank) return std::nullopt;
  // Those left out because each is near another that was left out as well.
  const Eigen::MatrixXd columns = columns_of(space, chosen.rows);
  const double room = 1e-3 * enough;
  for (const std::uint32_t row : chosen.others) {
    const Eigen::Map<const Eigen::VectorXd> point(space.row(row), columns.rows());
    if (hull_distance(columns, point).upper > room) return std::nullopt;
  }
  if (!chosen.others.empty()) chosen.distance += room;
  for (std::uint32_t row = 0; row < count; ++row)
    if (!is_kept[row] && kept.left[row] > kClearVertex * size) chosen.others.push_back(row);
  return chosen;
}

}  // namespace

std::optional<StarHull> find_star_hull(CertifiedGrowth& growth, std::span<const double> factor,
                                       std::span<const double> area_factor, double width, double enough) {
  const GrowthWork& work = growth.work();
  if (work.rank < 3 || !work.shifted_points.empty()) return std::nullopt;
  const std::vector<double> own_factor(factor.begin(), factor.end());
  const auto make_space = [&](std::span<const PointId> vertices, std::span<const PointId> others) {
    return WidthSpace(work.rank, own_factor, growth.coordinates(), work.point_count, vertices, others);
  };
  growth.locate_left_out(width);
  Clock::time_point begin = Clock::now();
  const auto lap = [&](std::string_view name) {
    growth.detail(name, begin);
    begin = Clock::now();
  };
  StarHull hull;
  std::vector<double> normals;
  std::vector<PointId> others;
  {
    std::vector<PointId> outside;
    for (const LocatedPoint& point : growth.left_out()) outside.push_back(point.point);
    // What is known of the nearest point to each: three lists, and the coordinates in two shapes.
    const std::uint64_t bytes = outside.size() * (240 + 56 * work.rank);
    if (bytes > growth.bytes_left() / 2) return std::nullopt;
    const WidthSpace first = make_space(corners_of(growth, work.complex), outside);
    std::optional<ChosenVertices> chosen = choose_vertices(first, enough, growth.options().stop);
    if (!chosen) return std::nullopt;
    for (const std::uint32_t row : chosen->rows) hull.vertices.push_back(first.point_of(row));
    for (const std::uint32_t row : chosen->others) others.push_back(first.point_of(row));
    normals = std::move(chosen->normals);
    hull.distance = chosen->distance;
  }
  const WidthSpace space = make_space(hull.vertices, others);
  lap("choosing vertices");
  StarOptions options;
  const std::uint64_t row_bytes = star_row_bytes(work.rank), left = growth.bytes_left();
  if (left != UINT64_MAX) {
    // Two threads may have half of it in the tables of stars, while there are few rows or the stars are
    // small.
    options.most_table_rows = left / 4 / (16 * work.rank + 64);
    options.most_rows = std::min(options.most_rows, left / 5 * 3 / row_bytes);
  }
  const std::stop_token& stop = growth.options().stop;
  const auto bytes_of = [&](std::uint64_t simplices) { return simplices * row_bytes; };
  const std::thread::id caller = std::this_thread::get_id();
  options.gives_up = [&](std::size_t stars, std::uint64_t simplices) {
    if (std::this_thread::get_id() == caller)
      growth.tell(Phase::kGrowth, hull.vertices.size() - stars, hull.distance, simplices,
                  bytes_of(simplices));
    return stop.stop_requested();
  };
  const std::optional<SimplexRows> rows =
      grow_stars(work.rank, {space.row(0), hull.vertices.size() * work.rank}, normals, options);
  lap("stars");
  if (!rows) return std::nullopt;
  hull.simplices = rows->count();
  const std::uint64_t facet_bytes = star_facet_bytes(work.rank);
  const std::uint64_t most_facets =
      left == UINT64_MAX ? left : (left - bytes_of(hull.simplices)) / facet_bytes;
  const auto gives_up = [&](std::uint64_t simplices_left, std::uint64_t found) {
    growth.tell(Phase::kMerge, 0, hull.distance, simplices_left,
                bytes_of(hull.simplices) + found * facet_bytes);
    return found > most_facets || stop.stop_requested();
  };
  std::optional<RowFacets> facets =
      cover_rows(*rows, space, growth.coordinates(), area_factor, width, gives_up);
  lap("slabs of rows");
  if (!facets || !bounds_region(*facets, work.rank)) return std::nullopt;
  hull.facets = std::move(*facets);
  return hull;
}

}  // namespace ndhull
