#include "approx/selection/volume_rays.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/ids.h"
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
/// Planes times rays whose products are held at once.
constexpr Index kRayBlock = 256;

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
    PortableRandom random(kRaySeed);
    for (Index ray = 0; ray < directions_.cols(); ++ray) {
      for (Index k = 0; k < directions_.rows(); ++k) directions_(k, ray) = random.normal();
      directions_.col(ray).normalize();
    }
  }

  const std::vector<std::uint32_t>& chosen() const { return chosen_; }

  /// From now on `gains` are known for all planes, whatever is added and removed.
  void look_at_all() {
    gains_.assign(is_chosen_.size(), 0.0);
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
    for (std::uint32_t plane = 0; plane < gains_.size(); ++plane) {
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
    for (std::size_t ray = 0; ray < first_.size(); ++ray) {
      if (first_plane_[ray] != plane && second_plane_[ray] != plane) continue;
      if (first_plane_[ray] == plane && !gains_.empty()) changes.push_back({ray, first_[ray]});
      first_[ray] = second_[ray] = 0.0;
      first_plane_[ray] = second_plane_[ray] = kNone;
      for (const std::uint32_t other : chosen_)
        meet(ray, other, planes_.row(other).dot(directions_.col(static_cast<Index>(ray))));
    }
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
    Eigen::MatrixXd directions, products;
    // What is not up to date at the end is not looked at any more.
    for (std::size_t begin = 0; begin < changes.size() && !end_.is_here(); begin += kRayBlock) {
      const auto used = static_cast<Index>(std::min<std::size_t>(kRayBlock, changes.size() - begin));
      directions.resize(planes_.cols(), used);
      for (Index k = 0; k < used; ++k)
        directions.col(k) =
            directions_.col(static_cast<Index>(changes[begin + static_cast<std::size_t>(k)].ray));
      products.noalias() = planes_ * directions;
      for (Index k = 0; k < used; ++k) {
        const RayChange& change = changes[begin + static_cast<std::size_t>(k)];
        const double now = first_[change.ray], lower = std::min(now, change.old_first);
        const double upper = std::max(now, change.old_first);
        const double shorter = content(upper), difference = content(now) - content(change.old_first);
        const double sign = now < change.old_first ? 1.0 : -1.0;
        for (Index plane = 0; plane < products.rows(); ++plane) {
          const double slope = products(plane, k);
          if (slope <= lower) continue;
          gains_[static_cast<std::size_t>(plane)] +=
              slope >= upper ? difference : difference - sign * (content(slope) - shorter);
        }
      }
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
  std::vector<double> gains_;  // of all planes; empty: not known
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

RowMatrix evenly_spread(RowMatrix planes) {
  planes = (planes.array().rowwise() / planes.cwiseAbs().colwise().maxCoeff().array()).eval();
  const Eigen::MatrixXd spread = planes.transpose() * planes / static_cast<double>(planes.rows());
  const Eigen::MatrixXd lower = Eigen::LLT<Eigen::MatrixXd>(spread).matrixL();
  return lower.triangularView<Eigen::Lower>().solve(planes.transpose()).transpose();
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
