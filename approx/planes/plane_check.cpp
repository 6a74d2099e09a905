#include "approx/planes/plane_check.h"

#include <algorithm>
#include <string>

#include "approx/planes/plane_scan.h"
#include "core/error.h"
#include "core/machine/arena.h"

namespace ndhull {
namespace {

/// Rows a, b of one array.
class PlaneRows : public PlaneSource {
 public:
  PlaneRows(std::span<const double> rows, std::size_t dimension) : rows_(rows), dimension_(dimension) {}
  std::size_t count() const override { return rows_.size() / (dimension_ + 1); }
  CentredPlane plane(std::size_t row) const override {
    const std::span<const double> values = rows_.subspan(row * (dimension_ + 1), dimension_ + 1);
    return {.normal = values.first(dimension_), .reference = {}, .offset = values[dimension_]};
  }

 private:
  std::span<const double> rows_;
  std::size_t dimension_;
};

void refuse_unusable(const PointView& points, std::span<const double> planes) {
  const std::size_t columns = points.dimension + 1;
  if (planes.size() % columns != 0) {
    throw Error(ErrorCode::kUsage, "planes: found " + std::to_string(planes.size()) +
                                       " numbers, expected rows of " + std::to_string(columns) +
                                       ": the dimension of the points and one more");
  }
  if (points.rows >= PointId::kNone) {
    throw Error(ErrorCode::kTooManyPoints, "points: found " + std::to_string(points.rows) +
                                               " rows, expected less than 4294967295; check them in parts");
  }
  for (std::size_t row = 0; row * columns < planes.size(); ++row) {
    const auto normal = planes.subspan(row * columns, points.dimension);
    if (std::all_of(normal.begin(), normal.end(), [](double value) { return value == 0.0; })) {
      throw Error(
          ErrorCode::kBadHalfspace,
          "plane " + std::to_string(row) + ": found a zero normal, expected a direction; remove the row");
    }
  }
}

}  // namespace

PlaneCheck check_planes(const PointView& points, std::span<const double> planes, unsigned threads) {
  refuse_unusable(points, planes);
  const PlaneRows rows(planes, points.dimension);
  tbb::task_arena arena = arena_of(threads);
  const PlaneScan scan =
      arena.execute([&] { return scan_planes(points, rows, DoubtfulSign::kExtendedThenExact); });
  PlaneCheck check;
  check.pairs = scan.pairs;
  check.above = scan.above;
  if (scan.pairs > 0) {
    check.worst_distance = scan.worst.distance;
    check.worst_point = PointId{static_cast<std::uint32_t>(scan.worst.point)};
    check.worst_plane = scan.worst.plane;
  }
  return check;
}

}  // namespace ndhull
