// A vertex whose nearest point is known stays as far away when a new one is chosen that lies behind the plane
// across its gap. Others are marked, and looked at again when they come to the head of the queue: distances
// only fall, so the furthest that is up to date is the furthest of all. Eight are looked at together, which
// is as many for any number of threads.
#include "approx/reduction/kept_points.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <queue>
#include <string>

#include "approx/geometry/hull_distance.h"
#include "core/error.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kLooksAtATime = 8;
/// A point found this near to one, as a part of what is enough, ends the search for the nearest.
constexpr double kWellWithin = 0.99;
/// Points that are this little outside the others' hull are no vertices (extreme_points). [ratio]
constexpr double kVertexRounding = 4e-12;

/// A power of two, about the largest of some coordinates: in such units squares are neither 0 nor infinite.
double unit_of(double largest) { return largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest)) : 1.0; }

/// In input units, about the centre.
Eigen::MatrixXd gather_columns(const PointView& points, std::span<const PointId> ids,
                               std::span<const double> centre) {
  Eigen::MatrixXd columns(static_cast<Index>(points.dimension), static_cast<Index>(ids.size()));
  for (std::size_t row = 0; row < ids.size(); ++row) {
    for (std::size_t k = 0; k < points.dimension; ++k) {
      columns(static_cast<Index>(k), static_cast<Index>(row)) = points.at(ids[row].value, k) - centre[k];
    }
  }
  return columns;
}

/// The greedy choice.
class Chooser {
 public:
  Chooser(const PointView& points, std::span<const PointId> vertices, std::span<const double> centre,
          const KeepOptions& options)
      : vertices_(vertices),
        columns_(gather_columns(points, vertices, centre)),
        unit_(unit_of(columns_.cwiseAbs().maxCoeff())),
        kept_(columns_.leftCols(static_cast<Index>(options.given))),
        found_(vertices.size()),
        is_current_(vertices.size(), false),
        is_kept_(vertices.size(), false),
        enough_(options.enough / unit_) {
    columns_ /= unit_;
    kept_ /= unit_;
    size_ = std::sqrt(columns_.colwise().squaredNorm().maxCoeff());
    const auto first = static_cast<std::uint32_t>(options.given);
    for (std::uint32_t row = first; row < vertices_.size(); ++row) queue_.push({HUGE_VAL, row});
  }

  std::size_t furthest_from_centre() const {
    Index furthest = 0;
    columns_.colwise().squaredNorm().maxCoeff(&furthest);
    return static_cast<std::size_t>(furthest);
  }

  void keep(std::size_t vertex) {
    is_kept_[vertex] = true;
    kept_.conservativeResize(Eigen::NoChange, kept_.cols() + 1);
    kept_.col(kept_.cols() - 1) = columns_.col(static_cast<Index>(vertex));
    std::erase_if(far_, [&](std::uint32_t row) { return found_[row].upper <= enough_; });
    for_each_block(far_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i != end; ++i) {
        const HullDistance& known = found_[far_[i]];
        const Eigen::VectorXd edge = kept_.col(kept_.cols() - 1) - columns_.col(static_cast<Index>(far_[i]));
        if (edge.dot(known.gap) < known.lower * known.gap.norm()) is_current_[far_[i]] = 0;
      }
    });
    // Known, where a search among others could not tell it from them.
    HullDistance& own = found_[vertex];
    own = HullDistance{};
    own.places = {static_cast<std::uint32_t>(kept_.cols() - 1)};
    own.weights = Eigen::VectorXd::Ones(1);
    own.gap = Eigen::VectorXd::Zero(columns_.rows());
    is_current_[vertex] = 1;
  }

  /// The vertex that is furthest from the hull of those kept, or one that is near enough as all are. There is
  /// one that was not given.
  std::size_t furthest() {
    while (true) {
      while (queue_.size() > 1 && is_kept_[queue_.top().vertex]) queue_.pop();
      std::vector<std::uint32_t> looks;
      while (looks.size() < kLooksAtATime && !queue_.empty() && queue_.top().distance > enough_ &&
             is_current_[queue_.top().vertex] == 0) {
        looks.push_back(queue_.top().vertex);
        queue_.pop();
      }
      if (looks.empty()) return queue_.top().vertex;
      for (const std::uint32_t vertex : looks)
        if (found_[vertex].places.empty()) far_.push_back(vertex);
      for_each_block(looks.size(), 1, [&](std::size_t one, std::size_t) {
        HullDistance& known = found_[looks[one]];
        known = hull_distance(kept_, columns_.col(static_cast<Index>(looks[one])), std::move(known),
                              {.near_enough = kWellWithin * enough_, .size = size_});
        is_current_[looks[one]] = 1;
      });
      for (const std::uint32_t vertex : looks) queue_.push({found_[vertex].upper, vertex});
    }
  }

  /// Looks at all again that may be nearer by now.
  void measure_all() {
    constexpr std::size_t kAtATime = 16;
    for_each_block(vertices_.size(), kAtATime, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row != end; ++row) {
        HullDistance& known = found_[row];
        if (known.places.empty() || known.upper <= vertex_rounding()) continue;
        known =
            hull_distance(kept_, columns_.col(static_cast<Index>(row)), std::move(known), {.size = size_});
      }
    });
  }

  /// In `unit`s.
  const HullDistance& distance(std::size_t vertex) const { return found_[vertex]; }
  double vertex_rounding() const { return kVertexRounding * size_; }
  /// [input units]
  double unit() const { return unit_; }
  std::vector<double> distances() const {
    std::vector<double> distances(found_.size());
    std::transform(found_.begin(), found_.end(), distances.begin(),
                   [this](const HullDistance& known) { return known.upper * unit_; });
    return distances;
  }

 private:
  struct Entry {
    double distance;
    std::uint32_t vertex;
    bool operator<(const Entry& other) const {
      return distance != other.distance ? distance < other.distance : vertex > other.vertex;
    }
  };

  std::span<const PointId> vertices_;
  Eigen::MatrixXd columns_;  // about the centre; all lengths are in units
  double unit_;
  Eigen::MatrixXd kept_;
  std::vector<HullDistance> found_;
  std::vector<std::uint8_t> is_current_, is_kept_;  // is_kept_: not of those given
  std::vector<std::uint32_t> far_;                  // those looked at that were further than enough, at least
  std::priority_queue<Entry> queue_;                // one entry a vertex that was not given
  double enough_;
  double size_ = 0.0;
};

