#include "approx/outside_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "approx/frame_planes.h"

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

/// From so many points on, every so-manieth is searched first.
constexpr std::size_t kManyPoints = 1 << 15, kStep = 16;

}  // namespace

OutsideSearch::OutsideSearch(CertifiedGrowth& growth, std::vector<PointId> points, bool certifies)
    : growth_(growth), points_(std::move(points)), certifies_(certifies) {
  if (points_.empty()) return;
  dimension_ = certifies ? growth_.frame().dimension : growth_.frame().rank;
  if (!takes_input_rows()) copy_rows();
  search_among(certifies && points_.size() >= kManyPoints ? kStep : 1);
}

/// Where the input has the rows as they are wanted they need no copy.
bool OutsideSearch::takes_input_rows() {
  const PointView& input = growth_.input();
  const Frame& frame = growth_.frame();
  const std::vector<double> reference = certificate_reference(frame);
  const auto zeros = std::count(reference.begin(), reference.end(), 0.0);
  if (!certifies_ || points_.size() != input.rows || input.type != ScalarType::kFloat64 ||
      input.column_stride != 1 || zeros != std::ssize(reference))
    return false;
  rows_ = {static_cast<const double*>(input.data), input.rows, input.row_stride};
  low_ = frame.column_min;
  high_ = frame.column_max;
  return true;
}

void OutsideSearch::copy_rows() {
  const std::vector<double> reference = certificate_reference(growth_.frame());
  copy_.resize(points_.size() * dimension_);
  low_.assign(dimension_, HUGE_VAL);
  high_.assign(dimension_, -HUGE_VAL);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::size_t id = points_[i].value;
    for (std::size_t k = 0; k < dimension_; ++k) {
      const double x =
          certifies_ ? growth_.input().at(id, k) - reference[k] : growth_.coordinates()[id * dimension_ + k];
      copy_[i * dimension_ + k] = x;
      low_[k] = std::min(low_[k], x);
      high_[k] = std::max(high_[k], x);
    }
  }
  rows_ = {copy_.data(), points_.size(), dimension_};
}

void OutsideSearch::search_among(std::size_t step) {
  step_ = step;
  planes_.clear();
  furthest_.emplace(dimension_, StridedRows{rows_.data, (rows_.count + step - 1) / step, rows_.stride * step},
                    low_, high_, certifies_);
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
    if (std::memcmp(plane, planes_.data() + row * rank, rank * sizeof(double)) == 0) continue;
    std::copy_n(plane, rank, planes_.data() + row * rank);
    rows.push_back(row);
  }
  std::vector<double> normals(rows.size() * rank);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(planes_.data() + rows[i] * rank, rank, normals.data() + i * rank);
  std::vector<FurthestPoint> furthest(rows.size(), FurthestPoint{1.0});  // a plane's vertices
  if (certifies_) {
    std::fill(furthest.begin(), furthest.end(), FurthestPoint{-HUGE_VAL});
    const std::vector<double> planes = std::move(normals);
    normals.resize(rows.size() * dimension_);
    NormalMap(growth_.frame()).map(planes.data(), rows.size(), normals.data());
  }
  furthest_->find(normals, furthest);
  for (std::size_t i = 0; i < rows.size(); ++i) above_[rows[i]] = above_row(rows[i], furthest[i]);
  if (certifies_) note_known(rows, normals, furthest);
  worst_ = 0.0;
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    if (complex.state[row] == SimplexState::kLive) worst_ = std::max(worst_, above_[row].height);
}

OutsideSearch::Above OutsideSearch::above_row(std::uint32_t row, const FurthestPoint& found) const {
  if (found.row == FurthestPoint::kNoRow) return {};
  const std::size_t rank = growth_.work().rank;
  const PointId id = points_[found.row * step_];
  double gauge = -1.0;
  for (std::size_t k = 0; k < rank; ++k)
    gauge += planes_[row * rank + k] * growth_.coordinates()[std::size_t{id.value} * rank + k];
  return {height_above(growth_.work(), row, gauge), {id, SimplexId{row}, gauge}};
}

void OutsideSearch::note_known(std::span<const std::uint32_t> rows, std::span<const double> normals,
                               std::span<const FurthestPoint> furthest) {
  const std::size_t count = growth_.work().complex.row_count;
  known_.normals.resize(count * dimension_);
  known_.highest.resize(count);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::copy_n(normals.data() + i * dimension_, dimension_, known_.normals.data() + rows[i] * dimension_);
    known_.highest[rows[i]] = furthest[i].dot;
  }
}

/// Is any point further above than is allowed by now?
bool OutsideSearch::finds_above(double width, double wanted) {
  search_new_planes();
  const std::size_t live = growth_.work().complex.row_count - growth_.work().free_count;
  if (enough_ == 0) enough_ = static_cast<std::size_t>(kWorthNoSlack * static_cast<double>(live));
  limit_ = live < enough_ ? wanted : kOutsideSlack * width;
  return worst_ > limit_;
}

bool OutsideSearch::put_back_above(double width, double wanted) {
  if (!furthest_) return false;
  bool finds_some = finds_above(width, wanted);
  if (!finds_some && step_ > 1) {
    search_among(1);
    finds_some = finds_above(width, wanted);
  }
  if (!finds_some) return false;
  const SimplicialComplex& complex = growth_.work().complex;
  // The furthest alone: the simplices that they bring may well be all that the others need.
  const double share = worst_ < kFarAbove * width ? kShare : kShareFarAbove;
  const double least =
      worst_ < kNearlyThere * wanted ? wanted : std::max(limit_, worst_ - share * (worst_ - wanted));
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
  if (!furthest_) return 0.0;
  if (step_ > 1) search_among(1);
  search_new_planes();
  const SimplicialComplex& complex = growth_.work().complex;
  double largest = 0.0;
  for (std::uint32_t row = 0; row < above_.size(); ++row)
    if (complex.state[row] == SimplexState::kLive) largest = std::max(largest, above_[row].point.gauge);
  return largest;
}

}  // namespace ndhull
