// Planes through as many points as there are dimensions, as dual vertices: a.y = 1 on the plane.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ndhull {

/// Through `rank` of the points, refined once. Where they span no plane infinities or NaN.
/// Shapes  points: any number of rows x rank; corners: their ids.
Eigen::VectorXd plane_through(const double* points, std::size_t rank, std::span<const PointId> corners);

/// Of a simplex of rank + 1 corners: plane k is that opposite corner k.
std::vector<Eigen::VectorXd> simplex_planes(const double* points, std::size_t rank,
                                            std::span<const PointId> corners);

}  // namespace ndhull
