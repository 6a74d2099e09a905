#include "approx/cluster_merge.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <queue>
#include <vector>

#include "core/ids.h"
#include "core/prefetch.h"

namespace ndhull {
namespace {

/// Turning a plane halves the width of a union at best: what is this many times too wide is not turned.
constexpr double kHopeless = 2.0;
constexpr unsigned kTrialSteps = 6;   // of the fit when a pair is judged
constexpr unsigned kMergeSteps = 16;  // and in all when it is merged

class Merging {
 public:
  Merging(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
          Covering& covering)
      : complex_(complex), space_(space), rule_(rule), covering_(covering) {}

  MergeCounts run() {
    make_clusters();
    for (std::uint32_t id = 0; id < clusters_.size(); ++id) {
      for (const std::uint32_t other : clusters_[id].neighbours)
        if (id < other) announce(id, other);
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
    std::vector<std::uint32_t> tops;                  // points that made the plane's height
    std::vector<double> centrum;
    std::uint32_t version = 0;
    std::uint32_t joined = kNone;
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

  std::uint32_t root(std::uint32_t id) const {
    while (clusters_[id].joined != kNone) id = clusters_[id].joined;
    return id;
  }

  void make_clusters() {
    const std::size_t count = covering_.planes.size();
    clusters_.resize(count);
    live_ = count;
    constexpr std::size_t kSmallTables = std::size_t{1} << 21;
    if (count * (space_.vertex_count() + count) <= kSmallTables) {
      list_by_tables();
    } else {
      list_by_facets();
    }
    for (std::uint32_t id = 0; id < count; ++id) {
      Cluster& cluster = clusters_[id];
      cluster.plane = std::move(covering_.planes[id]);
      if (cluster.plane.height == 0.0) {  // a simplex with its own plane
        cluster.plane = measure_plane(space_, cluster.plane.normal, cluster.vertices, work_);
      } else {
        cluster.plane.low = lowest_dot(space_, cluster.plane.normal, cluster.vertices);
      }
      cluster.tops.assign(1, cluster.plane.highest);
      cluster.centrum = centrum_on_plane(space_, cluster.vertices, cluster.plane);
    }
  }

  /// Vertices and neighbours of few facets: a table each, filled as the rows stand in memory.
  void list_by_tables() {
    const std::size_t count = clusters_.size(), vertices = space_.vertex_count();
    std::vector<std::uint8_t> has_vertex(count * vertices, 0), has_neighbour(count * count, 0);
    for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
      const std::size_t id = covering_.facet_of[row];
      if (id == kNone) continue;
      for (const PointId point : complex_.vertices(SimplexId{row}))
        has_vertex[id * vertices + space_.row_of(point)] = 1;
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{row}))
        has_neighbour[id * count + covering_.facet_of[neighbour.value]] = 1;
    }
    const auto list = [](const std::uint8_t* flags, std::size_t size, std::vector<std::uint32_t>& entries) {
      for (std::uint32_t entry = 0; entry < size; ++entry)
        if (flags[entry] != 0) entries.push_back(entry);
    };
    for (std::size_t id = 0; id < count; ++id) {
      has_neighbour[id * count + id] = 0;
      list(has_vertex.data() + id * vertices, vertices, clusters_[id].vertices);
      list(has_neighbour.data() + id * count, count, clusters_[id].neighbours);
    }
  }

  void list_by_facets() {
    const std::size_t count = clusters_.size();
    const FacetMembers members_of(covering_);
    std::vector<std::uint32_t> vertex_seen(space_.table().count(), kNone), facet_seen(count, kNone);
    const auto add = [](std::vector<std::uint32_t>& list, std::vector<std::uint32_t>& seen,
                        std::uint32_t entry, std::uint32_t id) {
      if (seen[entry] == id) return;
      seen[entry] = id;
      list.push_back(entry);
    };
    constexpr std::size_t kRowsAhead = 8, kNeighboursAhead = 3;  // whose way from memory has begun
    for (std::uint32_t id = 0; id < count; ++id) {
      Cluster& cluster = clusters_[id];
      const std::span<const std::uint32_t> rows = members_of.of(id);
      facet_seen[id] = id;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const SimplexId later{rows[std::min(i + kRowsAhead, rows.size() - 1)]};
        prefetch(complex_.vertices(later).data());
        prefetch(&complex_.neighbours(later).back());
        const SimplexId soon{rows[std::min(i + kNeighboursAhead, rows.size() - 1)]};
        for (const SimplexId neighbour : complex_.neighbours(soon))
          prefetch(&covering_.facet_of[neighbour.value]);
        for (const PointId point : complex_.vertices(SimplexId{rows[i]}))
          add(cluster.vertices, vertex_seen, space_.row_of(point), id);
        for (const SimplexId neighbour : complex_.neighbours(SimplexId{rows[i]}))
          add(cluster.neighbours, facet_seen, covering_.facet_of[neighbour.value], id);
      }
      std::sort(cluster.vertices.begin(), cluster.vertices.end());
      std::sort(cluster.neighbours.begin(), cluster.neighbours.end());
    }
  }

  bool is_wanted(const Cluster& a, const Cluster& b) const {
    return rule_.wants(a.plane, a.centrum, b.plane, b.centrum);
  }

  /// normal_: the mean of the normals, weighted by the number of vertices.
  void take_mean(const Cluster& a, const Cluster& b) {
    normal_.resize(space_.rank());
    double length_sq = 0.0;
    for (std::size_t k = 0; k < normal_.size(); ++k) {
      normal_[k] = static_cast<double>(a.vertices.size()) * a.plane.normal[k] +
                   static_cast<double>(b.vertices.size()) * b.plane.normal[k];
      length_sq += normal_[k] * normal_[k];
    }
    if (!(length_sq > 0.0)) normal_ = a.plane.normal, length_sq = 1.0;
    for (double& entry : normal_) entry /= std::sqrt(length_sq);
  }

