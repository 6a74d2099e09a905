// The plane of a facet of several simplices: the direction in which the facet is narrowest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/width_space.h"

namespace ndhull {

/// A direction with what it says about the points of a WidthSpace.
struct FittedPlane {
  std::vector<double> normal;  ///< unit
  double height = 0.0;         ///< [distance] largest product with any point
  double low = 0.0;            ///< [distance] smallest product with a vertex of the facet
  double width() const { return height - low; }
  double middle() const { return 0.5 * (height + low); }  ///< height of the plane midway
};

/// Scratch of the fits; one for each thread.
struct PlaneFitWork {
  std::vector<double> dots;   ///< of the last measured direction with all points, unless these are many
  std::uint32_t highest = 0;  ///< row that reaches furthest along that
  std::vector<FurthestPoint> above;
  std::vector<std::uint32_t> near;  ///< rows that a turned plane may meet first
  std::vector<std::uint32_t> tops;  ///< of these, the rows that were highest at some step of the last fit
  std::vector<double> rows, products, trial, next, best;
  SupportTable near_table, facet_table;
  std::uint64_t evaluations = 0;  ///< products of one direction with all points, ever
};

/// Height, low and, unless the space is large, products (work.dots) of `normal` for a facet with these
/// vertices (rows of `space`).
FittedPlane measure_plane(const WidthSpace& space, std::span<const double> normal,
                          std::span<const std::uint32_t> vertices, PlaneFitWork& work);

/// Turns `start` towards less width, looking only at points within a width below it, the highest if they are
/// very many. The last plane measured must be start. Returns the width among those points, which can be less
/// than over all points, of work.best.
///
/// Method    The width of a direction n is max n.x over all points minus min n.v over the facet's vertices, a
///           convex function; x - v of the extreme pair, without its part along n, is a subgradient. Steps
///           along it, shorter after each that does not help; the best direction seen is taken.
/// Not promised  the least width there is.
/// Cost      `steps` products of a direction with the near points.
/// Source    Shor. Minimization Methods for Non-Differentiable Functions. 1985 (subgradient steps).
double turn_among_near(const WidthSpace& space, const FittedPlane& start,
                       std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work);

/// The same from `normal` with the points `near` alone, which hold the facet's vertices: what comes out is as
/// narrow as the facet can be, but for what the steps miss. No product with other points.
double turn_among(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> near, std::span<const std::uint32_t> vertices,
                  unsigned steps, PlaneFitWork& work);

/// The plane so turned, measured with all points, or `start` if that is no wider. work.dots are those of what
/// is returned.
/// Cost      one or two products of a direction with all points more.
FittedPlane narrow_plane(const WidthSpace& space, const FittedPlane& start,
                         std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work);

}  // namespace ndhull
