// The plane of a facet of several simplices: the direction in which the facet is narrowest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/width_space.h"
#include "core/search/direction_turn.h"

namespace ndhull {

/// A direction with what it says about the points of a WidthSpace.
struct FittedPlane {
  std::vector<double> normal;  ///< unit
  double height = 0.0;         ///< [distance] largest product with any point
  double low = 0.0;            ///< [distance] smallest product with a vertex of the facet
  std::uint32_t highest = 0;   ///< row of the space that is as high as `height`
  double width() const { return height - low; }
  double middle() const { return 0.5 * (height + low); }  ///< height of the plane midway
};

/// Scratch of the fits; one for each thread.
struct PlaneFitWork {
  SupportProducts products;  ///< of the last measured direction with all points, unless these are many
  std::vector<FurthestPoint> above;
  std::vector<std::uint32_t> near;  ///< rows that a turned plane may meet first, beside the facet's vertices
  std::vector<std::uint32_t> pass_of_row;  ///< rows marked in this pass are vertices of the facet
  std::uint32_t pass = 0;
  TurningPoints points;      ///< those of the last fit
  std::vector<double> best;  ///< the direction that it found
};

/// Height and low of `normal` for a facet with these vertices (rows of `space`).
FittedPlane measure_plane(const WidthSpace& space, std::span<const double> normal,
                          std::span<const std::uint32_t> vertices, PlaneFitWork& work);

/// The smallest product of `normal` with one of these rows; +inf of none.
double lowest_dot(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> vertices);

/// rows: all vertices whose products with the direction that was measured last are `least` or more; some, and
/// where the space is large any, that are less may be among them.
void list_vertices_from(const WidthSpace& space, double least, const PlaneFitWork& work,
                        std::vector<std::uint32_t>& rows);

/// Turns `start` towards less width, looking only at points within a width below it, the highest if they are
/// very many. The last plane measured must be start. Returns the width among those points, which can be less
/// than over all points, of work.best.
///
/// Not promised  the least width there is.
/// Cost      `steps` products of a direction with the near points (core/search/direction_turn.h).
double turn_among_near(const WidthSpace& space, const FittedPlane& start,
                       std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work);

/// The same from `normal` with the facet's vertices and the points `near` alone: what comes out is as narrow
/// as the facet can be, but for what the steps miss. No product with other points. Returns the width among
/// those points, of work.best.
double turn_among(const WidthSpace& space, std::span<const double> normal,
                  std::span<const std::uint32_t> near, std::span<const std::uint32_t> vertices,
                  unsigned steps, PlaneFitWork& work);

/// Turns work.best further among the points of the last fit.
double turn_further(unsigned steps, PlaneFitWork& work);

/// The plane so turned, measured with all points, or `start` if that is no wider.
/// Cost      a product of a direction with all points more.
FittedPlane narrow_plane(const WidthSpace& space, const FittedPlane& start,
                         std::span<const std::uint32_t> vertices, unsigned steps, PlaneFitWork& work);

}  // namespace ndhull
