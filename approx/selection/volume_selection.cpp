#include "approx/selection/volume_selection.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <string>

#include "approx/geometry/boundedness.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/plane_candidates.h"
#include "approx/selection/volume_rays.h"
#include "core/error.h"
#include "core/machine/blocks.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Ids = std::vector<std::uint32_t>;

constexpr Index kExchangePoints = 1000;
/// Vertices of a polytope whose volume is computed to compare choices.
constexpr std::uint64_t kMostVertices = 100'000;
constexpr std::uint64_t kPointSeed = 1;

RowMatrix rows_of(const RowMatrix& all, const Ids& ids) {
  RowMatrix rows(static_cast<Index>(ids.size()), all.cols());
  for (std::size_t k = 0; k < ids.size(); ++k) rows.row(static_cast<Index>(k)) = all.row(ids[k]);
  return rows;
}

bool is_bounded(const RowMatrix& planes) {
  const std::span<const double> normals(planes.data(), static_cast<std::size_t>(planes.size()));
  return find_open_direction(normals, static_cast<std::size_t>(planes.cols())).bounded;
}

/// Points spread evenly over {y : a . y <= 1 for the rows a of some planes}.
class EvenPoints {
 public:
  EvenPoints(Index count, Index rank) : points_(RowMatrix::Zero(count, rank)) {}

  const RowMatrix& points() const { return points_; }

  /// Puts all of them anew, each from where it is: into the same region or a larger one.
  void spread(const RowMatrix& planes) {
    for (Index row = 0; row < points_.rows(); ++row) walk(planes, points_.row(row));
  }

  /// Replaces the points above the last of the planes, starting from others.
  void cut(const RowMatrix& planes) {
    const Eigen::VectorXd above = points_ * planes.row(planes.rows() - 1).transpose();
    std::vector<Index> kept;
    for (Index row = 0; row < points_.rows(); ++row) {
      if (above[row] <= 1.0) kept.push_back(row);
    }
    for (Index row = 0; row < points_.rows(); ++row) {
      if (above[row] <= 1.0) continue;
      if (kept.empty()) {
        points_.row(row).setZero();
      } else {
        points_.row(row) = points_.row(kept[random_.below(kept.size())]);
      }
      walk(planes, points_.row(row));
    }
  }

 private:
  /// Steps along random directions to a place that is uniform between the planes.
  void walk(const RowMatrix& planes, Eigen::Ref<Eigen::RowVectorXd> point) {
    const Index rank = point.size();
    Eigen::VectorXd room = 1.0 - (planes * point.transpose()).array();
    Eigen::VectorXd direction(rank), slope;
    for (Index step = 0; step < 2 * rank + 4; ++step) {
      for (double& value : direction) value = random_.normal();
      slope.noalias() = planes * direction;
      double low = -HUGE_VAL, high = HUGE_VAL;
      for (Index row = 0; row < slope.size(); ++row) {
        const double at = room[row] / slope[row];
        if (slope[row] > 0.0) high = std::min(high, at);
        if (slope[row] < 0.0) low = std::max(low, at);
      }
      if (!(low < high) || !std::isfinite(high - low)) continue;
      const double length = low + (high - low) * random_.unit();
      point += length * direction.transpose();
      room -= length * slope;
    }
  }

  RowMatrix points_;
  PortableRandom random_{kPointSeed};
};

class VolumeChoice {
 public:
  VolumeChoice(const Hull& hull, std::size_t count, const WorkEnd& end)
      : hull_(hull),
        count_(count),
        end_(end),
        facets_(plane_candidates(hull, count)),
        planes_(even_planes()) {}

  std::vector<FacetId> choose() {
    if (facets_.size() <= count_) return facets_of(all_candidates());
    const std::span<const double> normals(planes_.data(), static_cast<std::size_t>(planes_.size()));
    const Ids start = complete_to_bounded(normals, hull_.rank, {});
    std::vector<Ids> choices{choose_by_rays(planes_, start, count_, end_)};
    if (count_ <= kMostExchanged && !end_.is_here()) {
      choices.push_back(add_planes(start));
      choices.push_back(exchanged(choices.back()));
    }
    Ids largest(count_);
    std::iota(largest.begin(), largest.end(), 0U);
    if (is_bounded(rows_of(planes_, largest))) choices.push_back(largest);
    std::optional<double> least;
    std::vector<FacetId> best = facets_of(choices.front());
    for (const Ids& choice : choices) {
      if (end_.is_here()) break;
      const std::vector<FacetId> facets = facets_of(choice);
      const Limits limits{.max_facets = kMostVertices, .max_seconds = end_.seconds_left()};
      const OuterVolume outer = outer_volume(hull_, facets, limits, 1, end_.stop());
      if (!outer.volume || (least && *least <= *outer.volume)) continue;
      least = outer.volume;
      best = facets;
    }
    return best;
  }

