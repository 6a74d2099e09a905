// Points left out by growth that are further above the hull than was asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "approx/certified_growth.h"
#include "core/point_tree.h"

namespace ndhull {

/// Looks for points far above any simplex. They may lie over a simplex that they are near to, and be far
/// above another one whose plane is further from the centre.
///
/// Memory  12 bytes a coordinate of these points.
class OutsideSearch {
 public:
  /// `growth` must outlive this, and has ended because no point was outside. `points`: those that may be
  /// above a simplex.
  OutsideSearch(CertifiedGrowth& growth, std::vector<PointId> points);

  /// Puts those points back that are furthest above any simplex, when some are more than `width` above one
  /// [distance]. False when there are none, or when more simplices than are worth it came of those before.
  ///
  /// Cost  a search (core/point_tree.h) for each plane that was not there before.
  bool put_back_above(double width);

  /// No point's gauge is larger above any simplex. [ratio]
  double largest_gauge();
  /// Of the points, neighbours together.
  std::vector<std::uint32_t> take_order() {
    return tree_ ? std::move(*tree_).take_order() : std::vector<std::uint32_t>();
  }

 private:
  struct Above {
    double height;  ///< of the point that is furthest above the plane [distance]
    LocatedPoint point;
  };
  void search_new_planes();

  CertifiedGrowth& growth_;
  std::vector<PointId> points_;    // of the tree's rows
  std::optional<PointTree> tree_;  // none: no point may be
  std::vector<double> planes_;     // as they were searched, row by row of the complex
  std::vector<Above> above_;
  std::size_t enough_ = 0;  // simplices from which on only points far above go back
};

}  // namespace ndhull
