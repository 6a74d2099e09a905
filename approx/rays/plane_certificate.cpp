#include "approx/rays/plane_certificate.h"

#include <algorithm>
#include <cmath>

#include "approx/facets/facet_table.h"
#include "approx/geometry/frame_planes.h"
#include "core/machine/blocks.h"
#include "core/search/plane_kernels.h"

namespace ndhull {

PlaneCertificate certify_planes(const PointView& points, const Frame& frame,
                                std::span<const PlaneOfPoints> facets) {
  const std::size_t dimension = frame.dimension;
  const CertificatePoints all =
      gather_certificate_points(points, frame, std::vector<bool>(points.rows, true), false);
  PlaneCertificate result;
  result.reference = all.reference;
  const NormalMap to_input(frame);
  std::vector<double> normals(facets.size() * dimension), highest(facets.size());
  for (std::size_t row = 0; row < facets.size(); ++row) {
    std::vector<double> plane = facets[row].plane;
    to_input.map(plane.data(), 1, normals.data() + row * dimension);
  }
  constexpr std::size_t kFacetsAtATime = 16;
  for_each_block(facets.size(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    max_dots(dimension, {normals.data() + begin * dimension, (end - begin) * dimension}, all.rows,
             {highest.data() + begin, end - begin});
  });
  for (std::size_t row = 0; row < facets.size(); ++row) {
    const double* const normal = normals.data() + row * dimension;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const std::uint32_t id : facets[row].points) {
      const double* const point = all.rows.data() + std::size_t{all.row_of_point[id]} * dimension;
      double dot = 0.0;
      for (std::size_t k = 0; k < dimension; ++k) dot += normal[k] * point[k];
      low = std::min(low, dot);
      high = std::max(high, dot);
    }
    const double offset = -(0.5 * low + 0.5 * high);
    double size = std::abs(offset), size_input = std::abs(offset);
    for (std::size_t k = 0; k < dimension; ++k) {
      size += std::abs(normal[k]) * all.largest[k];
      size_input += std::abs(normal[k]) * all.largest_input[k];
    }
    // One subtraction for each coordinate, dimension products, one sum with the offset, one spare.
    const double error = sum_error(dimension + 3, size);
    CertifiedPlane plane;
    plane.normal.assign(normal, normal + dimension);
    plane.centred_offset = offset;
    plane.outer_offset = std::max(0.0, highest[row] + offset + error);
    plane.inner_offset = std::min(0.0, low + offset - error);
    result.roundoff = std::max(result.roundoff, sum_error(dimension + 3, size + size_input));
    result.planes.push_back(std::move(plane));
  }
  return result;
}

}  // namespace ndhull
