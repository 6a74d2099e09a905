#include "approx/trade/cluster_merge.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Turning a plane halves the width of a union at best: what is this many times too wide is not turned.
constexpr double kHopeless = 2.0;
constexpr unsigned kTrialSteps = 6;   // of the fit when a pair is judged
constexpr unsigned kMergeSteps = 16;  // and in all when it is merged
constexpr std::size_t kClustersAtATime = 16;

void put_union(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b,
               std::vector<std::uint32_t>& both) {
  both.resize(a.size() + b.size());
  const auto end = std::set_union(a.begin(), a.end(), b.begin(), b.end(), both.begin());
  both.erase(end, both.end());
}

class Merging {
 public:
  Merging(const WidthSpace& space, const MergeRule& rule) : space_(space), rule_(rule) {}

  JoinedFacets run(std::vector<FacetCorners> facets, std::vector<FittedPlane> planes) {
    make_clusters(std::move(facets), std::move(planes));
    announce_all();
    while (!offers_.empty() && live_ > rule_.least_facets) {
      const Offer best = offers_.top();
      offers_.pop();
      take(best);
    }
    counts_.refused = count_refused();
    return joined_facets();
  }

 private:
  struct Cluster {
    FittedPlane plane;
    std::vector<std::uint32_t> vertices, neighbours;  // sorted
    std::vector<std::uint32_t> tops;                  // points that made the plane's height
    std::vector<double> centrum;
    double given_weight = 0.0;  // 0: none
    std::uint32_t version = 0;
    std::uint32_t joined = kNone;

    double weight() const { return given_weight > 0.0 ? given_weight : static_cast<double>(vertices.size()); }
  };
  /// What the width of an offer is: each stage's is no less than that of the one before, and costs more.
  enum class Stage : std::uint8_t {
    kParts,   // the wider of the two
    kTops,    // of the union, were there no other points than its vertices and the tops of the two
    kFitted,  // of a fit with the points near it
  };
  struct Offer {
    double width;
    std::uint32_t a, b, version_a, version_b;
    Stage stage;
    bool operator<(const Offer& other) const {
      if (width != other.width) return width > other.width;
      return a != other.a ? a > other.a : b > other.b;
    }
  };

  /// What a thread that looks at pairs needs.
  struct PairWork {
    std::vector<double> normal;
    std::vector<std::uint32_t> united, near;  // the union's vertices; points that are likely to be above it
    PlaneFitWork fit;
  };

  std::uint32_t root(std::uint32_t id) const {
    while (clusters_[id].joined != kNone) id = clusters_[id].joined;
    return id;
  }

  void make_clusters(std::vector<FacetCorners> facets, std::vector<FittedPlane> planes) {
    const std::size_t count = planes.size();
    clusters_.resize(count);
    live_ = count;
    for_each_block(count, kClustersAtATime, [&](std::size_t begin, std::size_t end) {
      for (std::size_t id = begin; id < end; ++id) {
        Cluster& cluster = clusters_[id];
        cluster.vertices = std::move(facets[id].vertices);
        cluster.neighbours = std::move(facets[id].neighbours);
        cluster.given_weight = facets[id].weight;
        cluster.plane = std::move(planes[id]);
        if (!is_measured(cluster.plane)) {  // a simplex with its own plane
          cluster.plane =
              measure_plane(space_, cluster.plane.normal, cluster.vertices, pair_work_.local().fit);
        } else {
          cluster.plane.low = lowest_dot(space_, cluster.plane.normal, cluster.vertices);
        }
        cluster.tops.assign(1, cluster.plane.highest);
        cluster.centrum = centrum_on_plane(space_, cluster.vertices, cluster.plane);
      }
    });
  }

  bool is_wanted(const Cluster& a, const Cluster& b) const {
    return rule_.wants(a.plane, a.centrum, b.plane, b.centrum);
  }

  /// work.normal: the mean of the normals by their weights.
  void take_mean(const Cluster& a, const Cluster& b, PairWork& work) const {
    std::vector<double>& normal = work.normal;
    normal.resize(space_.rank());
    double length_sq = 0.0;
    for (std::size_t k = 0; k < normal.size(); ++k) {
      normal[k] = a.weight() * a.plane.normal[k] + b.weight() * b.plane.normal[k];
      length_sq += normal[k] * normal[k];
    }
    if (!(length_sq > 0.0)) normal = a.plane.normal, length_sq = 1.0;
    for (double& entry : normal) entry /= std::sqrt(length_sq);
  }

