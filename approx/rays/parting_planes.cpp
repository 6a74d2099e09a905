#include "approx/rays/parting_planes.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/machine/blocks.h"
#include "core/plane_value.h"

namespace ndhull {
namespace {

double sign_at(const PartingPlane& plane, std::span<const double> point, double claimed) {
  return plane_sign({plane.normal, {}, plane.offset, claimed, 1.0}, point, DoubtfulSign::kExtendedThenExact);
}

/// One plane in doubt, beside all points.
class Settling {
 public:
  Settling(const PointView& points, std::span<const double> in_frame, double near, PartingPlane& plane)
      : points_(points),
        in_frame_(in_frame),
        rank_(in_frame.size() / points.rows),
        near_(near),
        plane_(plane),
        vertex_(points.dimension),
        other_(points.dimension) {
    points.copy_row(plane.vertex, vertex_.data());
  }

  /// Settles the plane, if an offset parts the vertex.
  void run() {
    const double room = room_below_vertex();
    if (!(room > 0.0) || !choose_offset(room)) return;
    plane_.is_settled = true;
    for (const std::uint32_t id : near_ids_) {
      points_.copy_row(id, other_.data());
      if (is_above(plane_, other_)) plane_.above.push_back(id);
    }
  }

 private:
  bool is_near(std::uint32_t id) const {
    double distance_sq = 0.0;
    for (std::size_t k = 0; k < rank_; ++k) {
      const double difference = in_frame_[id * rank_ + k] - in_frame_[plane_.vertex * rank_ + k];
      distance_sq += difference * difference;
    }
    return distance_sq <= near_ * near_;
  }

  /// At least so far below the vertex, along the normal, are all points that are not near to it.
  double room_below_vertex() {
    double highest = -HUGE_VAL;
    const CentredPlane from_vertex{plane_.normal, vertex_, 0.0, 0.0, 1.0};
    const auto upper = [](const BoundedValue& value) { return value.value + value.error; };
    for (std::uint32_t id = 0; id < points_.rows; ++id) {
      if (id == plane_.vertex) continue;
      points_.copy_row(id, other_.data());
      if (upper(plane_value_double(from_vertex, other_)) <= highest) continue;
      if (is_near(id)) {
        near_ids_.push_back(id);
        continue;
      }
      const double height = upper(plane_value_extended(from_vertex, other_));
      highest = std::isnan(height) ? HUGE_VAL : std::max(highest, height);
    }
    return -highest;
  }

  /// The vertex above the plane, and below the plane `room` higher: then what is `room` below it is below.
  bool choose_offset(double room) {
    const double own = plane_value_extended({plane_.normal, {}, 0.0, 0.0, 1.0}, vertex_).value;
    for (const double offset : {0.5 * room - own, -own, std::nextafter(-own, HUGE_VAL)}) {
      plane_.offset = offset;
      if (sign_at(plane_, vertex_, 0.0) > 0.0 && sign_at(plane_, vertex_, room) < 0.0) return true;
    }
    return false;
  }

  const PointView& points_;
  std::span<const double> in_frame_;
  std::size_t rank_;
  double near_;
  PartingPlane& plane_;
  std::vector<double> vertex_, other_;
  std::vector<std::uint32_t> near_ids_;
};

}  // namespace

PartingPlaneMap::PartingPlaneMap(const PointView& points, const Frame& frame, std::span<const double> origin)
    : frame_(frame),
      origin_(origin),
      to_input_(frame),
      off_the_subspace_(distance_off_subspace(points, frame)) {
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    reach_.push_back(std::max(std::abs(frame.column_min[k] - frame.centre[k]),
                              std::abs(frame.column_max[k] - frame.centre[k])));
  }
}

PartingPlane PartingPlaneMap::map(std::uint32_t vertex, std::span<const double> plane, double level,
                                  double gap) const {
  PartingPlane out;
  out.vertex = vertex;
  out.normal.resize(frame_.dimension);
  double length = 0.0;
  to_input_.map(plane.data(), 1, out.normal.data(), &length);
  // a.y = level with a.y = length normal.(x - centre), in the subspace
  out.offset = -level / length;
  double size = std::abs(out.offset), slope = 1.0;
  for (std::size_t k = 0; k < frame_.dimension; ++k) {
    double terms = 0.0;  // that the normal's entry is a sum of
    for (std::size_t row = 0; row < frame_.rank; ++row)
      terms += std::abs(plane[row] * frame_.map[row * frame_.dimension + k]);
    slope += terms / length;
    out.offset -= out.normal[k] * (frame_.centre[k] + origin_[k]);
    size += std::abs(out.normal[k]) * (std::abs(frame_.centre[k]) + 2.0 * std::abs(origin_[k])) +
            (terms / length + std::abs(out.normal[k])) * reach_[k];
  }
  out.gap = gap / length;
  out.rounding = 4.0 * sum_error(frame_.dimension + frame_.rank, size) + slope * off_the_subspace_;
  return out;
}

bool settle_planes(const PointView& points, std::span<const double> in_frame, double near,
                   const std::function<bool()>& is_late, std::vector<PartingPlane>& planes) {
  std::vector<double> vertex(points.dimension);
  const auto is_doubtful = [&](const PartingPlane& plane) {
    if (plane.is_settled) return false;
    points.copy_row(plane.vertex, vertex.data());
    return !(plane.gap > plane.rounding) || !is_above(plane, vertex);
  };
  std::vector<PartingPlane*> doubtful;
  for (PartingPlane& plane : planes)
    if (is_doubtful(plane)) doubtful.push_back(&plane);
  std::atomic<bool> is_whole = true;
  for_each_block(doubtful.size(), 1, [&](std::size_t row, std::size_t) {
    if (is_late()) {
      is_whole = false;
    } else {
      Settling(points, in_frame, near, *doubtful[row]).run();
    }
  });
  std::erase_if(planes, is_doubtful);
  return is_whole;
}

bool is_above(const PartingPlane& plane, std::span<const double> point) {
  return sign_at(plane, point, 0.0) > 0.0;
}

}  // namespace ndhull
