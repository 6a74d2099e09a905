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

}  // namespace

HullDistance hull_distance(const Eigen::Ref<const Eigen::MatrixXd>& hull,
                           const Eigen::Ref<const Eigen::VectorXd>& point, HullDistance start,
                           const DistanceSearch& search) {
  HullDistance result = std::move(start);
  const double size = search.size > 0.0
                          ? search.size
                          : std::max(std::sqrt(hull.colwise().squaredNorm().maxCoeff()), point.norm());
  if (result.places.empty()) {
    Index nearest = 0;
    (hull.colwise() - point).colwise().squaredNorm().minCoeff(&nearest);
    result.places = {static_cast<std::uint32_t>(nearest)};
    result.weights = Eigen::VectorXd::Ones(1);
  }
  Eigen::MatrixXd columns;
  const auto gather = [&] {
    columns.resize(hull.rows(), static_cast<Index>(result.places.size()));
    for (Index k = 0; k < columns.cols(); ++k) {
      columns.col(k) = hull.col(result.places[static_cast<std::size_t>(k)]) - point;
    }
  };
  gather();
  result.gap = columns * result.weights;
  const double closed = kClosed * size * size;
  const double near_sq = search.near_enough * search.near_enough;
  double least = 0.0;  // product of the gap with the column that is least far along it
  for (std::size_t round = 0;; ++round) {
    Index entering = 0;
    least = (hull.transpose() * result.gap).minCoeff(&entering) - point.dot(result.gap);
    const double length_sq = result.gap.squaredNorm();
    const auto place = static_cast<std::uint32_t>(entering);
    const bool is_known = std::find(result.places.begin(), result.places.end(), place) != result.places.end();
    if (round == kMaxRounds || is_known || length_sq <= near_sq || length_sq - least <= closed) break;
    const HullDistance before = result;
    result.places.push_back(place);
    result.weights.conservativeResize(result.weights.size() + 1);
    result.weights[result.weights.size() - 1] = 0.0;
    gather();
    while (true) {
      const Eigen::VectorXd wanted = nearest_in_span(columns);
      if (!wanted.allFinite()) break;
      if (wanted.minCoeff() >= 0.0) {
        result.weights = wanted;
        break;
      }
      // As far towards the wanted weights as none falls below 0; the first that would is left out.
      double step = 1.0;
      Index leaving = 0;
      for (Index k = 0; k < wanted.size(); ++k) {
        if (wanted[k] >= 0.0) continue;
        const double ratio = result.weights[k] / (result.weights[k] - wanted[k]);
        if (ratio > step) continue;
        step = ratio;
        leaving = k;
      }
      result.weights += step * (wanted - result.weights);
      result.weights[leaving] = 0.0;
      std::vector<std::uint32_t> places;
      std::vector<double> weights;
      for (Index k = 0; k < result.weights.size(); ++k) {
        if (k == leaving) continue;
        places.push_back(result.places[static_cast<std::size_t>(k)]);
        weights.push_back(std::max(result.weights[k], 0.0));
      }
      result.places = std::move(places);
      result.weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Index>(weights.size()));
      gather();
    }
    result.weights /= result.weights.sum();
    result.gap = columns * result.weights;
    if (!(result.gap.squaredNorm() < length_sq)) {  // rounding: no nearer
      result = before;
      least = (hull.transpose() * result.gap).minCoeff() - point.dot(result.gap);
      break;
    }
  }
  // Weights sum to 1 but for their rounding, the gap is a sum of as many terms, products one of dimension
  // terms; twice that covers the roundings of sizes and bounds.
  const double terms =
      static_cast<double>(2 * result.places.size() + 2 * static_cast<std::size_t>(hull.rows()) + 16);
  const double error = 2.0 * terms * kUnitRoundoff * 2.0 * size;
  const double length = result.gap.norm();
  result.upper = length * (1.0 + terms * kUnitRoundoff) + error;
  result.lower = length > 0.0 ? std::max(0.0, std::min(least / length, length) - error) : 0.0;
  return result;
}

}  // namespace ndhull
