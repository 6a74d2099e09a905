// Turning a direction so that some points reach less far along it: the loop that planes of facets are fitted
// with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dimension_switch.h"

namespace ndhull {

/// A facet's points and others, as columns; memory that is used again.
///
/// The width of a direction n is max n.x over all of them minus min n.v over the facet's, a convex function.
class TurningPoints {
 public:
  /// Shapes  rows: any number x dimension, row-major; facet (at least one), others: indices of rows. Rows may
  ///         be in both, which costs a product and changes nothing.
  void assign(std::size_t dimension, const double* rows, std::span<const std::uint32_t> facet,
              std::span<const std::uint32_t> others);

  /// Turns `direction`, of length 1, towards less width, and returns the width of what it became.
  ///
  /// Method  x - v of the extreme pair, without its part along n, is a subgradient; steps along it, shorter
  ///         after each that does not help. The best direction seen is taken.
  /// Cost    `steps` products of a direction with all points.
  /// Source  Shor. Minimization Methods for Non-Differentiable Functions. 1985 (subgradient steps).
  double turn(unsigned steps, double* direction);

  /// The rows that were furthest along some direction of the last call, each once.
  std::span<const std::uint32_t> tops() const { return tops_; }

 private:
  std::size_t dimension_ = 0;
  std::size_t facet_stride_ = 0, stride_ = 0;  // places of the facet's points; of all. Whole vectors
  std::vector<double> columns_;                // dimension x stride; the last points again as padding
  std::vector<std::uint32_t> row_of_place_;
  std::vector<std::uint32_t> places_, tops_;
};

}  // namespace ndhull
