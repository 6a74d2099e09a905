#include "approx/accuracy.h"

#include <string>

#include "core/error.h"

#include <algorithm>

namespace ndhull {

ResolvedAccuracy resolve(const Accuracy& accuracy, const Frame& frame, const LengthUnit& unit) {
  ResolvedAccuracy lengths;
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    const double extent = frame.column_max[k] - frame.column_min[k];
    lengths.largest_extent = std::max(lengths.largest_extent, extent);
  }
  if (!unit.extents().empty() && lengths.largest_extent > 0.0) lengths.largest_extent = 1.0;
  const auto length = [&](const Length& asked) {
    return asked.is_percent ? 0.01 * asked.value * lengths.largest_extent : asked.value;
  };
  lengths.width = length(accuracy.width);
  lengths.outside_width = length(accuracy.outside_width);
  lengths.centrum_radius = length(accuracy.centrum_radius);
  lengths.width_cap = length(accuracy.width_cap);
  if (!accuracy.width_cap.is_set() && accuracy.merges_neighbours()) {
    lengths.width_cap =
        default_width_cap(lengths.outside_width, lengths.centrum_radius, lengths.largest_extent);
  }
  return lengths;
}

void check_facet_target(const Accuracy& accuracy, std::size_t rank) {
  if (accuracy.facets == 0 || accuracy.facets > rank) return;
  throw Error(ErrorCode::kUsage, "target of facets: found " + std::to_string(accuracy.facets) +
                                     ", expected at least " + std::to_string(rank + 1) +
                                     ": the points span " + std::to_string(rank) +
                                     " dimensions, and fewer planes bound no region; ask for more");
}

Accuracy above_rounding(Accuracy accuracy, const ResolvedAccuracy& lengths, double shift) {
  constexpr double kShifts = 8.0;
  const double least = kShifts * shift * lengths.largest_extent;
  if (lengths.width <= least && accuracy.width.is_set()) accuracy.width = accuracy.outside_width = {};
  if (lengths.outside_width <= least) accuracy.outside_width = {};
  return accuracy;
}

double default_width_cap(double outside_width, double centrum_radius, double largest_extent) {
  if (centrum_radius == 0.0) return outside_width + 0.1 * largest_extent;
  return std::max(outside_width + 0.9 * centrum_radius, 6.5 * centrum_radius);
}

void check_depths(const Accuracy& accuracy, const ResolvedAccuracy& lengths) {
  constexpr double kLongest = 1e36;
  const bool gathers = accuracy.facets > 0 || lengths.width > 0.0 || accuracy.merges_neighbours();
  if (!gathers || lengths.largest_extent < kLongest) return;
  throw Error(ErrorCode::kOutOfRange,
              "points: found an extent of 1e36 or more, expected less where facets are merged; divide the "
              "coordinates by a power of two, or measure widths in the unit cube");
}

void check_squares(double largest_extent) {
  constexpr double kShortest = 1e-140, kLongest = 1e140;
  if (largest_extent > kShortest && largest_extent < kLongest) return;
  const bool is_small = largest_extent <= kShortest;
  throw Error(ErrorCode::kOutOfRange,
              std::string("points: found an extent ") + (is_small ? "below 1e-140" : "above 1e140") +
                  ", expected " + (is_small ? "more" : "less") + " where facets are to be fewer; " +
                  (is_small ? "multiply" : "divide") +
                  " the coordinates by a power of two, or measure widths in the unit cube");
}

}  // namespace ndhull
