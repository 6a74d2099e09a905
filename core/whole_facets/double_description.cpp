#include "core/whole_facets/double_description.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/linear/dense_solve.h"
#include "core/linear/simplex_planes.h"

namespace ndhull {
namespace {

using Index = Eigen::Index;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Coordinates in which the covariance is the unit matrix, from the mean: affine images of a set have the
/// same, up to a rotation.
RowMatrix whiten(const double* points, std::size_t count, std::size_t rank) {
  RowMatrix rows = Eigen::Map<const RowMatrix>(points, static_cast<Index>(count), static_cast<Index>(rank));
  const Eigen::VectorXd mean = rows.colwise().mean();
  rows.rowwise() -= mean.transpose();
  const Eigen::MatrixXd covariance = rows.transpose() * rows / static_cast<double>(count);
  return rows * whitening_map(covariance);
}

/// Numbers that are equal to six digits become equal.
void quantise(std::vector<double>& keys) {
  constexpr double kSteps = 1e6;
  double largest = 0.0;
  for (const double key : keys) largest = std::max(largest, std::abs(key));
  for (double& key : keys) {
    const double steps = std::round(key / largest * kSteps);
    key = std::isfinite(steps) ? steps : 0.0;
  }
}

}  // namespace

DoubleDescription::DoubleDescription(const double* points, std::size_t count, std::size_t rank,
                                     std::span<const PointId> simplex, std::uint64_t most_words)
    : points_(points),
      count_(count),
      rank_(rank),
      words_((count + 63) / 64),
      most_words_(std::min(most_words, std::uint64_t{1} << 25)) {
  choose_order(simplex);
  start(simplex);
}

void DoubleDescription::choose_order(std::span<const PointId> simplex) {
  const RowMatrix rows = whiten(points_, count_, rank_);
  const auto row = [&](PointId id) { return rows.row(static_cast<Index>(id.value)); };
  Eigen::RowVectorXd centre = Eigen::RowVectorXd::Zero(static_cast<Index>(rank_));
  for (const PointId id : simplex) centre += row(id) / static_cast<double>(simplex.size());
  // The keys, the first that differs decides: how far from the mean, how far from the simplex, and how far
  // along its edges.
  std::vector<std::vector<double>> keys(2 + rank_, std::vector<double>(count_));
  for (std::uint32_t id = 0; id < count_; ++id) {
    keys[0][id] = -row(PointId{id}).squaredNorm();
    keys[1][id] = (row(PointId{id}) - centre).squaredNorm();
    for (std::size_t k = 0; k < rank_; ++k)
      keys[2 + k][id] = row(PointId{id}).dot(row(simplex[k]) - row(simplex[k + 1]));
  }
  for (std::vector<double>& key : keys) quantise(key);
  std::vector<bool> is_corner(count_, false);
  for (const PointId id : simplex) {
    is_corner[id.value] = true;
    order_.push_back(id.value);
  }
  for (std::uint32_t id = 0; id < count_; ++id)
    if (!is_corner[id]) order_.push_back(id);
  std::sort(order_.begin() + static_cast<std::ptrdiff_t>(simplex.size()), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) {
              for (const std::vector<double>& key : keys)
                if (key[a] != key[b]) return key[a] < key[b];
              return a < b;
            });
}

void DoubleDescription::start(std::span<const PointId> simplex) {
  const std::vector<Eigen::VectorXd> planes = simplex_planes(points_, rank_, simplex);
  for (std::size_t left_out = 0; left_out <= rank_; ++left_out) {
    const std::uint32_t row = make_row();
    for (std::size_t place = 0; place <= rank_; ++place) {
      if (place == left_out) continue;
      set_bit(row, place);
      neighbours_[row].push_back(static_cast<std::uint32_t>(place));
    }
    std::copy_n(planes[left_out].data(), rank_, planes_.data() + row * rank_);
    sides_[row] = Side::kBelow;
  }
  next_ = rank_ + 1;
}

std::uint32_t DoubleDescription::make_row() {
  ++created_;
  ++live_;
  if (!free_.empty()) {
    const std::uint32_t row = free_.back();
    free_.pop_back();
    std::fill_n(bits(row), words_, 0);
    neighbours_[row].clear();
    return row;
  }
  const auto row = static_cast<std::uint32_t>(sides_.size());
  sides_.push_back(Side::kFree);
  gauges_.push_back(0.0);
  planes_.resize(planes_.size() + rank_);
  bits_.resize(bits_.size() + words_);
  neighbours_.emplace_back();
  return row;
}

DoubleDescription::Outcome DoubleDescription::run(std::uint64_t work) {
  const std::uint64_t end = work_ + work;
  while (next_ < order_.size()) {
    if (work_ >= end) return Outcome::kGoing;
    if (bits_.size() > most_words_ || !add(next_)) return Outcome::kGivenUp;
    ++next_;
  }
  return Outcome::kDone;
}