  /// united_: the union's vertices.
  void unite(const Cluster& a, const Cluster& b) {
    united_.clear();
    std::set_union(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                   std::back_inserter(united_));
  }

  /// Is the union too wide to be fitted, among its vertices and near_, along normal_? The first few vertices
  /// tell of most.
  bool is_hopeless(const Cluster& a, const Cluster& b) const {
    const double most = kHopeless * rule_.width_cap;
    double low = HUGE_VAL, high = -HUGE_VAL;
    const auto meet = [&](std::uint32_t row) {
      const double dot = std::inner_product(normal_.begin(), normal_.end(), space_.row(row), 0.0);
      low = std::min(low, dot);
      high = std::max(high, dot);
      return high - low > most;
    };
    for (const std::uint32_t row : near_)
      high = std::max(high, std::inner_product(normal_.begin(), normal_.end(), space_.row(row), 0.0));
    return std::any_of(a.vertices.begin(), a.vertices.end(), meet) ||
           std::any_of(b.vertices.begin(), b.vertices.end(), meet);
  }

  FittedPlane mean_plane(const Cluster& a, const Cluster& b) {
    unite(a, b);
    take_mean(a, b);
    return measure_plane(space_, normal_, united_, work_);
  }

  /// Puts the pair into the queue with a width that the union is not narrower than, to be looked at when its
  /// turn comes. Most pairs are gone by then.
  void announce(std::uint32_t a, std::uint32_t b) {
    const Cluster& first = clusters_[a];
    const Cluster& second = clusters_[b];
    if (!is_wanted(first, second)) return;
    const double least = std::max(first.plane.width(), second.plane.width());
    offers_.push({least, a, b, first.version, second.version, Stage::kParts});
  }

  /// The same with the width among the union's vertices and tops: most pairs that are too wide are so for
  /// these.
  void offer_tops(std::uint32_t a, std::uint32_t b, double least) {
    const Cluster& first = clusters_[a];
    const Cluster& second = clusters_[b];
    take_mean(first, second);
    near_ = first.tops;
    near_.insert(near_.end(), second.tops.begin(), second.tops.end());
    if (is_hopeless(first, second)) return;  // the more so over all points
    unite(first, second);
    const double width = turn_among(space_, normal_, near_, united_, kTrialSteps, work_);
    if (width > rule_.width_cap) return;
    offers_.push({std::max(width, least), a, b, first.version, second.version, Stage::kTops});
  }

  /// The same with the width of a fit; what is the narrowest offer even so is taken at once.
  void offer_fit(std::uint32_t a, std::uint32_t b) {
    const FittedPlane start = mean_plane(clusters_[a], clusters_[b]);
    if (start.width() > kHopeless * rule_.width_cap) return;
    const double width = turn_among_near(space_, start, united_, kTrialSteps, work_);
    if (width > rule_.width_cap) return;
    const Offer fitted{width, a, b, clusters_[a].version, clusters_[b].version, Stage::kFitted};
    if (!offers_.empty() && fitted < offers_.top()) {
      offers_.push(fitted);
    } else {
      merge(a, b, start);
    }
  }

  void take(const Offer& best) {
    const Cluster& into = clusters_[best.a];
    const Cluster& from = clusters_[best.b];
    if (into.joined != kNone || from.joined != kNone) return;
    if (into.version != best.version_a || from.version != best.version_b) return;  // announced anew since
    switch (best.stage) {
      case Stage::kParts: return offer_tops(best.a, best.b, best.width);
      case Stage::kTops: return offer_fit(best.a, best.b);
      case Stage::kFitted: break;
    }
    const FittedPlane start = mean_plane(into, from);
    turn_among_near(space_, start, united_, kTrialSteps, work_);
    merge(best.a, best.b, start);
  }

  /// Merges b into a if that is within the cap: united_ and work_ are those of the trial fit from `start`.
  void merge(std::uint32_t a, std::uint32_t b, const FittedPlane& start) {
    turn_further(kMergeSteps - kTrialSteps, work_);
    FittedPlane plane = measure_plane(space_, work_.best, united_, work_);
    if (plane.width() > start.width()) plane = start;
    if (plane.width() > rule_.width_cap) return;
    Cluster& into = clusters_[a];
    Cluster& from = clusters_[b];
    ++counts_.merges;
    --live_;
    into.plane = std::move(plane);
    into.vertices = united_;
    into.tops.assign(work_.points.tops().begin(), work_.points.tops().end());
    ++into.version;
    from.joined = a;
    std::vector<std::uint32_t> around;
    std::set_union(into.neighbours.begin(), into.neighbours.end(), from.neighbours.begin(),
                   from.neighbours.end(), std::back_inserter(around));
    std::erase_if(around, [&](std::uint32_t id) { return id == a || id == b; });
    into.neighbours = std::move(around);
    into.centrum = centrum_on_plane(space_, into.vertices, into.plane);
    for (const std::uint32_t id : into.neighbours) {
      rename(clusters_[id].neighbours, b, a);
      announce(std::min(a, id), std::max(a, id));
    }
    from = Cluster{
        .plane = {}, .vertices = {}, .neighbours = {}, .tops = {}, .centrum = {}, .version = 0, .joined = a};
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
  std::vector<std::uint32_t> united_, near_;
  std::vector<double> normal_;
  PlaneFitWork work_;
  MergeCounts counts_;
};

}  // namespace

MergeCounts merge_clusters(const SimplicialComplex& complex, const WidthSpace& space, const MergeRule& rule,
                           Covering& covering) {
  return Merging(complex, space, rule, covering).run();
}

}  // namespace ndhull
