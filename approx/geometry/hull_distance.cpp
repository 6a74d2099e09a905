#include "approx/geometry/hull_distance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ndhull {
namespace {

using Index = Eigen::Index;

constexpr double kUnitRoundoff = 0x1p-53;
/// Rounds in which nothing but rounding can go on: three times what most points take.
constexpr std::size_t kMaxRounds = 1000;
/// The gap is as good as closed when a column is nearer than the nearest point by less than this. [ratio of
/// sizes squared]
constexpr double kClosed = 1e-14;

/// Weights of the point nearest to 0 in the affine span of the columns: they sum to 1, and may be negative.
Eigen::VectorXd nearest_in_span(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd gram = columns.transpose() * columns;
  // Any positive number added to all entries leaves the direction of the solution as it is, and keeps the
  // matrix from being singular when 0 is in the span.
  gram.array() += std::max(gram.diagonal().maxCoeff(), 1e-300);
  Eigen::VectorXd weights = gram.ldlt().solve(Eigen::VectorXd::Ones(columns.cols()));
  return weights / weights.sum();
}

/// Wolfe's search, one column more or less at a time.
class NearestPoint {
 public:
  NearestPoint(const Eigen::Ref<const Eigen::MatrixXd>& hull, const Eigen::Ref<const Eigen::VectorXd>& point,
               HullDistance start)
      : hull_(hull), point_(point), now_(std::move(start)) {
    if (now_.places.empty()) {
      Index nearest = 0;
      (hull.colwise() - point).colwise().squaredNorm().minCoeff(&nearest);
      now_.places = {static_cast<std::uint32_t>(nearest)};
      now_.weights = Eigen::VectorXd::Ones(1);
    }
    gather();
    now_.gap = columns_ * now_.weights;
  }

  /// `closed`: two products that differ by less are the same.
  void search(double near_enough, double closed) {
    const double near_sq = near_enough * near_enough;
    for (std::size_t round = 0;; ++round) {
      const std::uint32_t entering = find_least();
      const double length_sq = now_.gap.squaredNorm();
      const bool is_known = std::find(now_.places.begin(), now_.places.end(), entering) != now_.places.end();
      if (round == kMaxRounds || is_known || length_sq <= near_sq || length_sq - least_ <= closed) return;
      const HullDistance before = now_;
      add(entering);
      if (now_.gap.squaredNorm() < length_sq) continue;
      now_ = before;  // rounding: no nearer
      find_least();
      return;
    }
  }

  /// What is proven of it; `size`: no column, and no point, is longer.
  HullDistance finish(double size) {
    // Weights sum to 1 but for their rounding, the gap is a sum of as many terms, products one of dimension
    // terms; twice that covers the roundings of sizes and bounds.
    const double terms =
        static_cast<double>(2 * now_.places.size() + 2 * static_cast<std::size_t>(hull_.rows()) + 16);
    const double error = 2.0 * terms * kUnitRoundoff * 2.0 * size;
    const double length = now_.gap.norm();
    now_.upper = length * (1.0 + terms * kUnitRoundoff) + error;
    now_.lower = length > 0.0 ? std::max(0.0, std::min(least_ / length, length) - error) : 0.0;
    return std::move(now_);
  }

 private:
  void gather() {
    columns_.resize(hull_.rows(), static_cast<Index>(now_.places.size()));
    for (Index k = 0; k < columns_.cols(); ++k)
      columns_.col(k) = hull_.col(now_.places[static_cast<std::size_t>(k)]) - point_;
  }

  /// The column that is least far along the gap.
  std::uint32_t find_least() {
    Index least = 0;
    least_ = (hull_.transpose() * now_.gap).minCoeff(&least) - point_.dot(now_.gap);
    return static_cast<std::uint32_t>(least);
  }

  /// Goes to the nearest point of the columns' hull, this one among them; those that it does not need leave.
  void add(std::uint32_t place) {
    now_.places.push_back(place);
    now_.weights.conservativeResize(now_.weights.size() + 1);
    now_.weights[now_.weights.size() - 1] = 0.0;
    gather();
    while (true) {
      const Eigen::VectorXd wanted = nearest_in_span(columns_);
      if (!wanted.allFinite()) break;
      if (wanted.minCoeff() >= 0.0) {
        now_.weights = wanted;
        break;
      }
      step_towards(wanted);
    }
    now_.weights /= now_.weights.sum();
    now_.gap = columns_ * now_.weights;
  }

  /// As far towards the wanted weights as none falls below 0; the first that would is left out.
  void step_towards(const Eigen::VectorXd& wanted) {
    double step = 1.0;
    Index leaving = 0;
    for (Index k = 0; k < wanted.size(); ++k) {
      if (wanted[k] >= 0.0) continue;
      const double ratio = now_.weights[k] / (now_.weights[k] - wanted[k]);
      if (ratio > step) continue;
      step = ratio;
      leaving = k;
    }
    now_.weights += step * (wanted - now_.weights);
    now_.weights[leaving] = 0.0;
    std::vector<std::uint32_t> places;
    std::vector<double> weights;
    for (Index k = 0; k < now_.weights.size(); ++k) {
      if (k == leaving) continue;
      places.push_back(now_.places[static_cast<std::size_t>(k)]);
      weights.push_back(std::max(now_.weights[k], 0.0));
    }
    now_.places = std::move(places);
    now_.weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Index>(weights.size()));
    gather();
  }

  const Eigen::Ref<const Eigen::MatrixXd>& hull_;
  const Eigen::Ref<const Eigen::VectorXd>& point_;
  HullDistance now_;
  Eigen::MatrixXd columns_;  // of now_.places, from the point
  double least_ = 0.0;       // product of the gap with the column that is least far along it
};

}  // namespace

HullDistance hull_distance(const Eigen::Ref<const Eigen::MatrixXd>& hull,
                           const Eigen::Ref<const Eigen::VectorXd>& point, HullDistance start,
                           const DistanceSearch& search) {
  const double size = search.size > 0.0
                          ? search.size
                          : std::max(std::sqrt(hull.colwise().squaredNorm().maxCoeff()), point.norm());
  NearestPoint nearest(hull, point, std::move(start));
  nearest.search(search.near_enough, kClosed * size * size);
  return nearest.finish(size);
}

}  // namespace ndhull
