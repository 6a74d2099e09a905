#include "approx/facet_table.h"

#include <algorithm>
#include <cmath>

#include "approx/frame_planes.h"
#include "core/blocks.h"
#include "core/furthest_points.h"
#include "core/highest_dots.h"
#include "core/plane_kernels.h"

namespace ndhull {
namespace {

/// Smallest and largest product of each merged facet's normal with its simplices' vertices.
void merged_dots(const SimplicialComplex& complex, const FacetLayout& layout, const CertificatePoints& points,
                 const double* normals, std::span<double> low, std::span<double> high) {
  const std::size_t dimension = points.dimension;
  std::vector<std::uint32_t> last_facet(points.row_of_point.size(), FacetId::kNone);
  for (std::size_t facet = layout.simplicial; facet < layout.facets; ++facet) {
    double smallest = HUGE_VAL, largest = -HUGE_VAL;
    const double* normal = normals + facet * dimension;
    const std::size_t merged = facet - layout.simplicial;
    for (std::uint32_t simplex = layout.merged_begin[merged]; simplex < layout.merged_begin[merged + 1];
         ++simplex) {
      for (const PointId id : complex.vertices(SimplexId{simplex})) {
        if (last_facet[id.value] == facet) continue;
        last_facet[id.value] = static_cast<std::uint32_t>(facet);
        const double* point = points.rows.data() + std::size_t{points.row_of_point[id.value]} * dimension;
        double dot = 0.0;
        for (std::size_t k = 0; k < dimension; ++k) dot += normal[k] * point[k];
        smallest = std::min(smallest, dot);
        largest = std::max(largest, dot);
      }
    }
    low[facet] = smallest;
    high[facet] = largest;
  }
}

/// Sets entries of the merged facets' planes to 0 that are rounding of their fits. In the frame all axes are
/// alike; on long ones such entries would look like a tilt, and six sides of a box would seem to bound a
/// region in 4-d.
void drop_rounding(SimplicialComplex& complex, const FacetLayout& layout) {
  constexpr double kRounding = 8.0 * 0x1p-52;
  for (std::size_t facet = layout.simplicial; facet < layout.facets; ++facet) {
    double* plane = complex.planes.data() + facet * complex.rank;
    double largest = 0.0;
    for (std::size_t k = 0; k < complex.rank; ++k) largest = std::max(largest, std::abs(plane[k]));
    for (std::size_t k = 0; k < complex.rank; ++k)
      if (std::abs(plane[k]) < kRounding * largest) plane[k] = 0.0;
  }
}

/// How far from the frame's centre a ball of the frame around it reaches along a normal: no covered point
/// reaches further. Where the frame's map has cancellation, or nothing is covered: infinitely far.
double support_of_ball(const Frame& frame, std::span<const double> normal, const CoveredPoints& covered) {
  if (covered.gauge == 0.0 || !frame.is_diagonal || frame.rank != frame.dimension) return HUGE_VAL;
  double length_sq = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const double part = normal[k] / frame.map[k * frame.dimension + k];
    length_sq += part * part;
  }
  return covered.reach * std::sqrt(length_sq) * (1.0 + 1e-13);  // rounding of some dimension + 4 operations
}

/// What is summed up over the facets of one block.
struct FacetSums {
  double max_outer = 0.0, min_inner = 0.0, max_width = 0.0, roundoff = 0.0, volume = 0.0, area = 0.0;
};

/// The largest product of each facet's normal with any certificate point. `own.count`: vertices of each of
/// the first `simplicial` facets.
void find_highest(const CertificatePoints& points, std::span<const double> normals, const OwnDots& own,
                  std::size_t simplicial, std::span<double> highest) {
  constexpr std::size_t kFewFacets = 256;    // grouping the points costs more than it saves
  constexpr std::size_t kManyPoints = 8192;  // most of them no vertices: far from most facets
  constexpr std::size_t kFacetsAtATime = 4096;
  const std::size_t dimension = points.dimension, count = highest.size();
  // Facets are independent: the result does not depend on how they are shared out.
  if (count >= kFewFacets && points.rows.size() / dimension >= kManyPoints) {
    const StridedRows rows{points.rows.data(), points.rows.size() / dimension, dimension};
    std::vector<double> low(dimension, HUGE_VAL), high(dimension, -HUGE_VAL);
    for (std::size_t i = 0; i < points.rows.size(); i += dimension) {
      for (std::size_t k = 0; k < dimension; ++k) {
        low[k] = std::min(low[k], points.rows[i + k]);
        high[k] = std::max(high[k], points.rows[i + k]);
      }
    }
    std::vector<FurthestPoint> furthest(count);
    for (std::size_t facet = 0; facet < count; ++facet) furthest[facet].dot = own.high[facet];
    FurthestPoints(dimension, rows, low, high, false).find(normals, furthest);
    for (std::size_t facet = 0; facet < count; ++facet) highest[facet] = furthest[facet].dot;
    return;
  }
  const PointGroups groups(dimension, points.rows, count < kFewFacets);
  const auto find = [&](std::size_t first, std::size_t last, std::size_t own_count) {
    for_each_block(last - first, kFacetsAtATime, [&](std::size_t block_begin, std::size_t block_end) {
      const std::size_t begin = first + block_begin, size = block_end - block_begin;
      highest_dots(groups, normals.subspan(begin * dimension, size * dimension),
                   {own.low.subspan(begin, size), own.high.subspan(begin, size), own_count},
                   highest.subspan(begin, size));
    });
  };
  find(0, simplicial, own.count);
  find(simplicial, count, 0);
}

/// What is known, raised by what a normal that differs from the one it is known for can change.
void take_highest(const KnownHighest& known, const CertificatePoints& points, std::span<const double> normals,
                  std::span<const double> own_high, std::span<double> highest) {
  constexpr double kRoundedUp = 1.0 + 1e-14;
  for (std::size_t facet = 0; facet < highest.size(); ++facet) {
    double change = 0.0;
    for (std::size_t k = 0; k < points.dimension; ++k) {
      const std::size_t at = facet * points.dimension + k;
      change += std::abs(normals[at] - known.normals[at]) * points.largest[k];
    }
    highest[facet] = std::max(own_high[facet], known.highest[facet] + change * kRoundedUp);
  }
}

/// Areas of the merged facets: of the projection of their simplices onto their plane.
void project_areas(const FacetLayout& layout, const Frame& frame, std::span<const double> normals,
                   double area_per_determinant, HugeArray<double>& areas) {
  const std::size_t dimension = frame.dimension, count = layout.facets - layout.simplicial;
  std::vector<double> directions(count * dimension), lengths(count);
  map_normals(frame, layout.area_vectors.data(), count, directions.data(), lengths.data());
  for (std::size_t m = 0; m < count; ++m) {
    const double* normal = normals.data() + (layout.simplicial + m) * dimension;
    double cosine = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) cosine += directions[m * dimension + k] * normal[k];
    // A facet of simplices without volume has no direction either.
    areas[layout.simplicial + m] = std::isfinite(cosine) ? lengths[m] * cosine * area_per_determinant : 0.0;
  }
}

}  // namespace

