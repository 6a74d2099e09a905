// Topology first: the other claims follow its ids. Then facet by facet, then all points against all outer
// planes, then the hull's own numbers; in exact mode the orientations of simplices as well.

#include "approx/verify/verify.h"

#include <algorithm>
#include <cmath>

#include "approx/planes/plane_scan.h"
#include "approx/verify/verify_facets.h"
#include "core/complex/complex_check.h"

namespace ndhull {
namespace {

/// Every stride-th outer plane.
class OuterPlanes : public PlaneSource {
 public:
  OuterPlanes(const HullClaims& hull, std::size_t stride) : hull_(hull), stride_(stride) {}
  std::size_t count() const override { return (hull_.facet_count() + stride_ - 1) / stride_; }
  CentredPlane plane(std::size_t row) const override {
    const FacetId facet{static_cast<std::uint32_t>(row * stride_)};
    return hull_.plane_at(facet, hull_.outer_offset(facet));
  }

 private:
  const HullClaims& hull_;
  std::size_t stride_;
};

void scan_outer(const PointView& points, const HullClaims& hull, std::size_t point_stride,
                std::size_t facet_stride, DoubtfulSign doubtful, Verification& result) {
  PointView some = points;
  some.rows = (points.rows + point_stride - 1) / point_stride;
  some.row_stride *= point_stride;
  const PlaneScan scan = scan_planes(some, OuterPlanes(hull, facet_stride), doubtful);
  if (scan.pairs == 0) return;
  ClaimRecord& record = result.of(Claim::kOuter);
  const double excess = scan.worst.distance;
  result.largest_outer_excess = record.checks == 0 ? excess : std::max(result.largest_outer_excess, excess);
  result.refined += scan.refined;
  record.checks += scan.pairs;
  if (scan.above == 0) return;
  if (record.failures == 0) {
    const FacetId facet{static_cast<std::uint32_t>(scan.worst.plane * facet_stride)};
    const double claimed = hull.outer_offset(facet) * hull.input_per_length_unit(facet);
    record.first_failure = "point " + std::to_string(scan.worst.point * point_stride) +
                           " is above the outer plane of facet " + std::to_string(facet.value) + ": " +
                           found_and_claimed(excess + claimed, claimed);
  }
  record.failures += scan.above;
  record.worst_excess = std::max(record.worst_excess, excess);
}

void verify_outer(const PointView& points, const HullClaims& hull, VerifyMode mode, double max_work,
                  Verification& result) {
  const double work = static_cast<double>(points.rows) * static_cast<double>(points.dimension) *
                      static_cast<double>(hull.facet_count());
  if (mode == VerifyMode::kExact || work <= max_work) {
    const auto doubtful =
        mode == VerifyMode::kExact ? DoubtfulSign::kExact : DoubtfulSign::kExtendedThenExact;
    scan_outer(points, hull, 1, 1, doubtful, result);
    return;
  }
  const auto stride = static_cast<std::size_t>(std::ceil(work / (max_work / 2)));
  scan_outer(points, hull, stride, 1, DoubtfulSign::kExtendedThenExact, result);
  scan_outer(points, hull, 1, stride, DoubtfulSign::kExtendedThenExact, result);
  result.of(Claim::kOuter).complete = false;
}

void verify_complex(const HullClaims& hull, ClaimRecord& record) {
  const SimplicialComplex& complex = hull.simplices();
  if (complex.rank == 1) {  // two ends; a row of one vertex has no orientation
    const auto names = [&](std::uint32_t row, std::uint32_t other) {
      return complex.neighbours(SimplexId{row})[0] == SimplexId{other};
    };
    record_check(record, complex.row_count == 2 && names(0, 1) && names(1, 0), [&] {
      return "a segment has two ends, each the other's neighbour: found " + std::to_string(complex.row_count);
    });
    return;
  }
  const ComplexCheck found = check_complex(complex);
  record.checks = found.simplices;
  record.failures = found.problems;
  record.first_failure = found.first_problem;
}

/// May a volume or an area of that dimension rightly be no double? Infinite when the ball around all points
/// is too large for one; 0 or subnormal when a box would be too small whose sides are the shortest extent
/// that is not 0, less what a hull is thinner at most by rounding.
bool may_be_beyond_range(const PointView& points, double measure, std::size_t power) {
  constexpr double kThinnest = 45.0;  // powers of two
  double longest = -HUGE_VAL, shortest = HUGE_VAL;
  for (std::size_t k = 0; k < points.dimension; ++k) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t row = 0; row < points.rows; ++row) {
      low = std::min(low, points.at(row, k));
      high = std::max(high, points.at(row, k));
    }
    const double half = 0.5 * high - 0.5 * low;
    if (!(half > 0.0)) continue;
    longest = std::max(longest, std::log2(half) + 1.0);
    shortest = std::min(shortest, std::log2(half) + 1.0);
  }
  const double dimension = static_cast<double>(points.dimension), factors = static_cast<double>(power);
  if (measure > 1.0)
    return factors * (longest + 0.5 * std::log2(dimension)) + std::log2(2.0 * dimension) >= 1024.0;
  return factors * (shortest - kThinnest) <= -1022.0;
}