/// Which facets the point is above, below or on; false: of one it cannot be said.
bool DoubleDescription::classify(const double* point) {
  above_.clear();
  through_.clear();
  for (std::uint32_t row = 0; row < sides_.size(); ++row) {
    if (sides_[row] == Side::kFree) continue;
    const double* plane = planes_.data() + row * rank_;
    double gauge = -1.0;
    for (std::size_t k = 0; k < rank_; ++k) gauge += plane[k] * point[k];
    gauges_[row] = gauge;
    if (gauge < -kClear) {
      sides_[row] = Side::kBelow;
    } else if (gauge > kClear) {
      sides_[row] = Side::kAbove;
      above_.push_back(row);
    } else if (std::abs(gauge) <= kInPlane) {
      sides_[row] = Side::kThrough;
      through_.push_back(row);
    } else {
      return false;
    }
  }
  work_ += sides_.size() * (1 + rank_ / 4);
  return true;
}

bool DoubleDescription::add(std::size_t place) {
  if (!classify(points_ + std::size_t{order_[place]} * rank_)) return false;
  for (const std::uint32_t row : through_) set_bit(row, place);
  if (above_.empty()) return true;
  at_point_.clear();
  for (const std::uint32_t above : above_) {
    // By number: make_facet may move the lists.
    for (std::size_t i = 0; i < neighbours_[above].size(); ++i) {
      const std::uint32_t other = neighbours_[above][i];
      if (sides_[other] == Side::kBelow) {
        make_facet(above, other, place);
      } else if (sides_[other] == Side::kThrough) {
        std::erase(neighbours_[other], above);
      }
    }
  }
  join_neighbours();
  for (const std::uint32_t row : above_) {
    sides_[row] = Side::kFree;
    free_.push_back(row);
  }
  live_ -= above_.size();
  return true;
}

/// The facet of the point and the ridge between two.
void DoubleDescription::make_facet(std::uint32_t above, std::uint32_t below, std::size_t place) {
  const std::uint32_t row = make_row();
  sides_[row] = Side::kNew;
  // The combination of both planes that is 0 at the point: convex, so errors at the ridge do not grow.
  const double share = gauges_[above] / (gauges_[above] - gauges_[below]);
  const double *from = planes_.data() + above * rank_, *to = planes_.data() + below * rank_;
  double* plane = planes_.data() + row * rank_;
  for (std::size_t k = 0; k < rank_; ++k) plane[k] = from[k] + share * (to[k] - from[k]);
  for (std::size_t w = 0; w < words_; ++w) bits(row)[w] = bits(above)[w] & bits(below)[w];
  set_bit(row, place);
  neighbours_[row].push_back(below);
  *std::find(neighbours_[below].begin(), neighbours_[below].end(), above) = row;
  at_point_.push_back(row);
  work_ += words_ + 2 * rank_;
}

/// Among the facets at the point that was added: the new ones and those through it.
void DoubleDescription::join_neighbours() {
  const std::size_t new_count = at_point_.size();
  at_point_.insert(at_point_.end(), through_.begin(), through_.end());
  rows_.clear();
  for (const std::uint32_t row : at_point_) rows_.push_back(bits(row));
  const std::size_t words_so_far = next_ / 64 + 1;
  work_ += find_ridges(rows_, words_so_far, rank_ - 1, pairs_);
  for (const FacetPair& pair : pairs_) {
    const std::uint32_t first = at_point_[pair.first], second = at_point_[pair.second];
    std::vector<std::uint32_t>& of_first = neighbours_[first];
    // Two that the point is in the planes of may have been neighbours before.
    if (pair.first >= new_count && std::find(of_first.begin(), of_first.end(), second) != of_first.end())
      continue;
    of_first.push_back(second);
    neighbours_[second].push_back(first);
  }
}

std::size_t DoubleDescription::simplicial_count() const {
  std::size_t count = 0;
  for (std::uint32_t row = 0; row < sides_.size(); ++row) {
    if (sides_[row] == Side::kFree) continue;
    int points = 0;
    for (std::size_t w = 0; w < words_; ++w) points += std::popcount(bits_[row * words_ + w]);
    count += static_cast<std::size_t>(points) == rank_;
  }
  return count;
}

FacetIncidence DoubleDescription::take() {
  FacetIncidence facets;
  facets.rank = rank_;
  facets.words = words_;
  std::vector<std::uint32_t> facet_of_row(sides_.size());
  for (std::uint32_t row = 0; row < sides_.size(); ++row) {
    if (sides_[row] == Side::kFree) continue;
    facet_of_row[row] = static_cast<std::uint32_t>(facets.count());
    facets.planes.insert(facets.planes.end(), planes_.data() + row * rank_,
                         planes_.data() + (row + 1) * rank_);
    std::vector<std::uint64_t> by_id(words_);
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t left = bits(row)[w]; left != 0; left &= left - 1) {
        const std::uint32_t id = order_[64 * w + static_cast<std::size_t>(std::countr_zero(left))];
        by_id[id / 64] |= std::uint64_t{1} << (id % 64);
      }
    }
    facets.points.insert(facets.points.end(), by_id.begin(), by_id.end());
    facets.neighbours.push_back(std::move(neighbours_[row]));
  }
  for (std::vector<std::uint32_t>& neighbours : facets.neighbours)
    for (std::uint32_t& row : neighbours) row = facet_of_row[row];
  return facets;
}

}  // namespace ndhull
