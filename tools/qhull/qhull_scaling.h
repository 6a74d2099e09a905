// Qhull's options that change the points before their hull is computed: QbB, Qbb, Qbk:n, QBk:n.
#pragma once

#include <vector>

#include "core/points.h"
#include "tools/points/point_set.h"
#include "tools/qhull/qhull_options.h"

namespace ndhull {

/// Does the command change the points?
bool scales_points(const QhullCommand& command);

/// The points as the command wants them; all that is printed is about these.
///
/// Order     columns with both bounds 0 are left out; then every column with a bound is scaled and moved to
///           [lower, upper], the bound that is not given staying as it is; then with Qbb the last column to
///           [0, largest absolute value of the others]. QbB bounds all columns by -0.5 and 0.5.
/// Throws    Error kUsage: a column that the points do not have, a lower bound above the upper, no column
///           left; a column that is to be scaled and has one value only.
/// Cost      a copy of the points.
PointSet scaled_points(const PointView& points, const QhullCommand& command);

}  // namespace ndhull