std::vector<double> certificate_reference(const Frame& frame) {
  constexpr double kFar = 4.0;  // extents: two bits of the data's digits are worth a plane at the origin
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    const double largest = std::max(std::abs(frame.column_min[k]), std::abs(frame.column_max[k]));
    const double extent = frame.column_max[k] - frame.column_min[k];
    if (extent > 0.0 && largest > kFar * extent) return frame.centre;
  }
  return std::vector<double>(frame.dimension, 0.0);
}

CertificatePoints gather_certificate_points(const PointView& points, const Frame& frame,
                                            const std::vector<bool>& wanted, bool is_known) {
  CertificatePoints result;
  const std::size_t dimension = points.dimension;
  result.dimension = dimension;
  result.reference = certificate_reference(frame);
  result.largest_input.resize(dimension);
  result.largest.assign(dimension, 0.0);
  for (std::size_t k = 0; k < dimension; ++k) {
    result.largest_input[k] = std::max(std::abs(frame.column_min[k]), std::abs(frame.column_max[k]));
    if (!is_known) continue;
    result.largest[k] = std::max(std::abs(frame.column_min[k] - result.reference[k]),
                                 std::abs(frame.column_max[k] - result.reference[k]));
  }
  result.row_of_point.assign(points.rows, 0);
  const auto count = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
  result.rows.reserve(count * dimension);
  for (std::size_t row = 0; row < points.rows; ++row) {
    if (!wanted[row]) continue;
    result.row_of_point[row] = static_cast<std::uint32_t>(result.rows.size() / dimension);
    for (std::size_t k = 0; k < dimension; ++k) {
      const double x = points.at(row, k) - result.reference[k];
      result.rows.push_back(x);
      result.largest[k] = std::max(result.largest[k], std::abs(x));
    }
  }
  return result;
}

