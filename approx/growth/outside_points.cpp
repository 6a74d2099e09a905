#include "approx/growth/outside_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "approx/geometry/frame_planes.h"

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

/// Few enough that what is listed for each takes little memory.
constexpr std::size_t kPlanesAtATime = 1 << 16;

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
  searched_.clear();
  furthest_.emplace(dimension_, StridedRows{rows_.data, (rows_.count + step - 1) / step, rows_.stride * step},
                    low_, high_, certifies_);
}

void OutsideSearch::search_new_planes() {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t rank = complex.rank, count = complex.row_count;
  searched_.resize(count * rank, PointId::kNone);
  above_.resize(count);
  if (certifies_) {
    known_.normals.resize(count * dimension_);
    known_.highest.resize(count);
  }
  std::vector<std::uint32_t> rows;
  worst_ = 0.0;
  for (std::uint32_t row = 0; row < count; ++row) {
    if (complex.state[row] != SimplexState::kLive) continue;
    const auto vertices = complex.vertices(SimplexId{row});
    std::uint32_t* searched = searched_.data() + row * rank;
    if (std::memcmp(vertices.data(), searched, rank * sizeof(PointId)) == 0) {
      worst_ = std::max(worst_, above_[row].height);
    } else {
      std::memcpy(searched, vertices.data(), rank * sizeof(PointId));
      rows.push_back(row);
    }
  }
  furthest_->expect(rows.size());
  for (std::size_t begin = 0; begin < rows.size(); begin += kPlanesAtATime)
    search_rows(std::span(rows).subspan(begin, std::min(kPlanesAtATime, rows.size() - begin)));
}

void OutsideSearch::search_rows(std::span<const std::uint32_t> rows) {
  const SimplicialComplex& complex = growth_.work().complex;
  const std::size_t rank = complex.rank;
  std::vector<double> planes(rows.size() * rank), normals;
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(complex.plane(SimplexId{rows[i]}).data(), rank, planes.data() + i * rank);
  std::vector<FurthestPoint> furthest(rows.size(), FurthestPoint{certifies_ ? -HUGE_VAL : 1.0});
  if (certifies_) {
    normals.resize(rows.size() * dimension_);
    NormalMap(growth_.frame()).map(planes.data(), rows.size(), normals.data());
  }
  furthest_->find(certifies_ ? normals : planes, furthest);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    above_[rows[i]] = above_row(rows[i], furthest[i]);
    worst_ = std::max(worst_, above_[rows[i]].height);
    if (!certifies_) continue;
    std::copy_n(normals.data() + i * dimension_, dimension_, known_.normals.data() + rows[i] * dimension_);
    known_.highest[rows[i]] = furthest[i].dot;
  }
}

OutsideSearch::Above OutsideSearch::above_row(std::uint32_t row, const FurthestPoint& found) const {
  if (found.row == FurthestPoint::kNoRow) return {};
  const GrowthWork& work = growth_.work();
  const PointId id = points_[found.row * step_];
  const auto plane = work.complex.plane(SimplexId{row});
  double gauge = -1.0;
  for (std::size_t k = 0; k < work.rank; ++k)
    gauge += plane[k] * growth_.coordinates()[std::size_t{id.value} * work.rank + k];
  return {height_above(work, row, gauge), {id, SimplexId{row}, gauge}};
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
