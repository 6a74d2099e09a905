#include "approx/cluster_merge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <queue>
#include <vector>

namespace ndhull {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;
constexpr unsigned kTrialSteps = 6;   // of the fit when a pair is judged
constexpr unsigned kMergeSteps = 16;  // when it is merged

class Merging {
 public:
  Merging(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
          Covering& covering)
      : complex_(complex), space_(space), rule_(rule), covering_(covering) {}

  MergeCounts run() {
    make_clusters();
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) {
      for (const std::uint32_t other : clusters_[id].neighbours)
        if (id < other) offer(id, other);
    }
    while (!offers_.empty() && live_ > rule_.least_facets) {
      const Offer best = offers_.top();
      offers_.pop();
      take(best);
    }
    counts_.refused = count_refused();
    write_back();
    return counts_;
  }

 private:
  struct Cluster {
    FittedPlane plane;
    std::vector<std::uint32_t> vertices, neighbours;  // sorted
    std::vector<double> centrum;
    std::uint32_t version = 0;
    std::uint32_t joined = kNone;
  };
  struct Offer {
    double width;
    std::uint32_t a, b, version_a, version_b;
    bool operator<(const Offer& other) const {
      if (width != other.width) return width > other.width;
      return a != other.a ? a > other.a : b > other.b;
    }
  };

  std::uint32_t root(std::uint32_t id) const {
    while (clusters_[id].joined != kNone) id = clusters_[id].joined;
    return id;
  }

  void make_clusters() {
    clusters_.resize(covering_.planes.size());
    live_ = clusters_.size();
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      const std::uint32_t id = covering_.facet_of[row];
      if (id == kNone) continue;
      for (const PointId point : complex_.vertices(SimplexId{row}))
        clusters_[id].vertices.push_back(space_.row_of(point));
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{row})) {
        const std::uint32_t other = covering_.facet_of[neighbour.value];
        if (other != id) clusters_[id].neighbours.push_back(other);
      }
    }
    for (std::size_t id = 0; id < clusters_.size(); ++id) {
      Cluster& cluster = clusters_[id];
      for (std::vector<std::uint32_t>* list : {&cluster.vertices, &cluster.neighbours}) {
        std::sort(list->begin(), list->end());
        list->erase(std::unique(list->begin(), list->end()), list->end());
      }
      cluster.plane = measure_plane(space_, covering_.planes[id].normal, cluster.vertices, work_);
      cluster.centrum = centrum_on_plane(space_, cluster.vertices, cluster.plane);
    }
  }

  bool is_wanted(const Cluster& a, const Cluster& b) const {
    return rule_.wants(a.plane, a.centrum, b.plane, b.centrum);
  }

  /// The plane of the union: fitted from the normals' mean, weighted by the number of vertices.
  FittedPlane fit_union(const Cluster& a, const Cluster& b, unsigned steps) {
    united_.clear();
    std::set_union(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                   std::back_inserter(united_));
    std::vector<double> normal(space_.rank());
    double length_sq = 0.0;
    for (std::size_t k = 0; k < normal.size(); ++k) {
      normal[k] = static_cast<double>(a.vertices.size()) * a.plane.normal[k] +
                  static_cast<double>(b.vertices.size()) * b.plane.normal[k];
      length_sq += normal[k] * normal[k];
    }
    if (!(length_sq > 0.0)) normal = a.plane.normal, length_sq = 1.0;
    for (double& entry : normal) entry /= std::sqrt(length_sq);
    const FittedPlane start = measure_plane(space_, normal, united_, work_);
    return narrow_plane(space_, start, united_, steps, work_);
  }

  void offer(std::uint32_t a, std::uint32_t b) {
    const Cluster& first = clusters_[a];
    const Cluster& second = clusters_[b];
    if (!is_wanted(first, second)) return;
    const double width = fit_union(first, second, kTrialSteps).width();
    if (width <= rule_.width_cap) offers_.push({width, a, b, first.version, second.version});
  }

  void take(const Offer& best) {
    if (clusters_[best.a].joined != kNone || clusters_[best.b].joined != kNone) return;
    Cluster& into = clusters_[best.a];
    Cluster& from = clusters_[best.b];
    if (into.version != best.version_a || from.version != best.version_b) {
      offer(best.a, best.b);  // one of them has grown since
      return;
    }
    FittedPlane plane = fit_union(into, from, kMergeSteps);
    if (plane.width() > rule_.width_cap) return;
    ++counts_.merges;
    --live_;
    into.plane = std::move(plane);
    into.vertices = united_;
    ++into.version;
    from.joined = best.a;
    std::vector<std::uint32_t> around;
    std::set_union(into.neighbours.begin(), into.neighbours.end(), from.neighbours.begin(),
                   from.neighbours.end(), std::back_inserter(around));
    std::erase_if(around, [&](std::uint32_t id) { return id == best.a || id == best.b; });
    into.neighbours = std::move(around);
    into.centrum = centrum_on_plane(space_, into.vertices, into.plane);
    for (const std::uint32_t id : into.neighbours) {
      rename(clusters_[id].neighbours, best.b, best.a);
      // Pairs with a wait in the queue under an old version, unless they were not wanted, or too wide for
      // ever.
      offer(std::min(best.a, id), std::max(best.a, id));
    }
    from =
        Cluster{.plane = {}, .vertices = {}, .neighbours = {}, .centrum = {}, .version = 0, .joined = best.a};
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

  void write_back() {
    std::vector<std::uint32_t> facet(clusters_.size(), kNone);
    std::vector<FittedPlane> planes;
    covering_.widest = 0.0;
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) {
      if (clusters_[id].joined != kNone) continue;
      facet[id] = static_cast<std::uint32_t>(planes.size());
      covering_.widest = std::max(covering_.widest, clusters_[id].plane.width());
      planes.push_back(std::move(clusters_[id].plane));
    }
    covering_.planes = std::move(planes);
    for (std::uint32_t& of_row : covering_.facet_of)
      if (of_row != kNone) of_row = facet[root(of_row)];
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const MergeRule& rule_;
  Covering& covering_;
  std::vector<Cluster> clusters_;
  std::size_t live_ = 0;
  std::priority_queue<Offer> offers_;
  std::vector<std::uint32_t> united_;
  PlaneFitWork work_;
  MergeCounts counts_;
};

}  // namespace

MergeCounts merge_clusters(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
                           Covering& covering) {
  return Merging(complex, space, rule, covering).run();
}

}  // namespace ndhull
