#include "approx/selection/volume_rays.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "approx/selection/ray_gains_kernel.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

using Eigen::Index;

constexpr std::uint64_t kRaySeed = 1;
constexpr std::size_t kRaysForPlane = 60;
constexpr std::size_t kFewestRays = 4'000, kMostRays = 60'000;
/// Planes tried for an exchange, for each plane wanted. On spheres one in four is exchanged, most of them
/// once.
constexpr std::size_t kTrials = 2;
/// An exchange must gain this share of what it costs, or rounding could go on for ever.
constexpr double kLeastGain = 1e-6;
/// Rays whose changes are added at once, between two looks at the clock.
constexpr std::size_t kRayBlock = 256;

/// For each ray the chosen plane that it meets first, and the second one.
class RayChoice {
 public:
  RayChoice(const RowMatrix& planes, std::size_t ray_count, const WorkEnd& end)
      : planes_(planes),
        end_(end),
        directions_(planes.cols(), static_cast<Index>(ray_count)),
        first_(ray_count, 0.0),
        second_(ray_count, 0.0),
        first_plane_(ray_count, kNone),
        second_plane_(ray_count, kNone),
        is_chosen_(static_cast<std::size_t>(planes.rows()), false) {
    const auto rank = static_cast<std::size_t>(planes.cols());
    blocks_.resize((is_chosen_.size() + kGainBlock - 1) / kGainBlock * kGainBlock * rank, 0.0);
    for (std::size_t plane = 0; plane < is_chosen_.size(); ++plane) {
      double* const block = blocks_.data() + plane / kGainBlock * kGainBlock * rank + plane % kGainBlock;
      for (std::size_t k = 0; k < rank; ++k)
        block[k * kGainBlock] = planes(static_cast<Index>(plane), static_cast<Index>(k));
    }
    PortableRandom random(kRaySeed);
    for (Index ray = 0; ray < directions_.cols(); ++ray) {
      for (Index k = 0; k < directions_.rows(); ++k) directions_(k, ray) = random.normal();
      directions_.col(ray).normalize();
    }
  }

  const std::vector<std::uint32_t>& chosen() const { return chosen_; }

  /// From now on `gains` are known for all planes, whatever is added and removed.
  void look_at_all() {
    gains_.assign(blocks_.size() / static_cast<std::size_t>(planes_.cols()), 0.0);
    std::vector<RayChange> all;
    for (std::size_t ray = 0; ray < first_.size(); ++ray) all.push_back({ray, HUGE_VAL});
    update_gains(all);
  }
  /// The plane not chosen that gains most, lower row at ties; at the end the first that is not chosen.
  std::uint32_t best() const {
    std::uint32_t best = kNone;
    if (end_.is_here()) {
      const auto first = std::find(is_chosen_.begin(), is_chosen_.end(), false);
      return static_cast<std::uint32_t>(first - is_chosen_.begin());
    }
    for (std::uint32_t plane = 0; plane < is_chosen_.size(); ++plane) {
      if (!is_chosen_[plane] && (best == kNone || gains_[plane] > gains_[best])) best = plane;
    }
    return best;
  }
  double known_gain(std::uint32_t plane) const { return gains_[plane]; }

  void add(std::uint32_t plane) {
    slopes(plane);
    std::vector<RayChange> changes;
    for (std::size_t ray = 0; ray < first_.size(); ++ray) {
      const double slope = slope_[static_cast<Index>(ray)];
      if (slope > first_[ray] && !gains_.empty()) changes.push_back({ray, first_[ray]});
      meet(ray, plane, slope);
    }
    update_gains(changes);
    chosen_.push_back(plane);
    is_chosen_[plane] = true;
  }

  /// By how much the rays would become longer without each plane; 0 for those not chosen.
  std::vector<double> needs() const {
    std::vector<double> needs(is_chosen_.size(), 0.0);
    for (std::size_t ray = 0; ray < first_.size(); ++ray)
      needs[first_plane_[ray]] += content(second_[ray]) - content(first_[ray]);
    return needs;
  }

  void remove(std::uint32_t plane) {
    chosen_.erase(std::find(chosen_.begin(), chosen_.end(), plane));
    is_chosen_[plane] = false;
    std::vector<RayChange> changes;
    std::vector<std::size_t> rays;
    for (std::size_t ray = 0; ray < first_.size(); ++ray) {
      if (first_plane_[ray] != plane && second_plane_[ray] != plane) continue;
      if (first_plane_[ray] == plane && !gains_.empty()) changes.push_back({ray, first_[ray]});
      rays.push_back(ray);
    }
    Eigen::MatrixXd chosen(static_cast<Index>(chosen_.size()), planes_.cols());
    for (std::size_t k = 0; k < chosen_.size(); ++k)
      chosen.row(static_cast<Index>(k)) = planes_.row(chosen_[k]);
    for_each_block(rays.size(), 64, [&](std::size_t begin, std::size_t end) {
      Eigen::VectorXd slopes(chosen.rows());
      for (std::size_t place = begin; place < end; ++place) {
        const std::size_t ray = rays[place];
        first_[ray] = second_[ray] = 0.0;
        first_plane_[ray] = second_plane_[ray] = kNone;
        slopes.noalias() = chosen * directions_.col(static_cast<Index>(ray));
        for (std::size_t k = 0; k < chosen_.size(); ++k) meet(ray, chosen_[k], slopes[static_cast<Index>(k)]);
      }
    });
    update_gains(changes);
  }