FacetTable make_facet_table(SimplicialComplex& complex, const FacetLayout& layout, const Frame& frame,
                            const CertificatePoints& points, std::span<const double> determinants,
                            const LengthUnit& unit, const CoveredPoints& covered, const KnownHighest& known,
                            bool certifies) {
  const std::size_t dimension = frame.dimension;
  const std::size_t count = layout.facets;
  FacetTable table;
  drop_rounding(complex, layout);
  if (frame.rank == dimension) {
    table.normals = std::move(complex.planes);
    map_normals(frame, table.normals.data(), count, table.normals.data());
    table.normals.discard_from(count * dimension);
  } else {
    table.normals = HugeArray<double>(count * dimension);
    map_normals(frame, complex.planes.data(), count, table.normals.data());
    complex.planes = HugeArray<double>();
  }
  table.offsets = HugeArray<double>(count);
  table.outer = HugeArray<double>(count);
  table.inner = HugeArray<double>(count);
  table.areas = HugeArray<double>(count);
  const std::span<const double> normals(table.normals.data(), count * dimension);
  const std::span<double> low(table.inner.data(), count), high(table.areas.data(), count);
  own_dots(complex, dimension, normals, points.rows, points.row_of_point, low.first(layout.simplicial),
           high.first(layout.simplicial));
  merged_dots(complex, layout, points, normals.data(), low, high);
  const std::span<double> highest(table.outer.data(), count);
  if (certifies && !known.highest.empty()) {
    take_highest(known, points, normals, high, highest);
  } else if (certifies) {
    find_highest(points, normals, {low, high, frame.rank}, layout.simplicial, highest);
  } else {
    std::fill(highest.begin(), highest.end(), HUGE_VAL);
  }

  const double volume_per_determinant =
      1.0 / (volume_scale(frame) * std::tgamma(static_cast<double>(frame.rank) + 1.0));
  constexpr std::size_t kFacetsAtATime = 4096;
  // Sums are put together in the order of the blocks.
  std::vector<FacetSums> parts((count + kFacetsAtATime - 1) / kFacetsAtATime);
  for_each_block(count, kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    FacetSums& part = parts[begin / kFacetsAtATime];
    for (std::size_t facet = begin; facet < end; ++facet) {
      const std::span<const double> normal = normals.subspan(facet * dimension, dimension);
      double offset = -(0.5 * low[facet] + 0.5 * high[facet]);
      double centre = 0.0;
      for (std::size_t k = 0; k < dimension; ++k)
        centre += normal[k] * (frame.centre[k] - points.reference[k]);
      // The plane midway of a very wide facet may pass below the interior point; the supporting one never
      // does.
      if (-offset <= centre) offset = -(certifies ? std::max(high[facet], highest[facet]) : high[facet]);
      const double height = -offset - centre;
      double size = std::abs(offset), size_input = std::abs(offset);
      for (std::size_t k = 0; k < dimension; ++k) {
        size += std::abs(normal[k]) * points.largest[k];
        size_input += std::abs(normal[k]) * points.largest_input[k];
      }
      // One subtraction for each coordinate, dimension products, one sum with the offset, one spare.
      const double error = sum_error(dimension + 3, size);
      const double per_unit = 1.0 / unit.input_per_unit(normal);
      const double outer_explicit = std::max(0.0, highest[facet] + offset + error);
      const double of_scaled_hull = (1.0 + covered.gauge) * outer_explicit + covered.gauge * height;
      const double of_ball =
          std::max(outer_explicit, support_of_ball(frame, normal, covered) - height + error);
      const double outer = std::min(of_scaled_hull, of_ball) * per_unit;
      const double inner = std::min(0.0, low[facet] + offset - error) * per_unit;
      table.offsets[facet] = offset;
      table.outer[facet] = outer;
      table.inner[facet] = inner;
      part.max_outer = std::max(part.max_outer, outer);
      part.min_inner = std::min(part.min_inner, inner);
      part.max_width = std::max(part.max_width, outer - inner);
      part.roundoff = std::max(part.roundoff, sum_error(dimension + 3, size + size_input) * per_unit);

      const double cone = determinants[facet] * volume_per_determinant;
      part.volume += cone;
      if (facet >= layout.simplicial) continue;
      table.areas[facet] = static_cast<double>(frame.rank) * cone / height;
      part.area += table.areas[facet];
    }
  });
  for (const FacetSums& part : parts) {
    table.max_outer = std::max(table.max_outer, part.max_outer);
    table.min_inner = std::min(table.min_inner, part.min_inner);
    table.max_width = std::max(table.max_width, part.max_width);
    table.roundoff = std::max(table.roundoff, part.roundoff);
    table.volume += part.volume;
    table.area += part.area;
  }
  const double area_per_determinant = static_cast<double>(frame.rank) * volume_per_determinant;
  project_areas(layout, frame, normals, area_per_determinant, table.areas);
  table.surface = table.area + layout.merged_surface * area_per_determinant;
  for (std::size_t facet = layout.simplicial; facet < layout.facets; ++facet)
    table.area += table.areas[facet];
  return table;
}

}  // namespace ndhull
