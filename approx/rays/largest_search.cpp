#include "approx/rays/largest_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "approx/geometry/boundedness.h"
#include "approx/geometry/frame_planes.h"
#include "approx/hull.h"
#include "approx/rays/plane_certificate.h"
#include "core/error.h"

namespace ndhull {
namespace {

/// Rays of one round, and how many are shot without a number of the user's.
constexpr std::uint64_t kRaysPerRound = 512;
constexpr std::uint64_t kFirstRays = 1024;
constexpr std::uint64_t kLeastRays = 2048;
constexpr std::uint64_t kMostRays = 16384;
/// The largest facets are stable when they were the same after so many rounds, with all climbs done.
constexpr std::size_t kStableRounds = 3;
/// .. and when the estimated recall says that another set of rays would have led to them as well.
constexpr double kGoodRecall = 0.9;
/// Climbs go from so many times the facets wanted, and at least from so many. On 8-d sets with 10^6 facets
/// that finds 95 to 100 % of the 20 largest; a tenth of it 75 to 80 %.
constexpr std::size_t kWidthPerFacet = 100;
constexpr std::size_t kLeastWidth = 3000;
/// Hits of a round, the largest ones, from which an ascent to a local maximum starts.
constexpr std::ptrdiff_t kAscents = 32;
/// Climbs may cost so many times what the rays so far did: a step over a ridge costs a tenth of a ray, and
/// finds larger facets.
constexpr double kClimbsPerRay = 10.0;
constexpr std::size_t kFacetsPerClimb = 128;
/// [multiply-adds] After this the search ends: 15 to 40 s on two cores.
constexpr double kMostWork = 6e11;
/// [multiply-adds] What a walk costs beside its products: factoring the basis, areas.
constexpr double kWorkPerWalk = 4000.0;
/// Rays between two looks at the clock: facets with thousands of points take some hundredths of a second each.
constexpr std::size_t kMostRaysAtOnce = 64;
/// Of the time that is allowed one facet may take so much: its area is that of a part then.
constexpr double kShareOfFacet = 1.0 / 32.0;
/// Directions in which planes may be open, and facets that close them, before it is given up.
constexpr std::size_t kMostBounding = 1000;
/// So many coincidences among the first rays tell how many facets there are; fewer tell nothing.
constexpr std::uint64_t kTellingPairs = 8;

}  // namespace

LargestSearch::LargestSearch(RayShooter& shooter, const LargestOptions& options,
                             std::chrono::steady_clock::time_point start)
    : shooter_(shooter),
      options_(options),
      end_(options.max_seconds, options.stop, start),
      search_(shooter, options.seed, kShareOfFacet * options.max_seconds),
      rays_at_once_(kMostRaysAtOnce),
      climbs_at_once_(kFacetsPerClimb),
      width_(std::max(kLeastWidth, kWidthPerFacet * options.count)) {
  const std::size_t rank = shooter.frame().rank;
  if (rank > kMaxRayRank) {
    throw Error(ErrorCode::kDimensionTooHigh,
                "points span " + std::to_string(rank) + " dimensions, expected at most " +
                    std::to_string(kMaxRayRank) + "; project them to fewer, or take ndhull extreme");
  }
}

double LargestSearch::work() const {
  const WalkCounters& counters = shooter_.counters();
  const auto rank = static_cast<double>(shooter_.frame().rank);
  return rank * static_cast<double>(counters.core_products + counters.all_products) +
         kWorkPerWalk * rank * rank * static_cast<double>(counters.walks);
}

void LargestSearch::shoot(std::uint64_t rays) {
  hit_.clear();
  for (std::uint64_t shot = 0; shot < rays && !(shot > 0 && end_.is_late());) {
    const std::size_t count = rays_at_once_.at_once(rays - shot, end_);
    std::vector<std::uint32_t> hit;
    rays_at_once_.look_at(count, end_, [&] { hit = search_.shoot(count, options_.stop); });
    hit_.insert(hit_.end(), hit.begin(), hit.end());
    shot += count;
  }
  std::sort(hit_.begin(), hit_.end());
  hit_.erase(std::unique(hit_.begin(), hit_.end()), hit_.end());
  if (options_.progress) {
    options_.progress("rays " + std::to_string(search_.rays()) + ", facets " +
                      std::to_string(search_.size()));
  }
}

void LargestSearch::look() { shoot(options_.rays > 0 ? std::min(options_.rays, kFirstRays) : kFirstRays); }

bool LargestSearch::may_be_built(std::uint64_t most_facets) const {
  const std::size_t rank = shooter_.frame().rank;
  if (rank > kMaxRank) return false;
  // A simplicial hull has about 2 5^(d-3) facets for each vertex (2 in 3-d, 28 in 5-d, 130 in 6-d, 2,000 to
  // 6,000 in 8-d). The points met so far are some of the vertices, and an eighth of that is tried.
  const double by_points =
      static_cast<double>(shooter_.core_size()) * std::pow(5.0, static_cast<double>(rank) - 3.0) / 4.0;
  const double by_hits = unseen_estimate(search_.facets_with_hits(1), search_.facets_with_hits(2));
  const bool hits_tell = search_.rays() - search_.size() >= kTellingPairs;
  const auto most = static_cast<double>(most_facets);
  return by_points < most && (!hits_tell || by_hits < most);
}

void LargestSearch::climb(double most_work) {
  const double before = work();
  all_climbed_ = false;
  while (work() - before < most_work && !end_.is_here()) {
    std::size_t climbed = 0;
    const std::size_t most = climbs_at_once_.at_once(kFacetsPerClimb, end_);
    climbs_at_once_.look_at(most, end_, [&] { climbed = search_.climb(width_, most, end_); });
    if (climbed == 0) {
      all_climbed_ = !search_.left_ridges_out();
      return;
    }
    if (options_.progress) {
      options_.progress("climbs " + std::to_string(search_.climbs()) + ", facets " +
                        std::to_string(search_.size()));
    }
  }
}

void LargestSearch::ascend(double most_work) {
  const double before = work();
  std::vector<std::uint32_t> from = hit_;
  if (from.size() > static_cast<std::size_t>(kAscents)) {
    std::nth_element(from.begin(), from.begin() + kAscents, from.end(), [this](auto a, auto b) {
      const double area_a = search_.facet(a).area, area_b = search_.facet(b).area;
      return area_a != area_b ? area_a > area_b : a < b;
    });
    from.resize(static_cast<std::size_t>(kAscents));
    std::sort(from.begin(), from.end());
  }
  while (!from.empty() && work() - before < most_work && !end_.is_here()) {
    const std::size_t most = climbs_at_once_.at_once(kFacetsPerClimb, end_);
    climbs_at_once_.look_at(std::min(most, from.size()), end_,
                            [&] { from = search_.ascend(from, most, end_); });
  }
}

std::uint64_t LargestSearch::led_by(std::uint64_t rays) const {
  return static_cast<std::uint64_t>(
      std::count_if(largest_.begin(), largest_.end(),
                    [this, rays](std::uint32_t id) { return search_.facet(id).ray_count == rays; }));
}

/// Each ray leads to some of the largest facets or to none: how many were led to by one, two and more tells
/// how many there are that none led to.
double LargestSearch::recall_estimate() const {
  const std::uint64_t one = led_by(1), two = led_by(2);
  return coverage_estimate(one, two, largest_.size() - one - two);
}

bool LargestSearch::is_over(std::size_t stable_rounds) {
  const std::uint64_t rays = search_.rays();
  const auto ends = [this](LargestStatus status) {
    status_ = status;
    return true;
  };
  if (options_.stop.stop_requested()) return ends(LargestStatus::kInterrupted);
  if (end_.is_late()) return ends(LargestStatus::kTimeLimit);
  if (options_.rays > 0) return rays >= options_.rays && ends(LargestStatus::kRayLimit);
  if (rays >= kLeastRays && stable_rounds >= kStableRounds && recall_estimate() >= kGoodRecall) {
    return ends(LargestStatus::kStable);
  }
  if (work() >= kMostWork) return ends(LargestStatus::kWorkLimit);
  return rays >= kMostRays && ends(LargestStatus::kRayLimit);
}

void LargestSearch::run(LargestFacets& result) {
  std::size_t stable_rounds = 0;
  double ray_work = work();
  while (true) {
    const double most_work = std::min(kClimbsPerRay * ray_work, kMostWork - work());
    ascend(most_work);
    climb(most_work);
    const std::vector<std::uint32_t> largest = search_.largest(options_.count);
    stable_rounds = all_climbed_ && largest == largest_ ? stable_rounds + 1 : 0;
    largest_ = largest;
    if (is_over(stable_rounds)) break;
    const double before = work();
    shoot(options_.rays > 0 ? std::min(kRaysPerRound, options_.rays - search_.rays()) : kRaysPerRound);
    ray_work = work() - before;
  }
  // The rays are shot; climbs go on as far as the work is allowed.
  climb(kMostWork - work());
  largest_ = search_.largest(options_.count);
  std::erase_if(largest_, [this](std::uint32_t id) { return search_.facet(id).area < options_.min_area; });
  if (options_.bounded) add_bounding();

  const Frame& frame = shooter_.frame();
  result.method = LargestMethod::kRays;
  result.status = status_;
  result.dimension = frame.dimension;
  result.rank = frame.rank;
  result.interior_point = frame.centre;
  result.subspace_equations = find_subspace_equations(frame);
}

/// A facet that a ray along an open direction hits has a normal that closes it.
void LargestSearch::add_bounding() {
  const Frame& frame = shooter_.frame();
  const std::vector<double> equations = find_subspace_equations(frame);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> map(
      frame.map.data(), static_cast<Eigen::Index>(frame.rank), static_cast<Eigen::Index>(frame.dimension));
  const NormalMap to_input(frame);
  std::vector<double> normals;
  const auto add_normal = [&](std::uint32_t id) {
    std::vector<double> plane = search_.geometry_of(id).plane;
    normals.resize(normals.size() + frame.dimension);
    to_input.map(plane.data(), 1, normals.data() + normals.size() - frame.dimension);
  };
  for (const std::uint32_t id : largest_) add_normal(id);
  std::vector<std::uint32_t> closing;
  while (closing.size() < kMostBounding && !options_.stop.stop_requested()) {
    const Boundedness open = find_open_direction(normals, frame.dimension, equations);
    if (open.bounded) break;
    const Eigen::Map<const Eigen::VectorXd> direction(open.direction.data(),
                                                      static_cast<Eigen::Index>(frame.dimension));
    const Eigen::VectorXd in_frame = map * direction;
    std::uint32_t id = 0;
    if (!search_.add_hit_by({in_frame.data(), in_frame.data() + in_frame.size()}, id)) break;
    const auto is_same = [id](std::uint32_t other) { return other == id; };
    if (std::any_of(closing.begin(), closing.end(), is_same)) break;  // rounding: it closes nothing
    closing.push_back(id);
    add_normal(id);
  }
  std::vector<std::uint32_t> selected(largest_.size());
  for (std::uint32_t row = 0; row < selected.size(); ++row) selected[row] = row;
  for (const std::uint32_t row : complete_to_bounded(normals, frame.dimension, selected, equations)) {
    bounding_.push_back(closing[row - largest_.size()]);
  }
}

LargestFacet LargestSearch::describe(std::uint32_t id) const {
  const FoundFacet& found = search_.facet(id);
  LargestFacet facet;
  facet.area = found.area;
  facet.area_is_whole = found.area_is_whole;
  facet.origin = found.hits > 0 ? FacetOrigin::kRay : FacetOrigin::kClimb;
  facet.hits = found.hits;
  facet.share = share_interval(found.hits, search_.rays(), options_.confidence);
  facet.leads = found.ray_count;
  return facet;
}

RaySample LargestSearch::describe_sample() const {
  RaySample sample;
  sample.rays = search_.rays();
  sample.open_rays = search_.open_rays();
  sample.facets_found = search_.size();
  sample.facets_hit = search_.size() - search_.facets_with_hits(0);
  sample.climbs = search_.climbs();
  sample.core_points = shooter_.core_size();
  sample.directions = search_.direction_unit() == DirectionUnit::kInput ? "input" : "unit-cube";
  sample.confidence = options_.confidence;
  sample.unseen_share = unseen_share_bound(sample.rays, options_.confidence);
  const std::uint64_t once = search_.facets_with_hits(1), twice = search_.facets_with_hits(2);
  if (sample.rays > 0) sample.unhit_share = static_cast<double>(once) / static_cast<double>(sample.rays);
  sample.facets_estimate = static_cast<double>(sample.facets_hit) + unseen_estimate(once, twice);
  sample.led_by_one = led_by(1);
  sample.led_by_two = led_by(2);
  if (!largest_.empty()) sample.recall = recall_estimate();
  return sample;
}

void LargestSearch::certify(const PointView& points, LargestFacets& result) {
  std::vector<PlaneOfPoints> planes;
  std::vector<std::uint32_t> all = largest_;
  all.insert(all.end(), bounding_.begin(), bounding_.end());
  for (const std::uint32_t id : all) {
    LargestFacet facet = describe(id);
    if (result.facets.size() >= largest_.size()) facet.origin = FacetOrigin::kBound;
    RayFacet geometry = search_.geometry_of(id);
    for (const std::uint32_t vertex : geometry.vertices) facet.vertices.push_back(PointId{vertex});
    planes.push_back({std::move(geometry.plane), std::move(geometry.points)});
    result.facets.push_back(std::move(facet));
  }
  result.largest_count = largest_.size();
  const PlaneCertificate certificate = certify_planes(points, shooter_.frame(), planes);
  result.reference = certificate.reference;
  result.roundoff = certificate.roundoff;
  for (std::size_t row = 0; row < all.size(); ++row) {
    LargestFacet& facet = result.facets[row];
    const CertifiedPlane& plane = certificate.planes[row];
    facet.normal = plane.normal;
    facet.centred_offset = facet.offset = plane.centred_offset;
    for (std::size_t k = 0; k < facet.normal.size(); ++k) {
      facet.offset -= facet.normal[k] * certificate.reference[k];
    }
    facet.outer_offset = plane.outer_offset;
    facet.inner_offset = plane.inner_offset;
  }
  result.sample = describe_sample();
}

}  // namespace ndhull