 private:
  /// A ray, and the slope of the plane that it met first before a change.
  struct RayChange {
    std::size_t ray;
    double old_first;
  };

  /// Of the part of a cone that ends at length 1 / slope. A ray that meets no plane has no end, but the
  /// planes to start from bound all rays.
  double content(double slope) const {
    const double length = 1.0 / slope;
    double product = length;
    for (Index k = 1; k < planes_.cols(); ++k) product *= length;
    return product;
  }

  void update_gains(const std::vector<RayChange>& changes) {
    const auto rank = static_cast<std::size_t>(planes_.cols());
    RayChanges block;
    // What is not up to date at the end is not looked at any more.
    for (std::size_t begin = 0; begin < changes.size() && !end_.is_here(); begin += kRayBlock) {
      block.clear();
      for (std::size_t k = begin; k < std::min(begin + kRayBlock, changes.size()); ++k) {
        const RayChange& change = changes[k];
        const double now = first_[change.ray], upper = std::max(now, change.old_first);
        const auto direction = directions_.col(static_cast<Index>(change.ray));
        block.directions.insert(block.directions.end(), direction.begin(), direction.end());
        block.lower.push_back(std::min(now, change.old_first));
        block.upper.push_back(upper);
        block.difference.push_back(content(now) - content(change.old_first));
        block.sign.push_back(now < change.old_first ? 1.0 : -1.0);
        block.shorter.push_back(content(upper));
      }
      for_each_block(gains_.size() / kGainBlock, 64, [&](std::size_t first, std::size_t last) {
        for (std::size_t of_planes = first; of_planes < last; ++of_planes) {
          add_ray_gains(blocks_.data() + of_planes * kGainBlock * rank, rank, block,
                        gains_.data() + of_planes * kGainBlock);
        }
      });
    }
  }

  void slopes(std::uint32_t plane) { slope_.noalias() = planes_.row(plane) * directions_; }

  void meet(std::size_t ray, std::uint32_t plane, double slope) {
    if (slope > first_[ray]) {
      second_[ray] = first_[ray];
      second_plane_[ray] = first_plane_[ray];
      first_[ray] = slope;
      first_plane_[ray] = plane;
    } else if (slope > second_[ray]) {
      second_[ray] = slope;
      second_plane_[ray] = plane;
    }
  }

  const RowMatrix& planes_;
  const WorkEnd& end_;
  Eigen::MatrixXd directions_;  // rank x rays
  Eigen::RowVectorXd slope_;    // of one plane along each ray
  std::vector<double> first_, second_;
  std::vector<std::uint32_t> first_plane_, second_plane_;
  std::vector<double> blocks_;  // the planes as add_ray_gains wants them
  std::vector<double> gains_;   // of all planes, to whole blocks; empty: not known
  std::vector<bool> is_chosen_;
  std::vector<std::uint32_t> chosen_;
};

/// Takes out the planes that are needed least, one after the other, each for the one that then gains most;
/// until a round over all of them changes nothing. `fixed` planes stay: they bound the rays between the
/// others.
void exchange(RayChoice& choice, const std::vector<std::uint32_t>& fixed, std::size_t trials,
              const WorkEnd& end) {
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    const std::vector<double> needs = choice.needs();
    std::vector<std::uint32_t> order = choice.chosen();
    std::sort(order.begin(), order.end(), [&needs](std::uint32_t a, std::uint32_t b) {
      return needs[a] != needs[b] ? needs[a] < needs[b] : a < b;
    });
    for (const std::uint32_t plane : order) {
      if (std::find(fixed.begin(), fixed.end(), plane) != fixed.end()) continue;
      if (trials-- == 0 || end.is_here()) return;
      choice.remove(plane);
      const std::uint32_t best = choice.best();
      const bool is_better =
          !end.is_here() && choice.known_gain(best) > choice.known_gain(plane) * (1.0 + kLeastGain);
      choice.add(is_better ? best : plane);
      has_changed = has_changed || is_better;
    }
  }
}

}  // namespace

Eigen::MatrixXd even_spread_map(const RowMatrix& planes) {
  constexpr Index kRowsAtATime = 1024;  // the same sums whatever the machine
  const Index rank = planes.cols();
  const Eigen::RowVectorXd scale = planes.cwiseAbs().colwise().maxCoeff().cwiseInverse();
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(rank, rank);
  RowMatrix scaled;
  for (Index begin = 0; begin < planes.rows(); begin += kRowsAtATime) {
    scaled = planes.middleRows(begin, std::min(kRowsAtATime, planes.rows() - begin)) * scale.asDiagonal();
    spread.noalias() += scaled.transpose() * scaled;
  }
  spread /= static_cast<double>(planes.rows());
  const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(spread).matrixL();
  const Eigen::MatrixXd inverse =
      lower.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(rank, rank));
  return scale.transpose().asDiagonal() * inverse.transpose();
}

std::vector<std::uint32_t> choose_by_rays(const RowMatrix& planes, const std::vector<std::uint32_t>& start,
                                          std::size_t count, const WorkEnd& end) {
  const auto plane_count = static_cast<std::size_t>(planes.rows());
  RayChoice choice(planes, std::clamp(kRaysForPlane * count, kFewestRays, kMostRays), end);
  for (const std::uint32_t plane : start) choice.add(plane);
  choice.look_at_all();
  while (choice.chosen().size() < std::min(count, plane_count)) choice.add(choice.best());
  if (choice.chosen().size() < plane_count) exchange(choice, start, kTrials * count, end);
  std::vector<std::uint32_t> chosen = choice.chosen();
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace ndhull