 private:
  Ids all_candidates() const {
    Ids ids(facets_.size());
    std::iota(ids.begin(), ids.end(), 0U);
    return ids;
  }

  std::vector<FacetId> facets_of(const Ids& candidates) const {
    std::vector<FacetId> facets;
    for (const std::uint32_t id : candidates) facets.push_back(facets_[id]);
    std::sort(facets.begin(), facets.end());
    return facets;
  }

  /// The candidates as rows a with a . y <= 1, in coordinates y about the interior point in which the rows
  /// are spread evenly: ratios of volumes are the same in all coordinates.
  RowMatrix even_planes() const {
    const PlanesAboutOrigin planes = outer_planes_about_interior(hull_, facets_);
    const auto rank = static_cast<Index>(planes.rank);
    RowMatrix rows =
        Eigen::Map<const RowMatrix>(planes.normals.data(), static_cast<Index>(facets_.size()), rank);
    for (Index row = 0; row < rows.rows(); ++row) {
      rows.row(row) /= planes.heights[static_cast<std::size_t>(row)];
    }
    return rows * even_spread_map(rows);
  }

  static Index points_above(const RowMatrix& points, const Eigen::RowVectorXd& plane) {
    return ((points * plane.transpose()).array() > 1.0).count();
  }

  /// Of all candidates.
  std::vector<Index> points_above_each(const RowMatrix& points) const {
    constexpr std::size_t kPlanesAtATime = 32;
    std::vector<Index> above(facets_.size());
    for_each_block(above.size(), kPlanesAtATime, [&](std::size_t begin, std::size_t end) {
      const Eigen::MatrixXd products =
          points * planes_.middleRows(static_cast<Index>(begin), static_cast<Index>(end - begin)).transpose();
      for (std::size_t row = begin; row < end; ++row)
        above[row] = (products.col(static_cast<Index>(row - begin)).array() > 1.0).count();
    });
    return above;
  }

  Ids add_planes(Ids chosen) {
    const auto wanted = static_cast<Index>(std::clamp<std::size_t>(40 * count_, 2000, 20'000));
    EvenPoints even(wanted, planes_.cols());
    even.spread(rows_of(planes_, chosen));
    // What a candidate cuts off, when it was counted, as a share of the first volume; ties: lower row first.
    struct Gain {
      double share;
      std::uint32_t row;
      std::size_t counted_at;
      bool operator<(const Gain& other) const {
        return share != other.share ? share < other.share : row > other.row;
      }
    };
    std::priority_queue<Gain> gains;
    std::vector<bool> is_chosen(facets_.size(), false);
    for (const std::uint32_t id : chosen) is_chosen[id] = true;
    for (std::uint32_t row = 0; row < facets_.size(); ++row) {
      if (!is_chosen[row]) gains.push({HUGE_VAL, row, 0});
    }
    double volume = 1.0;
    while (chosen.size() < count_) {
      Gain best = gains.top();
      gains.pop();
      if (end_.is_here()) {
        chosen.push_back(best.row);
        continue;
      }
      if (best.counted_at < chosen.size()) {
        const Index above = points_above(even.points(), planes_.row(best.row));
        gains.push(
            {volume * static_cast<double>(above) / static_cast<double>(wanted), best.row, chosen.size()});
        continue;
      }
      chosen.push_back(best.row);
      volume -= best.share;
      even.cut(rows_of(planes_, chosen));
    }
    return chosen;
  }

  /// Takes each plane out in turn, and puts in the one that then cuts most off: it may be the same.
  Ids exchanged(Ids chosen) {
    for (std::size_t place = 0; place < chosen.size() && !end_.is_here(); ++place) {
      Ids others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
      const RowMatrix planes = rows_of(planes_, others);
      if (!is_bounded(planes)) continue;
      EvenPoints even(kExchangePoints, planes_.cols());
      even.spread(planes);
      const std::vector<Index> above = points_above_each(even.points());
      std::uint32_t best = chosen[place];
      for (std::uint32_t row = 0; row < facets_.size(); ++row) {
        if (above[row] > above[best] && std::find(others.begin(), others.end(), row) == others.end())
          best = row;
      }
      chosen[place] = best;
    }
    return chosen;
  }

  const Hull& hull_;
  std::size_t count_;
  const WorkEnd& end_;
  std::vector<FacetId> facets_;  // candidates, largest first
  RowMatrix planes_;             // one a candidate
};

}  // namespace

std::vector<FacetId> choose_for_volume(const Hull& hull, std::size_t count, const WorkEnd& end) {
  if (hull.rank == 0) return {};
  if (count <= hull.rank) {
    throw Error(ErrorCode::kUsage, "selection for volume: found " + std::to_string(count) +
                                       " facets wanted, expected at least " + std::to_string(hull.rank + 1) +
                                       ": fewer planes bound no region");
  }
  return VolumeChoice(hull, count, end).choose();
}

}  // namespace ndhull
