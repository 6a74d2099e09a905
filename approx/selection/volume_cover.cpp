#include "approx/selection/volume_cover.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/selection/plane_candidates.h"
#include "approx/selection/volume_rays.h"
#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Eigen::Index;

/// The exact facets: their dual planes and the volumes of the cones below them.
struct ExactFacets {
  RowMatrix planes;
  std::vector<double> volumes;
};

ExactFacets list_facets(const SimplicialComplex& complex, std::span<const double> determinants,
                        const FacetClusters& exact) {
  const auto rank = static_cast<Index>(complex.rank);
  const auto cluster_of = [&exact](std::size_t row) {
    return exact.count == 0 ? kNone : exact.cluster_of[row];
  };
  ExactFacets facets;
  facets.volumes.assign(exact.count, 0.0);
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    if (cluster_of(row) != kNone) {
      facets.volumes[cluster_of(row)] += determinants[row];
    } else {
      facets.volumes.push_back(determinants[row]);
    }
  }
  facets.planes.resize(static_cast<Index>(facets.volumes.size()), rank);
  Index next = static_cast<Index>(exact.count);
  for (Index cluster = 0; cluster < next; ++cluster)
    facets.planes.row(cluster) = Eigen::Map<const Eigen::RowVectorXd>(
        exact.plane_of(complex, static_cast<std::uint32_t>(cluster)), rank);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (cluster_of(row) != kNone) continue;
    facets.planes.row(next++) =
        Eigen::Map<const Eigen::RowVectorXd>(complex.plane(SimplexId{row}).data(), rank);
  }
  return facets;
}

/// Facets, the largest first in coordinates where planes are spread evenly: the first `most` of them, or all.
std::vector<std::uint32_t> candidates_of(const ExactFacets& facets, const Eigen::MatrixXd& even,
                                         std::size_t most) {
  std::vector<double> areas(facets.volumes.size());
  for_each_block(areas.size(), 1024, [&](std::size_t begin, std::size_t end) {
    const RowMatrix planes =
        facets.planes.middleRows(static_cast<Index>(begin), static_cast<Index>(end - begin)) * even;
    for (std::size_t row = begin; row != end; ++row)
      areas[row] = facets.volumes[row] * planes.row(static_cast<Index>(row - begin)).norm();
  });
  std::vector<std::uint32_t> ids(areas.size());
  std::iota(ids.begin(), ids.end(), 0U);
  const auto is_larger = [&areas](std::uint32_t a, std::uint32_t b) {
    return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
  };
  if (ids.size() > most) {
    std::nth_element(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(most), ids.end(), is_larger);
    ids.resize(most);
  }
  std::sort(ids.begin(), ids.end(), is_larger);
  return ids;
}

RowMatrix rows_of(const RowMatrix& all, std::span<const std::uint32_t> ids) {
  RowMatrix rows(static_cast<Index>(ids.size()), all.cols());
  for (std::size_t k = 0; k < ids.size(); ++k) rows.row(static_cast<Index>(k)) = all.row(ids[k]);
  return rows;
}

std::span<const double> values_of(const RowMatrix& rows) {
  return {rows.data(), static_cast<std::size_t>(rows.size())};
}

/// Chosen rows of facets.planes.
RowMatrix choose_planes(const ExactFacets& facets, std::uint64_t count, const WorkEnd& end) {
  const Eigen::MatrixXd even = even_spread_map(facets.planes);
  const auto rank = static_cast<std::size_t>(even.cols());
  std::vector<std::uint32_t> ids = candidates_of(facets, even, most_candidates(count));
  RowMatrix candidates = rows_of(facets.planes, ids) * even;
  if (ids.size() < facets.volumes.size() && !find_open_direction(values_of(candidates), rank).bounded) {
    ids = candidates_of(facets, even, facets.volumes.size());
    candidates = rows_of(facets.planes, ids) * even;
  }
  const std::vector<std::uint32_t> start = complete_to_bounded(values_of(candidates), rank, {});
  std::vector<std::uint32_t> chosen = choose_by_rays(candidates, start, count, end);
  for (std::uint32_t& row : chosen) row = ids[row];
  std::sort(chosen.begin(), chosen.end());
  return rows_of(facets.planes, chosen);
}

/// The points that are vertices of simplices, numbered anew.
struct Corners {
  std::vector<std::uint32_t> place;  ///< of each point; kNone: no vertex
  RowMatrix points;
};

