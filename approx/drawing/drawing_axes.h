// The two or three axes that a hull is drawn along: columns of the input, or principal components.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/points.h"

namespace ndhull {

/// Axes through a centre, and the coordinates of a point along them.
///
/// A point of the flat they span is centre + sum y_k direction(k); measure(k) . (x - centre) is the y_k of
/// the point that x projects to. The two are dual: measure(j) . direction(k) is 1 for j = k, else 0.
struct DrawingAxes {
  std::size_t dimension = 0;       ///< of the points
  std::vector<double> centre;      ///< dimension numbers, input units
  std::vector<double> directions;  ///< count() x dimension, input units for one unit along the axis
  std::vector<double> measures;    ///< count() x dimension
  std::vector<double> origin;      ///< what an axis shows at the centre: the column's value, 0 of a component
  std::vector<std::string> names;  ///< "carat" or "x2"; "PC1"
  std::vector<std::string> remarks;  ///< what a component is made of; empty for columns

  std::size_t count() const { return names.size(); }
  std::span<const double> direction(std::size_t axis) const {
    return {directions.data() + axis * dimension, dimension};
  }
  std::span<const double> measure(std::size_t axis) const {
    return {measures.data() + axis * dimension, dimension};
  }
};

/// Name of every column: those given, otherwise x1, x2, ..
std::vector<std::string> column_names_or_numbers(std::vector<std::string> names, std::size_t dimension);

/// Axes along columns of the input; `columns` are indices from 0, all different.
DrawingAxes column_axes(std::span<const std::size_t> columns, std::span<const double> centre,
                        std::span<const std::string> column_names);

/// The `count` directions in which the points vary most, after scaling column k by 1 / extents[k].
///
/// extents   dimension numbers, or empty: no scaling. A column of extent 0 has no part in any component.
/// equations as Hull::subspace_equations; empty unless the points are flat. Components stay in the subspace.
/// Signs     a component's largest part is positive, so the axes do not depend on the eigenvalue routine.
/// Cost      O(rows dimension^2): one pass over all points.
/// Precondition  count <= rank of the points.
DrawingAxes principal_axes(const PointView& points, std::size_t count, std::span<const double> centre,
                           std::span<const double> extents, std::span<const std::string> column_names,
                           std::span<const double> equations = {});

}  // namespace ndhull
