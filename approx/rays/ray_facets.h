// Facets as walks find them: their points, planes, areas and ridges.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "approx/geometry/frame_planes.h"
#include "approx/rays/ray_shooting.h"

namespace ndhull {

/// A facet of the hull of all points.
struct RayFacet {
  std::vector<std::uint32_t> points;    ///< ids of all points on the plane, ascending; tells facets apart
  std::vector<std::uint32_t> vertices;  ///< those that are vertices of the facet, ascending
  std::vector<double> plane;            ///< a with a.y = 1 on the facet, frame
  double area = 0.0;                    ///< [area, input units]
  /// False where points on one plane are too many, or their dimension too high, or time too short, for their
  /// hull: then `area` is that of a part, and not all vertices are known.
  bool area_is_whole = true;
};

/// Turns walks into facets. Safe to call from several threads.
class FacetGeometry {
 public:
  /// `max_seconds`: of one facet, 0: none. Areas are those of a part then.
  explicit FacetGeometry(const RayShooter& shooter, double max_seconds = 0.0);

  /// The facet through all the points on a plane. Simplices that share a plane are one facet: its points'
  /// hull within the plane has the area.
  ///
  /// walk   ended at the facet.
  /// Cost   O(rank) for rank points; else that of their hull in rank - 1 dimensions.
  RayFacet make_facet(const WalkResult& walk) const;

  /// a with a.y = 1 on the points, in the frame, by least squares.
  std::vector<double> fit_plane(const std::vector<std::uint32_t>& points) const;

  /// Walks over the ridges of a facet; of very many, over the largest ones; nothing where time was too short.
  /// Of a simplex points and vertices are enough.
  std::optional<std::vector<WalkTask>> ridge_walks(const RayFacet& facet) const;

 private:
  struct InPlane;
  /// [area] of the simplex, or of the sum of simplices, with this determinant.
  double area_of(double determinant, const std::vector<double>& plane) const;
  InPlane project(const RayFacet& facet) const;

  const RayShooter& shooter_;
  double max_seconds_;
  ScaledRatio volume_scale_;  // frame volume per input volume
  // rank x dimension: a plane times this is its normal in input units, of length one over its height.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> to_input_;
};

}  // namespace ndhull