Corners corners_of(const SimplicialComplex& complex, const double* points) {
  Corners corners;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    for (const PointId id : complex.vertices(SimplexId{row})) {
      if (id.value >= corners.place.size()) corners.place.resize(std::size_t{id.value} + 1, kNone);
      if (corners.place[id.value] != kNone) continue;
      corners.place[id.value] = static_cast<std::uint32_t>(ids.size());
      ids.push_back(id.value);
    }
  }
  const auto rank = static_cast<Index>(complex.rank);
  corners.points.resize(static_cast<Index>(ids.size()), rank);
  for (std::size_t place = 0; place < ids.size(); ++place) {
    corners.points.row(static_cast<Index>(place)) =
        Eigen::Map<const Eigen::RowVectorXd>(points + std::size_t{ids[place]} * complex.rank, rank);
  }
  return corners;
}

/// For each simplex the plane below which its lowest vertex is least deep.
///
/// Cost  a comparison for each plane and each vertex of a simplex; depths are found once for each vertex.
std::vector<std::uint32_t> assign_simplices(const SimplicialComplex& complex, const double* points,
                                            const RowMatrix& planes,
                                            std::span<const double> gradient_factor) {
  constexpr Index kPlanesAtATime = 64;
  const Index rank = planes.cols();
  const Corners corners = corners_of(complex, points);
  const Eigen::Map<const RowMatrix> factor(gradient_factor.data(), rank, rank);
  // Depths in length units: a gauge over the length of its gradient.
  const Eigen::VectorXd lengths = (planes * factor.transpose()).rowwise().norm();
  std::vector<std::uint32_t> plane_of(complex.row_count);
  std::vector<double> least(complex.row_count, HUGE_VAL);
  Eigen::MatrixXd depths;  // of a corner, one after the other
  for (Index first = 0; first < planes.rows(); first += kPlanesAtATime) {
    const Index used = std::min(kPlanesAtATime, planes.rows() - first);
    depths.noalias() = planes.middleRows(first, used) * corners.points.transpose();
    depths = lengths.segment(first, used).cwiseInverse().asDiagonal() * (1.0 - depths.array()).matrix();
    for_each_block(complex.row_count, 1024, [&](std::size_t begin, std::size_t end) {
      Eigen::ArrayXd deepest(used);
      for (std::size_t row = begin; row != end; ++row) {
        deepest.setConstant(-HUGE_VAL);
        for (const PointId id : complex.vertices(SimplexId{static_cast<std::uint32_t>(row)}))
          deepest = deepest.max(depths.col(corners.place[id.value]).array());
        Index plane = 0;
        const double depth = deepest.minCoeff(&plane);
        if (depth >= least[row]) continue;
        least[row] = depth;
        plane_of[row] = static_cast<std::uint32_t>(first + plane);
      }
    });
  }
  return plane_of;
}

}  // namespace

std::optional<VolumeCover> cover_for_volume(const SimplicialComplex& complex, const double* points,
                                            std::span<const double> determinants, const FacetClusters& exact,
                                            std::uint64_t count, std::span<const double> gradient_factor,
                                            const WorkEnd& end) {
  const ExactFacets facets = list_facets(complex, determinants, exact);
  if (facets.volumes.size() <= count) return std::nullopt;
  const RowMatrix planes = choose_planes(facets, count, end);
  const bool is_cut_short = end.is_here();
  if (static_cast<std::uint64_t>(planes.rows()) > count)
    return VolumeCover{.is_bounded = false, .is_cut_short = is_cut_short, .clusters = {}};
  FacetClusters clusters;
  clusters.cluster_of = assign_simplices(complex, points, planes, gradient_factor);
  // A plane that rounding makes the same as another may get no simplex: the other stands for both.
  std::vector<std::uint32_t> number(static_cast<std::size_t>(planes.rows()), kNone);
  for (std::uint32_t& cluster : clusters.cluster_of) {
    std::uint32_t& found = number[cluster];
    if (found == kNone) {
      found = clusters.count++;
      const double* const plane = planes.row(cluster).data();
      clusters.planes.insert(clusters.planes.end(), plane, plane + planes.cols());
    }
    cluster = found;
  }
  clusters.release_lone_simplices(complex);
  return VolumeCover{.is_bounded = true, .is_cut_short = is_cut_short, .clusters = std::move(clusters)};
}

}  // namespace ndhull
