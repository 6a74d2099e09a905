#include "approx/outside_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ndhull {
namespace {

/// A point that is less than W above the simplex it lies over may be this much more above another one when
/// that would cost many simplices: taking all of those in costs 2.3 times the facets on 10^5 sphere points in
/// 8-d with W 0.3.
constexpr double kOutsideSlack = 1.045;
/// So many times the simplices that W alone brings are worth having no point further above than W.
constexpr double kWorthNoSlack = 1.5;

/// Once no point is further above than this many W, all that are further than W go back.
constexpr double kNearlyThere = 1.02;

/// Else those that are above by more than the furthest point less this part of what it is above W. With a
/// half there are a third more simplices on 10^5 sphere points in 8-d with W 0.3; where the furthest is more
/// than this many W above, a half is near enough.
constexpr double kShare = 0.2, kShareFarAbove = 0.5, kFarAbove = 1.5;

}  // namespace

OutsideSearch::OutsideSearch(CertifiedGrowth& growth, std::vector<PointId> points)
    : growth_(growth), points_(std::move(points)) {
  if (points_.empty()) return;
  const std::size_t rank = growth_.work().rank;
  if (points_.size() == growth_.work().point_count) {  // ascending: all of them
    tree_.emplace(rank, std::span<const double>(growth_.coordinates(), points_.size() * rank));
    return;
  }
  std::vector<double> rows(points_.size() * rank);
  for (std::size_t i = 0; i < points_.size(); ++i)
    std::copy_n(growth_.coordinates() + std::size_t{points_[i].value} * rank, rank, rows.data() + i * rank);
  tree_.emplace(rank, rows);
}

void OutsideSearch::search_new_planes() {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t rank = complex.rank;
  planes_.resize(complex.row_count * rank, 0.0);
  above_.resize(complex.row_count);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const double* plane = complex.plane(SimplexId{row}).data();
    if (complex.state[row] != SimplexState::kLive) continue;
    if (std::memcmp(plane, planes_.data() + row * rank, rank * sizeof(double)) != 0) rows.push_back(row);
  }
  std::vector<double> normals(rows.size() * rank);
  std::vector<FurthestPoint> furthest(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(complex.plane(SimplexId{rows[i]}).data(), rank, normals.data() + i * rank);
    furthest[i].dot = 1.0;  // its vertices
  }
  find_furthest(*tree_, normals, furthest);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(normals.data() + i * rank, rank, planes_.data() + rows[i] * rank);
    const FurthestPoint& found = furthest[i];
    const double gauge = found.dot - 1.0;
    const PointId id = found.row == FurthestPoint::kNoRow ? PointId{} : points_[found.row];
    above_[rows[i]] = {height_above(growth_.work(), rows[i], gauge), {id, SimplexId{rows[i]}, gauge}};
  }
}

bool OutsideSearch::put_back_above(double width) {
  if (!tree_) return false;
  search_new_planes();
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t live = complex.row_count - growth_.work().free_count;
  if (enough_ == 0) enough_ = static_cast<std::size_t>(kWorthNoSlack * static_cast<double>(live));
  double worst = 0.0;
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    if (complex.state[row] == SimplexState::kLive) worst = std::max(worst, above_[row].height);
  if (worst <= (live < enough_ ? 1.0 : kOutsideSlack) * width) return false;
  // The furthest alone: the simplices that they bring may well be all that the others need.
  const double share = worst < kFarAbove * width ? kShare : kShareFarAbove;
  const double least = worst < kNearlyThere * width ? width : worst - share * (worst - width);
  std::vector<Above> back;
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (complex.state[row] == SimplexState::kLive && above_[row].height >= least) back.push_back(above_[row]);
  }
  // Each point once, above the plane that it is furthest from.
  std::sort(back.begin(), back.end(), [](const Above& a, const Above& b) {
    if (a.point.point != b.point.point) return a.point.point < b.point.point;
    return a.height != b.height ? a.height > b.height : a.point.simplex < b.point.simplex;
  });
  std::vector<LocatedPoint> points;
  for (const Above& above : back)
    if (points.empty() || points.back().point != above.point.point) points.push_back(above.point);
  growth_.put_back(points);
  return true;
}

double OutsideSearch::largest_gauge() {
  if (!tree_) return 0.0;
  search_new_planes();
  const SimplicialComplex& complex = growth_.work().complex;
  double largest = 0.0;
  for (std::uint32_t row = 0; row < above_.size(); ++row)
    if (complex.state[row] == SimplexState::kLive) largest = std::max(largest, above_[row].point.gauge);
  return largest;
}

}  // namespace ndhull
