// Choosing planes for the little volume below them, by rays: when many planes are wanted, nearly all of the
// polytope is the hull itself, and only what lies between the two is worth looking at.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "approx/work_end.h"
#include "core/linear/dense_views.h"

namespace ndhull {

/// The map to coordinates in which the planes a . y <= 1, rows of `planes`, are spread evenly: the second
/// moments of planes * map are the identity. Ratios of volumes are the same in all coordinates. The rows span
/// the space.
Eigen::MatrixXd even_spread_map(const RowMatrix& planes);

/// Chooses `count` of the planes a . y <= 1, rows of `planes`, `start` among them where it can be.
///
/// Method   The volume below planes is the mean over directions u of r(u)^d, up to a constant, where the
///          nearest plane is met at r(u) = 1 / max a . u: one number for each ray instead of points in d
///          dimensions. Planes are added to `start`, always the one that shortens the rays most. Then planes
///          are exchanged while that helps: each is taken out, the least needed first, for the one that then
///          shortens them most. What each plane would gain is kept up to date ray by ray.
/// Shapes   start: rows that bound a region; they stay. Coordinates in which the rows are spread evenly: rays
///          are uniform.
/// Result   ascending; the same on every machine and for any threads. When `end` comes first what is missing
///          are the first planes not chosen.
/// Cost     planes x rays (60 for each plane wanted, 4,000 to 60,000) x rank multiplications a few times.
std::vector<std::uint32_t> choose_by_rays(const RowMatrix& planes, const std::vector<std::uint32_t>& start,
                                          std::size_t count, const WorkEnd& end = {});

}  // namespace ndhull
