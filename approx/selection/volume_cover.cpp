#include "approx/selection/volume_cover.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "approx/geometry/boundedness.h"
#include "approx/selection/plane_candidates.h"
#include "approx/selection/volume_rays.h"
#include "core/blocks.h"
#include "core/ids.h"

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

/// Rows of `planes` to choose from, the largest facets first in coordinates where planes are spread evenly.
std::vector<std::uint32_t> candidates_of(const ExactFacets& facets, const RowMatrix& even) {
  std::vector<double> areas(facets.volumes.size());
  for (std::size_t row = 0; row < areas.size(); ++row)
    areas[row] = facets.volumes[row] * even.row(static_cast<Index>(row)).norm();
  std::vector<std::uint32_t> ids(areas.size());
  std::iota(ids.begin(), ids.end(), 0U);
  std::sort(ids.begin(), ids.end(), [&areas](std::uint32_t a, std::uint32_t b) {
    return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
  });
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
  const RowMatrix even = evenly_spread(facets.planes);
  std::vector<std::uint32_t> ids = candidates_of(facets, even);
  if (ids.size() > kMostCandidates) {
    const std::span<const std::uint32_t> few(ids.data(), kMostCandidates);
    if (find_open_direction(values_of(rows_of(even, few)), static_cast<std::size_t>(even.cols())).bounded)
      ids.resize(kMostCandidates);
  }
  const RowMatrix candidates = rows_of(even, ids);
  const std::vector<std::uint32_t> start =
      complete_to_bounded(values_of(candidates), static_cast<std::size_t>(even.cols()), {});
  std::vector<std::uint32_t> chosen = choose_by_rays(candidates, start, count, end);
  for (std::uint32_t& row : chosen) row = ids[row];
  std::sort(chosen.begin(), chosen.end());
  return rows_of(facets.planes, chosen);
}

/// For each simplex the plane below which its lowest vertex is least deep.
std::vector<std::uint32_t> assign_simplices(const SimplicialComplex& complex, const double* points,
                                            const RowMatrix& planes,
                                            std::span<const double> gradient_factor) {
  const Index rank = planes.cols();
  const Eigen::Map<const RowMatrix> factor(gradient_factor.data(), rank, rank);
  // Distances in length units: a gauge over the length of its gradient.
  const Eigen::VectorXd lengths = (planes * factor.transpose()).rowwise().norm();
  std::vector<std::uint32_t> plane_of(complex.row_count);
  for_each_block(complex.row_count, 64, [&](std::size_t begin, std::size_t end) {
    Eigen::MatrixXd vertices(rank, rank), gauges;
    for (std::size_t row = begin; row != end; ++row) {
      Index column = 0;
      for (const PointId id : complex.vertices(SimplexId{static_cast<std::uint32_t>(row)})) {
        vertices.col(column++) =
            Eigen::Map<const Eigen::VectorXd>(points + std::size_t{id.value} * complex.rank, rank);
      }
      gauges.noalias() = planes * vertices;
      double least = HUGE_VAL;
      for (Index plane = 0; plane < planes.rows(); ++plane) {
        const double depth = (1.0 - gauges.row(plane).minCoeff()) / lengths[plane];
        if (depth >= least) continue;
        least = depth;
        plane_of[row] = static_cast<std::uint32_t>(plane);
      }
    }
  });
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
  return VolumeCover{.is_bounded = true, .is_cut_short = is_cut_short, .clusters = std::move(clusters)};
}

}  // namespace ndhull