  /// work.united: the union's vertices.
  void unite(const Cluster& a, const Cluster& b, PairWork& work) const {
    put_union(a.vertices, b.vertices, work.united);
  }

  /// Is the union too wide to be fitted, among its vertices and the tops of the two, along their mean normal?
  /// The first few vertices tell of most.
  bool is_hopeless(const Cluster& a, const Cluster& b, PairWork& work) const {
    take_mean(a, b, work);
    const double most = kHopeless * rule_.width_cap;
    double low = HUGE_VAL, high = -HUGE_VAL;
    const auto dot_with = [&](std::uint32_t row) {
      return std::inner_product(work.normal.begin(), work.normal.end(), space_.row(row), 0.0);
    };
    const auto meet = [&](std::uint32_t row) {
      const double dot = dot_with(row);
      low = std::min(low, dot);
      high = std::max(high, dot);
      return high - low > most;
    };
    for (const Cluster* cluster : {&a, &b}) {
      for (const std::uint32_t row : cluster->tops) high = std::max(high, dot_with(row));
    }
    return std::any_of(a.vertices.begin(), a.vertices.end(), meet) ||
           std::any_of(b.vertices.begin(), b.vertices.end(), meet);
  }

  FittedPlane mean_plane(const Cluster& a, const Cluster& b, PairWork& work) const {
    unite(a, b, work);
    take_mean(a, b, work);
    return measure_plane(space_, work.normal, work.united, work.fit);
  }

  /// The pair with a width that the union is not narrower than, to be looked at when its turn comes: many
  /// are gone by then. Nothing: they are not merged.
  std::optional<Offer> first_offer(std::uint32_t a, std::uint32_t b, PairWork& work) const {
    const Cluster& first = clusters_[a];
    const Cluster& second = clusters_[b];
    if (!is_wanted(first, second) || is_hopeless(first, second, work)) return std::nullopt;
    const double least = std::max(first.plane.width(), second.plane.width());
    return Offer{least, a, b, first.version, second.version, Stage::kParts};
  }

  /// The same with the width among the union's vertices and tops: most pairs that are too wide are so for
  /// these.
  std::optional<Offer> offer_of_tops(const Offer& first, PairWork& work) const {
    const Cluster& a = clusters_[first.a];
    const Cluster& b = clusters_[first.b];
    take_mean(a, b, work);
    work.near = a.tops;
    work.near.insert(work.near.end(), b.tops.begin(), b.tops.end());
    unite(a, b, work);
    const double width = turn_among(space_, work.normal, work.near, work.united, kTrialSteps, work.fit);
    if (width > rule_.width_cap) return std::nullopt;
    Offer offer = first;
    offer.width = std::max(width, first.width);
    offer.stage = Stage::kTops;
    return offer;
  }

  /// All pairs. Where there are threads for it they are looked at here, a stage further: nobody waits for
  /// those that would be gone by then.
  void announce_all() {
    std::vector<std::vector<Offer>> of_block((clusters_.size() + kClustersAtATime - 1) / kClustersAtATime);
    const bool looks_further = has_more_threads();
    for_each_block(clusters_.size(), kClustersAtATime, [&](std::size_t begin, std::size_t end) {
      PairWork& work = pair_work_.local();
      for (auto id = static_cast<std::uint32_t>(begin); id < end; ++id) {
        for (const std::uint32_t other : clusters_[id].neighbours) {
          if (other < id) continue;
          std::optional<Offer> offer = first_offer(id, other, work);
          if (offer && looks_further) offer = offer_of_tops(*offer, work);
          if (offer) of_block[begin / kClustersAtATime].push_back(*offer);
        }
      }
    });
    std::vector<Offer> all;
    for (const std::vector<Offer>& offers : of_block) all.insert(all.end(), offers.begin(), offers.end());
    offers_ = std::priority_queue<Offer>(std::less<Offer>(), std::move(all));
  }

  /// The same with the width of a fit; what is the narrowest offer even so is taken at once.
  void offer_fit(std::uint32_t a, std::uint32_t b) {
    PairWork& work = pair_work_.local();
    const FittedPlane start = mean_plane(clusters_[a], clusters_[b], work);
    if (start.width() > kHopeless * rule_.width_cap) return;
    const double width = turn_among_near(space_, start, work.united, kTrialSteps, work.fit);
    if (width > rule_.width_cap) return;
    const Offer fitted{width, a, b, clusters_[a].version, clusters_[b].version, Stage::kFitted};
    if (!offers_.empty() && fitted < offers_.top()) {
      offers_.push(fitted);
    } else {
      merge(a, b, start, work);
    }
  }