void check_centre(const PointView& points, std::span<const double> centre) {
  if (centre.size() == points.dimension) return;
  throw Error(ErrorCode::kUsage, "centre: found " + std::to_string(centre.size()) +
                                     " numbers, expected one a column: " + std::to_string(points.dimension));
}

}  // namespace

KeptPoints keep_points(const PointView& points, std::span<const PointId> vertices,
                       std::span<const double> centre, const KeepOptions& options) {
  KeptPoints result;
  if (vertices.empty()) return result;
  check_centre(points, centre);
  if (options.given > vertices.size() || !(options.enough >= 0.0))
    throw Error(ErrorCode::kUsage, "points to keep: found " + std::to_string(options.given) + " given of " +
                                       std::to_string(vertices.size()) + " vertices, enough at " +
                                       std::to_string(options.enough) +
                                       ", expected no more than there are, and a distance from 0");
  Chooser chooser(points, vertices, centre, options);
  result.points.assign(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(options.given));
  result.left.resize(vertices.size());
  if (options.given == vertices.size()) return result;
  std::size_t next = options.given > 0 ? chooser.furthest() : chooser.furthest_from_centre();
  double last_distance = HUGE_VAL;
  while (true) {
    chooser.keep(next);
    result.points.push_back(vertices[next]);
    next = chooser.furthest();
    const HullDistance& furthest = chooser.distance(next);
    last_distance = std::min(last_distance, (furthest.upper + chooser.vertex_rounding()) * chooser.unit());
    result.distances.push_back(last_distance);
    result.lower = furthest.lower * chooser.unit();
    if (result.points.size() >= std::min(options.count, vertices.size())) break;
    // Not by `lower`: where the hull is flat 0 is often all that is proven of a point outside.
    const double enough = std::max(options.enough / chooser.unit(), chooser.vertex_rounding());
    if (furthest.upper <= enough || options.stop.stop_requested()) break;
    if (options.progress) {
      options.progress("kept " + std::to_string(result.points.size()) + ", distance " +
                       std::to_string(last_distance));
    }
  }
  if (options.measures_left) chooser.measure_all();
  result.left = chooser.distances();
  return result;
}

std::vector<double> distances_from_hull(const PointView& points, std::span<const PointId> hull,
                                        std::span<const double> centre) {
  check_centre(points, centre);
  if (hull.empty()) throw Error(ErrorCode::kEmptyInput, "hull: found no points, expected one or more");
  double largest = 0.0;
  for (std::size_t row = 0; row < points.rows; ++row)
    for (std::size_t k = 0; k < points.dimension; ++k)
      largest = std::max(largest, std::abs(points.at(row, k) - centre[k]));
  const double unit = unit_of(largest);
  const Eigen::MatrixXd columns = gather_columns(points, hull, centre) / unit;
  std::vector<double> distances(points.rows);
  for_each_block(points.rows, 1, [&](std::size_t row, std::size_t) {
    Eigen::VectorXd point(static_cast<Index>(points.dimension));
    for (std::size_t k = 0; k < points.dimension; ++k) {
      point[static_cast<Index>(k)] = (points.at(row, k) - centre[k]) / unit;
    }
    distances[row] = hull_distance(columns, point).upper * unit;
  });
  return distances;
}

}  // namespace ndhull
