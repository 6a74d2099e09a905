// The points that planes are certified against.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// Points that facets are certified against, relative to the reference point.
struct CertificatePoints {
  std::size_t dimension = 0;
  std::vector<double> reference;
  std::vector<double> rows;                 ///< count x dimension: x - reference
  std::vector<double> largest;              ///< per column: largest |x - reference|
  std::vector<double> largest_input;        ///< per column: largest |x|
  std::vector<std::uint32_t> row_of_point;  ///< for the points that are in `rows`
};

/// The origin, unless the data lie further from it than four times their extent: then planes stated at the
/// origin would lose the digits that the data have, and it is the frame's centre.
std::vector<double> certificate_reference(const Frame& frame);

/// `wanted`: one flag a point of the input; all vertices are. `is_known`: how far the points reach is known,
/// and these are not all; then `largest` is that of the whole input.
CertificatePoints gather_certificate_points(const PointView& points, const Frame& frame,
                                            const std::vector<bool>& wanted, bool is_known);

}  // namespace ndhull