  void take(const Offer& best) {
    const Cluster& into = clusters_[best.a];
    const Cluster& from = clusters_[best.b];
    if (into.joined != kNone || from.joined != kNone) return;
    if (into.version != best.version_a || from.version != best.version_b) return;  // announced anew since
    switch (best.stage) {
      case Stage::kParts:
        if (const std::optional<Offer> offer = offer_of_tops(best, pair_work_.local())) offers_.push(*offer);
        return;
      case Stage::kTops: return offer_fit(best.a, best.b);
      case Stage::kFitted: break;
    }
    PairWork& work = pair_work_.local();
    const FittedPlane start = mean_plane(into, from, work);
    turn_among_near(space_, start, work.united, kTrialSteps, work.fit);
    merge(best.a, best.b, start, work);
  }

  /// Merges b into a if that is within the cap: `work` is that of the trial fit from `start`.
  void merge(std::uint32_t a, std::uint32_t b, const FittedPlane& start, PairWork& work) {
    turn_further(kMergeSteps - kTrialSteps, work.fit);
    FittedPlane plane = measure_plane(space_, work.fit.best, work.united, work.fit);
    if (plane.width() > start.width()) plane = start;
    if (plane.width() > rule_.width_cap) return;
    Cluster& into = clusters_[a];
    Cluster& from = clusters_[b];
    ++counts_.merges;
    --live_;
    into.plane = std::move(plane);
    into.vertices = work.united;
    into.given_weight += from.given_weight;
    into.tops.assign(work.fit.points.tops().begin(), work.fit.points.tops().end());
    ++into.version;
    from.joined = a;
    std::vector<std::uint32_t> around;
    put_union(into.neighbours, from.neighbours, around);
    std::erase_if(around, [&](std::uint32_t id) { return id == a || id == b; });
    into.neighbours = std::move(around);
    into.centrum = centrum_on_plane(space_, into.vertices, into.plane);
    for (const std::uint32_t id : into.neighbours) {
      rename(clusters_[id].neighbours, b, a);
      if (const std::optional<Offer> offer = first_offer(std::min(a, id), std::max(a, id), work))
        offers_.push(*offer);
    }
    from = Cluster();
    from.joined = a;
  }

  static void rename(std::vector<std::uint32_t>& sorted, std::uint32_t from, std::uint32_t to) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), from);
    if (at == sorted.end() || *at != from) return;
    sorted.erase(at);
    const auto place = std::lower_bound(sorted.begin(), sorted.end(), to);
    if (place == sorted.end() || *place != to) sorted.insert(place, to);
  }

  std::uint64_t count_refused() const {
    std::uint64_t refused = 0;
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) {
      for (const std::uint32_t other : clusters_[id].neighbours)
        refused += id < other && is_wanted(clusters_[id], clusters_[other]) ? 1u : 0u;
    }
    return refused;
  }

  JoinedFacets joined_facets() {
    JoinedFacets result;
    std::vector<std::uint32_t> facet(clusters_.size(), kNone);
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) {
      if (clusters_[id].joined != kNone) continue;
      facet[id] = static_cast<std::uint32_t>(result.planes.size());
      result.planes.push_back(std::move(clusters_[id].plane));
    }
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) result.facet_of.push_back(facet[root(id)]);
    result.counts = counts_;
    return result;
  }

  const WidthSpace& space_;
  const MergeRule& rule_;
  std::vector<Cluster> clusters_;
  std::size_t live_ = 0;
  std::priority_queue<Offer> offers_;
  tbb::enumerable_thread_specific<PairWork> pair_work_;
  MergeCounts counts_;
};

}  // namespace

JoinedFacets join_facets(std::vector<FacetCorners> facets, std::vector<FittedPlane> planes,
                         const WidthSpace& space, const MergeRule& rule) {
  return Merging(space, rule).run(std::move(facets), std::move(planes));
}

MergeCounts merge_clusters(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
                           Covering& covering) {
  std::vector<FacetCorners> facets = corners_of(complex, space, covering);
  JoinedFacets joined = join_facets(std::move(facets), std::move(covering.planes), space, rule);
  covering.planes = std::move(joined.planes);
  covering.widest = 0.0;
  for (const FittedPlane& plane : covering.planes) covering.widest = std::max(covering.widest, plane.width());
  for (std::uint32_t& of_row : covering.facet_of)
    if (of_row != kNone) of_row = joined.facet_of[of_row];
  return joined.counts;
}

}  // namespace ndhull
