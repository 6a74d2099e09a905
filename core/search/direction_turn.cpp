#include "core/search/direction_turn.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/direction_turn.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>

#ifndef NDHULL_TURNING_PLACES_
#define NDHULL_TURNING_PLACES_
namespace ndhull {
/// Places are a multiple of this: a vector of doubles where vectors are longest.
inline constexpr std::size_t kTurningPlaces = 8;
}  // namespace ndhull
#endif

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using TurnTag = hn::CappedTag<double, kTurningPlaces>;

/// The points with the largest product and, among the facet's, with the smallest.
struct ExtremePlaces {
  std::size_t high, low;
  double height, lowest;
};

/// The largest entry and its place: the first of equal ones.
HWY_INLINE double largest_entry(hn::Vec<TurnTag> values, hn::Vec<TurnTag> places, std::size_t& place) {
  const TurnTag tag;
  const auto largest = hn::MaxOfLanes(tag, values);
  const auto candidates = hn::IfThenElse(hn::Eq(values, largest), places, hn::Set(tag, HUGE_VAL));
  const double first = hn::GetLane(hn::MinOfLanes(tag, candidates));
  place = first < HUGE_VAL ? static_cast<std::size_t>(first) : 0;  // of a NaN, any
  return hn::GetLane(largest);
}

template <std::size_t D>
HWY_INLINE ExtremePlaces find_extremes(const double* direction, const double* columns, std::size_t stride,
                                       std::size_t facet_stride) {
  const TurnTag tag;
  const std::size_t lanes = hn::Lanes(tag);
  hn::Vec<TurnTag> entries[D];
  for (std::size_t k = 0; k < D; ++k) entries[k] = hn::Set(tag, direction[k]);
  auto places = hn::Iota(tag, 0.0);
  const auto next = hn::Set(tag, static_cast<double>(lanes));
  auto high = hn::Set(tag, -HUGE_VAL), high_place = hn::Zero(tag);
  auto below = high, low_place = hn::Zero(tag);  // minus the smallest
  const auto dots_at = [&](std::size_t place) HWY_ATTR {
    auto dot = hn::Mul(entries[0], hn::LoadU(tag, columns + place));
    for (std::size_t k = 1; k < D; ++k)
      dot = hn::MulAdd(entries[k], hn::LoadU(tag, columns + k * stride + place), dot);
    return dot;
  };
  const auto raise = [&](hn::Vec<TurnTag> values, hn::Vec<TurnTag>& best, hn::Vec<TurnTag>& best_place)
                         HWY_ATTR {
                           const auto is_larger = hn::Gt(values, best);
                           best = hn::IfThenElse(is_larger, values, best);
                           best_place = hn::IfThenElse(is_larger, places, best_place);
                         };
  std::size_t place = 0;
  for (; place < facet_stride; place += lanes) {
    const auto dots = dots_at(place);
    raise(dots, high, high_place);
    raise(hn::Neg(dots), below, low_place);
    places = hn::Add(places, next);
  }
  for (; place < stride; place += lanes) {
    raise(dots_at(place), high, high_place);
    places = hn::Add(places, next);
  }
  ExtremePlaces found;
  found.height = largest_entry(high, high_place, found.high);
  found.lowest = -largest_entry(below, low_place, found.low);
  return found;
}

template <std::size_t D>
double turn_columns(const double* columns, std::size_t stride, std::size_t facet_stride, unsigned steps,
                    double* direction, std::uint32_t* places) {
  double trial[D], across[D];
  std::copy_n(direction, D, trial);
  ExtremePlaces found = find_extremes<D>(trial, columns, stride, facet_stride);
  *places++ = static_cast<std::uint32_t>(found.high);
  double width = found.height - found.lowest, best_width = width;
  double step = 0.25;  // of the way to width 0, were the width linear
  for (unsigned i = 0; i < steps; ++i) {
    double across_sq = 0.0;
    for (std::size_t k = 0; k < D; ++k) {
      across[k] = columns[k * stride + found.high] - columns[k * stride + found.low] - width * trial[k];
      across_sq += across[k] * across[k];
    }
    if (!(across_sq > 0.0) || !(best_width > 0.0)) break;
    const double length = step * best_width / across_sq;
    double length_sq = 0.0;
    for (std::size_t k = 0; k < D; ++k) {
      trial[k] -= length * across[k];
      length_sq += trial[k] * trial[k];
    }
    const double scale = 1.0 / std::sqrt(length_sq);
    for (std::size_t k = 0; k < D; ++k) trial[k] *= scale;
    found = find_extremes<D>(trial, columns, stride, facet_stride);
    *places++ = static_cast<std::uint32_t>(found.high);
    width = found.height - found.lowest;
    if (width < best_width) {
      best_width = width;
      std::copy_n(trial, D, direction);
    } else {
      step *= 0.9;
    }
  }
  return best_width;
}

double turn_any(std::size_t dimension, const double* columns, std::size_t stride, std::size_t facet_stride,
                unsigned steps, double* direction, std::uint32_t* places) {
  double width = 0.0;
  call_with_dimension<1, kMaxRank>(dimension, [&](auto d) {
    width = turn_columns<d>(columns, stride, facet_stride, steps, direction, places);
  });
  return width;
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {
namespace {

constexpr std::uint32_t kNoPlace = 0xFFFF'FFFFu;

std::size_t whole_vectors(std::size_t count) {
  return (count + kTurningPlaces - 1) / kTurningPlaces * kTurningPlaces;
}

}  // namespace

void TurningPoints::assign(std::size_t dimension, const double* rows, std::span<const std::uint32_t> facet,
                           std::span<const std::uint32_t> others) {
  dimension_ = dimension;
  facet_stride_ = whole_vectors(facet.size());
  stride_ = facet_stride_ + whole_vectors(others.size());
  row_of_place_.assign(facet.begin(), facet.end());
  row_of_place_.resize(facet_stride_, facet.back());
  row_of_place_.insert(row_of_place_.end(), others.begin(), others.end());
  if (!others.empty()) row_of_place_.resize(stride_, others.back());
  if (columns_.size() < dimension * stride_) columns_.resize(dimension * stride_);
  for (std::size_t place = 0; place < stride_; ++place) {
    const double* row = rows + std::size_t{row_of_place_[place]} * dimension;
    for (std::size_t k = 0; k < dimension; ++k) columns_[k * stride_ + place] = row[k];
  }
}

double TurningPoints::turn(unsigned steps, double* direction) {
  places_.assign(steps + 1, kNoPlace);
  const double width = NDHULL_BEST_OF(turn_any)(dimension_, columns_.data(), stride_, facet_stride_, steps,
                                                direction, places_.data());
  tops_.clear();
  for (const std::uint32_t place : places_) {
    if (place == kNoPlace) break;
    const std::uint32_t row = row_of_place_[place];
    if (std::find(tops_.begin(), tops_.end(), row) == tops_.end()) tops_.push_back(row);
  }
  return width;
}

}  // namespace ndhull
#endif