/// Areas times normals sum up to 0 over a closed surface (Minkowski), areas times heights above any point to
/// rank times the volume. Not of clusters that are no flats: their areas are those of projections.
void verify_areas(const HullClaims& hull, const HullNumbers& numbers, ClaimRecord& record) {
  constexpr double kRoundoff = 1e-8, kRoundings = 64.0;
  if (numbers.is_approximate || !is_in_range(numbers.area) || !is_in_range(numbers.volume)) return;
  std::vector<double> normals(numbers.dimension, 0.0);
  double area = 0.0, volume = 0.0, size = 0.0, slack = 0.0, unit = 0.0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    const double share = hull.area_of(facet) / numbers.area, height = -hull.centred_offset(facet);
    area += share;
    unit = std::max(unit, hull.input_per_length_unit(facet));
    volume += share * height;
    size += share * std::abs(height);
    slack +=
        share * (hull.outer_offset(facet) - hull.inner_offset(facet)) * hull.input_per_length_unit(facet);
    for (std::size_t k = 0; k < normals.size(); ++k) normals[k] += share * hull.normal(facet)[k];
  }
  double open = 0.0;
  for (const double sum : normals) open = std::max(open, std::abs(sum));
  // Of hulls as thin as rounding areas are what rounding makes of them.
  const double rank = static_cast<double>(numbers.rank), thickness = numbers.volume / numbers.area * rank;
  const double error = kRoundoff + kRoundings * rank * numbers.roundoff * unit / thickness;
  const auto expect = [&](const char* name, double found, double claimed, double bound) {
    record_check(record, std::abs(found - claimed) <= bound,
                 [&] { return std::string(name) + ": " + found_and_claimed(found, claimed); });
  };
  expect("sum of areas, as a part of the area", area, 1.0, error);
  expect("sum of areas times normals, as a part of the area", open, 0.0, error);
  expect("sum of areas times heights, as a part of the area", volume, thickness, error * size + slack);
}

void verify_numbers(const PointView& points, const HullClaims& hull, ClaimRecord& record) {
  const HullNumbers numbers = hull.numbers();
  double outer = 0.0, inner = 0.0, width = 0.0;
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row) {
    const FacetId facet{row};
    outer = std::max(outer, hull.outer_offset(facet));
    inner = std::min(inner, hull.inner_offset(facet));
    width = std::max(width, hull.outer_offset(facet) - hull.inner_offset(facet));
    const bool signs = hull.outer_offset(facet) >= 0.0 && hull.inner_offset(facet) <= 0.0;
    record_check(record, signs && std::isfinite(hull.outer_offset(facet) - hull.inner_offset(facet)), [&] {
      return "facet " + std::to_string(row) +
             " has an outer offset below or an inner offset above 0: outer " +
             found_and_claimed(hull.outer_offset(facet), 0.0);
    });
  }
  const auto expect = [&](const char* name, double found, double claimed, bool holds) {
    record_check(record, holds, [&] { return std::string(name) + ": " + found_and_claimed(found, claimed); });
  };
  expect("largest outer offset", outer, numbers.max_outer_offset, outer == numbers.max_outer_offset);
  expect("lowest inner offset", inner, numbers.min_inner_offset, inner == numbers.min_inner_offset);
  // The difference rounds; a claim may be rounded up, never down.
  const bool width_holds =
      numbers.max_facet_width >= width && numbers.max_facet_width <= std::nextafter(width, HUGE_VAL);
  expect("largest facet width", width, numbers.max_facet_width, width_holds);
  if (numbers.rank < 2) return;
  const auto expect_size = [&](const char* name, double claimed, std::size_t power) {
    const bool is_number = claimed >= 0.0;  // NaN is none
    expect(name, 0.0, claimed,
           is_in_range(claimed) || (is_number && may_be_beyond_range(points, claimed, power)));
  };
  expect_size("volume, expected above 0", numbers.volume, numbers.rank);
  expect_size("area, expected above 0", numbers.area, numbers.rank - 1);
  verify_areas(hull, numbers, record);
}

}  // namespace

Verification verify_claims(const PointView& points, const HullClaims& hull, VerifyMode mode,
                           double max_outer_work) {
  Verification result;
  result.mode = mode;
  const HullNumbers numbers = hull.numbers();
  ClaimRecord& numbers_record = result.of(Claim::kNumbers);
  record_check(numbers_record, numbers.dimension == points.dimension && numbers.point_count == points.rows,
               [&] {
                 return "the hull is of " + std::to_string(numbers.point_count) + " points in " +
                        std::to_string(numbers.dimension) + "-d: found " + std::to_string(points.rows) +
                        " points in " + std::to_string(points.dimension) + "-d";
               });
  if (numbers_record.failures > 0 || numbers.rank == 0) return result;

  verify_complex(hull, result.of(Claim::kComplex));
  const auto doubtful = mode == VerifyMode::kExact ? DoubtfulSign::kExact : DoubtfulSign::kExtendedThenExact;
  verify_facets(points, hull, doubtful, result);
  verify_outer(points, hull, mode, max_outer_work, result);
  verify_numbers(points, hull, numbers_record);
  const bool ids_are_sound =
      result.of(Claim::kComplex).failures == 0 && result.of(Claim::kFacets).failures == 0;
  if (mode == VerifyMode::kExact && ids_are_sound && numbers.rank == numbers.dimension && numbers.rank >= 2) {
    verify_orientation(points, hull, result);
  }
  return result;
}

}  // namespace ndhull
