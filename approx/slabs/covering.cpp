#include "approx/slabs/covering.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/ids.h"
#include "core/linear/dense_views.h"
#include "core/linear/simplex_planes.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Outward unit normals of the frame's first simplex.
std::vector<std::vector<double>> first_simplex_normals(const WidthSpace& space, const Frame& frame,
                                                       const double* coordinates) {
  std::vector<std::vector<double>> normals;
  for (const Eigen::VectorXd& plane : simplex_planes(coordinates, space.rank(), frame.simplex)) {
    normals.emplace_back(space.rank());
    space.normal_of(as_span(plane), normals.back().data());
  }
  return normals;
}

/// The smallest product of `normal` with a vertex of the simplex. Of its own, not of a measured plane: where
/// points are many that has no products with all of them.
double low_of(const SimplicialComplex& complex, const WidthSpace& space, std::uint32_t simplex,
              std::span<const double> normal) {
  double low = HUGE_VAL;
  for (const PointId id : complex.vertices(SimplexId{simplex})) {
    const double* z = space.row(space.row_of(id));
    low = std::min(low, std::inner_product(normal.begin(), normal.end(), z, 0.0));
  }
  return low;
}

}  // namespace

FacetMembers::FacetMembers(const Covering& covering) : begin_(covering.planes.size() + 1, 0) {
  for (const std::uint32_t facet : covering.facet_of)
    if (facet != kNone) ++begin_[facet + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
  rows_.resize(begin_.back());
  for (std::uint32_t row = 0; row < covering.facet_of.size(); ++row)
    if (covering.facet_of[row] != kNone) rows_[at[covering.facet_of[row]]++] = row;
}

std::span<const std::uint32_t> FacetVertices::list(const SimplicialComplex& complex, const WidthSpace& space,
                                                   std::span<const std::uint32_t> members) {
  constexpr std::size_t kMembersAhead = 8;  // whose vertices are on their way from memory
  pass_of_row_.resize(space.vertex_count(), 0);
  rows_.clear();
  ++pass_;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const SimplexId later{members[std::min(i + kMembersAhead, members.size() - 1)]};
    prefetch(complex.vertices(later).data(), complex.rank);
    for (const PointId id : complex.vertices(SimplexId{members[i]})) {
      const std::uint32_t row = space.row_of(id);
      if (pass_of_row_[row] == pass_) continue;
      pass_of_row_[row] = pass_;
      rows_.push_back(row);
    }
  }
  return rows_;
}

std::vector<std::uint32_t> drop_empty_facets(Covering& covering) {
  std::vector<std::uint32_t> new_id(covering.planes.size(), kNone);
  for (const std::uint32_t facet : covering.facet_of)
    if (facet != kNone) new_id[facet] = 0;
  std::uint32_t used = 0;
  for (std::size_t facet = 0; facet < new_id.size(); ++facet) {
    if (new_id[facet] == kNone) continue;
    if (used != facet) covering.planes[used] = std::move(covering.planes[facet]);
    new_id[facet] = used++;
  }
  covering.planes.resize(used);
  for (std::uint32_t& facet : covering.facet_of)
    if (facet != kNone) facet = new_id[facet];
  return new_id;
}

FittedPlane own_plane(const SimplicialComplex& complex, const WidthSpace& space, std::uint32_t row) {
  FittedPlane plane;
  plane.normal.resize(space.rank());
  space.normal_of(complex.plane(SimplexId{row}), plane.normal.data());
  return plane;
}

Covering cover_by_simplices(const SimplicialComplex& complex, const WidthSpace& space) {
  Covering covering;
  covering.facet_of.assign(complex.row_count, kNone);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    covering.facet_of[row] = static_cast<std::uint32_t>(covering.planes.size());
    covering.planes.push_back(own_plane(complex, space, row));
  }
  return covering;
}

void free_lone_simplices(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex,
                         Covering& covering) {
  const FacetMembers members(covering);
  PlaneFitWork work;
  for (std::uint32_t facet = 0; facet < covering.planes.size(); ++facet) {
    FittedPlane& plane = covering.planes[facet];
    if (members.of(facet).size() != 1 || !is_measured(plane)) continue;
    const std::uint32_t row = members.of(facet)[0];
    FittedPlane own = own_plane(complex, space, row);
    const std::uint32_t vertex = space.row_of(complex.vertices(SimplexId{row})[0]);
    if (is_convex || measure_plane(space, own.normal, std::span(&vertex, 1), work).width() <= plane.width())
      plane = std::move(own);
  }
}

FacetClusters clusters_of(const Covering& covering, const WidthSpace& space) {
  FacetClusters clusters;
  if (covering.planes.empty()) return clusters;
  const std::size_t rank = space.rank();
  clusters.cluster_of.assign(covering.facet_of.size(), kNone);
  std::vector<std::uint32_t> cluster(covering.planes.size(), kNone);
  for (std::uint32_t facet = 0; facet < covering.planes.size(); ++facet) {
    const FittedPlane& plane = covering.planes[facet];
    if (!is_measured(plane)) continue;
    cluster[facet] = clusters.count++;
    clusters.planes.resize(clusters.count * rank);
    space.plane_of(plane.normal.data(), plane.height, clusters.planes.data() + cluster[facet] * rank);
  }
  for (std::size_t row = 0; row < covering.facet_of.size(); ++row)
    if (covering.facet_of[row] != kNone) clusters.cluster_of[row] = cluster[covering.facet_of[row]];
  return clusters;
}

Covering cover_by_first_simplex(const SimplicialComplex& complex, const WidthSpace& space, const Frame& frame,
                                const double* coordinates) {
  const std::vector<std::vector<double>> normals = first_simplex_normals(space, frame, coordinates);
  Covering covering;
  covering.facet_of.assign(complex.row_count, kNone);
  std::vector<double> depth_of(complex.row_count, HUGE_VAL);
  std::vector<std::uint32_t> highest;  // the simplex that a facet keeps whatever comes
  PlaneFitWork work;
  for (std::uint32_t facet = 0; facet < normals.size(); ++facet) {
    covering.planes.push_back(measure_plane(space, normals[facet], {}, work));
    std::uint32_t own = kNone;
    double least = HUGE_VAL;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (complex.state[row] != SimplexState::kLive) continue;
      const double depth = covering.planes[facet].height - low_of(complex, space, row, normals[facet]);
      if (depth < least && std::find(highest.begin(), highest.end(), row) == highest.end()) {
        least = depth;
        own = row;
      }
      if (depth >= depth_of[row]) continue;
      depth_of[row] = depth;
      covering.facet_of[row] = facet;
    }
    highest.push_back(own);
  }
  for (std::uint32_t facet = 0; facet < normals.size(); ++facet) covering.facet_of[highest[facet]] = facet;
  for (std::uint32_t facet = 0; facet < normals.size(); ++facet) {
    FittedPlane& plane = covering.planes[facet];
    plane.low = HUGE_VAL;
    for (std::uint32_t row = 0; row < complex.row_count; ++row) {
      if (covering.facet_of[row] == facet)
        plane.low = std::min(plane.low, low_of(complex, space, row, plane.normal));
    }
    covering.widest = std::max(covering.widest, plane.width());
  }
  return covering;
}

}  // namespace ndhull
