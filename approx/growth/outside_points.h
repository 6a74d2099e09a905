// Points left out by growth that are further above the hull than was asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "approx/growth/certified_growth.h"
#include "core/search/furthest_points.h"

namespace ndhull {

/// Looks for points far above any simplex. They may lie over a simplex that they are near to, and be far
/// above another one whose plane is further from the centre.
///
/// Of many points some are searched first, spread evenly. Only a hull that these are below is worth a search
/// over all.
///
/// Memory  some bytes a coordinate of these points, and a copy of them unless they are the rows of the input;
///         for each simplex 4 bytes a vertex and 32, to certify also its normal.
class OutsideSearch {
 public:
  /// `growth` must outlive this, and has ended because no point was outside. `points`: those that may be
  /// above a simplex. `certifies`: they are all points not proven inside, and planes are searched as the
  /// facet table will have them, unit normals in input units with products of x - reference: what is found is
  /// its certificate too.
  OutsideSearch(CertifiedGrowth& growth, std::vector<PointId> points, bool certifies);

  /// Puts those points back that are furthest above any simplex, when some are more than `wanted` above one
  /// [distance]. False when there are none, or when more simplices than are worth it came of those before and
  /// none is far above `width`, which is no less.
  ///
  /// Cost  a search (core/search/furthest_points.h) for each plane that was not there before.
  bool put_back_above(double width, double wanted);

  std::span<const PointId> points() const { return points_; }
  /// No point's gauge is larger above any simplex. [ratio]
  double largest_gauge();
  /// How far all the points reach above each row of the complex; after largest_gauge(), of what certifies.
  KnownHighest take_highest() { return std::move(known_); }

 private:
  struct Above {
    double height = 0.0;  ///< of the point that is furthest above the plane [distance]
    LocatedPoint point;
  };
  void copy_rows();
  bool takes_input_rows();
  /// The rows that are searched: every `step`-th of the points.
  void search_among(std::size_t step);
  void search_new_planes();
  void search_rows(std::span<const std::uint32_t> rows);
  Above above_row(std::uint32_t row, const FurthestPoint& found) const;
  bool finds_above(double width, double wanted);

  CertifiedGrowth& growth_;
  std::vector<PointId> points_;
  bool certifies_;
  std::vector<double> copy_;  // of the points, in the frame or, to certify, x - reference
  StridedRows rows_;
  std::size_t dimension_ = 0;       // of the rows
  std::vector<double> low_, high_;  // their columns' ranges
  std::size_t step_ = 1;
  std::optional<FurthestPoints> furthest_;  // none: there are no points
  std::vector<std::uint32_t> searched_;     // vertices of the simplices that were, row by row of the complex
  std::vector<Above> above_;
  KnownHighest known_;
  double worst_ = 0.0;      // height of the furthest of all [distance]
  double limit_ = 0.0;      // what it may be by now
  std::size_t enough_ = 0;  // simplices from which on only points far above go back
};

}  // namespace ndhull
