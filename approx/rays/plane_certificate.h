// Facets of which only the plane in the frame and the points on it are known: their planes in input units,
// with offsets that are proven against all points of the input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// A plane distance(x) = normal . (x - reference) + centred_offset in input units.
struct CertifiedPlane {
  std::vector<double> normal;  ///< unit, outward
  double centred_offset = 0.0;
  double outer_offset = 0.0;  ///< [distance] >= 0: all points are below
  double inner_offset = 0.0;  ///< [distance] <= 0: the facet's points are above
};

struct PlaneCertificate {
  std::vector<double> reference;  ///< the origin, or the frame's centre: see gather_certificate_points
  double roundoff = 0.0;          ///< [distance] proven rounding error of a distance
  std::vector<CertifiedPlane> planes;
};

/// One facet: its plane in the frame and ids of the points on it.
struct PlaneOfPoints {
  std::vector<double> plane;
  std::vector<std::uint32_t> points;
};

/// Certifies planes.
///
/// Proof  as make_facet_table: largest computed product over all points, plus a bound on its rounding.
/// Cost   planes x points x dimension multiply-adds on all cores; 8 dimension bytes a point.
PlaneCertificate certify_planes(const PointView& points, const Frame& frame,
                                std::span<const PlaneOfPoints> facets);

}  // namespace ndhull
