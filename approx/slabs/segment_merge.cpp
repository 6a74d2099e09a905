// Idea. Let no point be above the planes a and b, that is, a.y <= s and b.y <= t for all points y. Then of a
// plane (1 - u) a + u b, 0 <= u <= 1, no point is above (1 - u) s + u t, and how deep a vertex lies below
// that is linear in u. So two facets fit into one slab of width T when an interval of u is left by all their
// vertices: each takes off one end, and no other point is looked at. The slab's width is measured with |R a|,
// which is convex: the mean of both lengths gives the interval, the length itself decides in the end. Where a
// is the dual vertex of a simplex and b that of its neighbour, the segment is an edge of the dual polytope,
// and all its planes pass through their ridge.
#include "approx/slabs/segment_merge.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>

#include "approx/geometry/gradient_length.h"
#include "approx/slabs/segment_interval.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/huge_array.h"
#include "core/machine/prefetch.h"
#include "core/machine/team.h"

namespace ndhull {
namespace {

/// Neighbours are looked at whose vertex across a ridge is less than this part of the width below the slab.
constexpr double kReach = 1.0;
/// So many of them are tried, until one fits: all others leave 1 to 3 % fewer facets, in twice the time.
constexpr std::size_t kMostNeighbours = 4;

/// A facet as it has become.
struct JoinedFacet {
  std::uint32_t simplices;                   // 0: it has joined another
  std::uint32_t first_vertex, vertex_count;  // among those listed, or behind; none of a single simplex
  double top, room;                          // of its plane; how deep vertices may be below that
};
/// Between the facet that is being looked at and a neighbour.
struct RidgeBetween {
  std::uint32_t place;  // of the neighbour, among those that are looked at
  std::uint32_t own;    // the facet's vertex opposite the ridge
  double height;        // of the neighbour's, below the facet's plane
};
/// Across a ridge; the planes between that both fit below.
struct PossibleHost {
  std::uint32_t facet;
  Interval interval;
};
/// What a facet joins.
struct JoinHost {
  std::uint32_t facet = kNone;
  double place = 0.0;  // of the common plane on the segment to it
};
/// What one thread looks at.
struct HostSearch {
  explicit HostSearch(std::size_t facets) : place_of(facets, 0) {}
  std::vector<std::uint32_t> place_of;  // per facet: in neighbours, when it was there last
  std::vector<std::uint32_t> met;       // facets across the ridges, some of them often
  std::vector<PossibleHost> neighbours;
  std::vector<RidgeBetween> ridges;
  std::vector<std::array<double, 2>> depths;
  std::vector<double> own_depths;  // of the facet that is being looked at
};
/// As one thread would find it, if no facet that was met has changed since.
struct ForeseenHost {
  JoinHost host;
  std::vector<std::uint32_t> met;
};

template <std::size_t D>
class SegmentMerger {
 public:
  SegmentMerger(const SimplicialComplex& complex, const double* coordinates, std::span<const double> factor,
                std::size_t point_count, double width, DualFacets& facets)
      : complex_(complex),
        coordinates_(coordinates),
        length_of_(factor),
        width_(width),
        table_(facets),
        facet_of_(facets.facet_of_rows()),
        facets_(facets.count()),
        planes_(HugeArray<double>::to_write(facets.count() * D)),
        next_(facets.count(), kNone),
        last_(facets.count()),
        listed_(std::move(facets.vertices)),
        pass_of_(point_count, 0) {
    constexpr std::size_t kAhead = 8;  // planes are anywhere in memory
    for_each_block(facets.count(), kFacetsInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t facet = begin; facet < end; ++facet) {
        facets_[facet] = {.simplices = static_cast<std::uint32_t>(facets.size(facet)),
                          .first_vertex = facets.vertex_begin[facet],
                          .vertex_count = facets.vertex_begin[facet + 1] - facets.vertex_begin[facet],
                          .top = facets.tops[facet],
                          .room = width_ * double{facets.lengths[facet]}};
        prefetch(facets.plane(std::min<std::size_t>(facet + kAhead, facets.count() - 1)).data(), D);
        std::copy_n(facets.plane(facet).data(), D, planes_.data() + facet * D);
        last_[facet] = static_cast<std::uint32_t>(facet);
      }
    });
  }

  void run(std::size_t most_simplices) {
    std::vector<std::uint32_t> small;
    for (auto facet = static_cast<std::uint32_t>(table_.count()); facet-- > 0;)
      if (facets_[facet].simplices <= most_simplices) small.push_back(facet);
    const std::size_t threads = small.size() < kFewFacets ? 1 : team_threads(kMostThreads);
    if (threads > 1) {
      join_foreseen(small, most_simplices, threads);
    } else {
      HostSearch search(table_.count());
      for (std::size_t i = 0; i < small.size(); ++i) {
        fetch(small, i);
        if (is_small(small[i], most_simplices)) join(small[i], find_host(small[i], search));
      }
    }
    drop_joined();
  }

 private:
  /// Below this nothing is foreseen: a team takes some 0.1 ms to begin.
  static constexpr std::size_t kFewFacets = 512, kMostThreads = 8;
  static constexpr std::size_t kForeseenInBlock = 16, kBlocksOfThread = 4, kHostsAhead = 4;
  static constexpr std::size_t kFacetsInBlock = 1 << 12;

  /// Have no others joined it that it is not any more?
  bool is_small(std::uint32_t facet, std::size_t most_simplices) const {
    return facets_[facet].simplices <= most_simplices;
  }

  void ask_for_host(const JoinHost& host) const {
    if (host.facet == kNone) return;
    prefetch(&facets_[host.facet]);
    prefetch(plane_of(host.facet), D);
    prefetch(&table_.own_plane[host.facet]);
    prefetch(&last_[host.facet]);
  }

  /// The same joins in the same order. Hosts are looked for by all threads, some facets ahead; where a facet
  /// that was met has changed by then it is done again.
  void join_foreseen(std::span<const std::uint32_t> small, std::size_t most_simplices, std::size_t threads) {
    tbb::enumerable_thread_specific<HostSearch> searches([&] { return HostSearch(table_.count()); });
    std::vector<ForeseenHost> foreseen(kForeseenInBlock * kBlocksOfThread * threads);
    std::vector<std::uint32_t> round_of(table_.count(), 0);  // per facet: that changed it
    Team team(threads);
    std::uint32_t round = 0;
    for (std::size_t first = 0; first < small.size(); first += foreseen.size()) {
      const auto batch = small.subspan(first, std::min(foreseen.size(), small.size() - first));
      team.for_each_block(batch.size(), kForeseenInBlock, [&](std::size_t begin, std::size_t end) {
        HostSearch& search = searches.local();
        for (std::size_t i = begin; i < end; ++i) {
          fetch(batch, i);
          if (!is_small(batch[i], most_simplices)) continue;
          foreseen[i].host = find_host(batch[i], search);
          foreseen[i].met.swap(search.met);
        }
      });
      ++round;
      const auto has_changed = [&](std::uint32_t facet) { return round_of[facet] == round; };
      for (std::size_t i = 0; i < batch.size(); ++i) {
        ask_for_host(foreseen[std::min(i + kHostsAhead, batch.size() - 1)].host);
        if (!is_small(batch[i], most_simplices)) continue;
        JoinHost host = foreseen[i].host;
        if (has_changed(batch[i]) || std::ranges::any_of(foreseen[i].met, has_changed))
          host = find_host(batch[i], searches.local());
        if (host.facet == kNone) continue;
        join(batch[i], host);
        round_of[batch[i]] = round_of[host.facet] = round;
      }
    }
  }

  /// Begins the way from memory of what the facets after this one are made of.
  void fetch(std::span<const std::uint32_t> facets, std::size_t place) const {
    if (place + 2 < facets.size()) {
      const std::uint32_t later = facets[place + 2];
      prefetch(plane_of(later), D);
      for (const SimplexId member : table_.members_of(later)) {
        prefetch(row_of(member.value), 2 * D);
        table_.marks.ask_for(member.value);
      }
    }
    if (place + 1 == facets.size()) return;
    for (const SimplexId member : table_.members_of(facets[place + 1])) {
      for (std::size_t k = 0; k < D; ++k) {
        prefetch(&facet_of_[row_of(member.value)[D + k]]);
        table_.marks.ask_for(row_of(member.value)[D + k]);
      }
    }
  }

  const std::uint32_t* row_of(std::uint32_t row) const {
    return complex_.topology.data() + std::size_t{row} * 2 * D;
  }
  double dot(const double* plane, std::uint32_t point) const {
    return dot_in_frame<D>(plane, coordinates_ + std::size_t{point} * D);
  }
  const double* plane_of(std::uint32_t facet) const { return planes_.data() + std::size_t{facet} * D; }

  /// Calls visit(row) for all simplices of the facet and of those that have joined it.
  template <class Visit>
  void for_members(std::uint32_t facet, const Visit& visit) const {
    for (std::uint32_t part = facet; part != kNone; part = next_[part])
      for (const SimplexId member : table_.members_of(part)) visit(member.value);
  }

  std::span<const PointId> vertices_of(std::uint32_t facet) const {
    if (facets_[facet].simplices == 1) return complex_.vertices(SimplexId{table_.seeds[facet]});
    const std::size_t first = facets_[facet].first_vertex, own = listed_.size();
    return {first < own ? &listed_[first] : &joined_[first - own], facets_[facet].vertex_count};
  }

  /// The first that fits. To look for the one that it is narrowest with takes longer, and leaves more facets.
  JoinHost find_host(std::uint32_t facet, HostSearch& search) const {
    find_neighbours(facet, search);
    choose_neighbours(search.neighbours);
    for (const PossibleHost& neighbour : search.neighbours) prefetch(vertices_of(neighbour.facet).data());
    if (!search.neighbours.empty()) find_own_depths(facet, search);
    for (const PossibleHost& neighbour : search.neighbours) {
      JoinHost host{neighbour.facet};
      if (find_fit(facet, neighbour, search, host.place)) return host;
    }
    return {};
  }

  /// Neighbours, with what the two vertices across each ridge leave of the interval.
  void find_neighbours(std::uint32_t facet, HostSearch& search) const {
    std::vector<PossibleHost>& neighbours = search.neighbours;
    neighbours.clear();
    search.ridges.clear();
    search.met.clear();
    const double* plane = plane_of(facet);
    const double top = facets_[facet].top, room = facets_[facet].room, lowest = top - (1.0 + kReach) * room;
    for_members(facet, [&](std::uint32_t simplex) {
      const std::uint32_t* row = row_of(simplex);
      const SimplexMarks::Mark mark = table_.marks[simplex];
      for (std::size_t k = 0; k < D; ++k) {
        const std::uint32_t other = facet_of_[row[D + k]];
        if (other == facet) continue;
        search.met.push_back(other);
        const double height = dot(plane, table_.marks.vertex_across(mark, row[k], table_.marks[row[D + k]]));
        std::uint32_t& place = search.place_of[other];
        if (place >= neighbours.size() || neighbours[place].facet != other) {
          if (height < lowest) continue;
          place = static_cast<std::uint32_t>(neighbours.size());
          neighbours.push_back({other, Interval()});
          prefetch(&facets_[other]);
          prefetch(plane_of(other), D);
        }
        search.ridges.push_back({place, row[k], height});
      }
    });
    for (const RidgeBetween& ridge : search.ridges) {
      Interval& interval = neighbours[ridge.place].interval;
      if (interval.is_empty()) continue;
      const std::uint32_t other = neighbours[ridge.place].facet;
      const double room_of_other = facets_[other].room;
      // How deep each is below its own facet's plane is not looked at: it makes no more of the interval.
      interval.take(top - ridge.height - room, -room_of_other);
      interval.take(-room, facets_[other].top - dot(plane_of(other), ridge.own) - room_of_other);
    }
  }

  /// Keeps the neighbours that the ridges leave the longest intervals with, the longest first.
  static void choose_neighbours(std::vector<PossibleHost>& neighbours) {
    std::erase_if(neighbours, [](const PossibleHost& neighbour) { return neighbour.interval.is_empty(); });
    const auto is_longer = [](const PossibleHost& a, const PossibleHost& b) {
      const double length_of_a = a.interval.length(), length_of_b = b.interval.length();
      return length_of_a != length_of_b ? length_of_a > length_of_b : a.facet < b.facet;
    };
    const std::size_t chosen = std::min(kMostNeighbours, neighbours.size());
    std::ranges::partial_sort(neighbours, neighbours.begin() + static_cast<std::ptrdiff_t>(chosen),
                              is_longer);
    neighbours.resize(chosen);
  }

  /// How deep the facet's vertices are below its own plane.
  void find_own_depths(std::uint32_t facet, HostSearch& search) const {
    search.own_depths.clear();
    for (const PointId vertex : vertices_of(facet))
      search.own_depths.push_back(facets_[facet].top - dot(plane_of(facet), vertex.value));
  }

  /// Is there a plane between those of the two facets, at `place` on the segment, that both are less than the
  /// width below?
  bool find_fit(std::uint32_t facet, const PossibleHost& neighbour, HostSearch& search, double& place) const {
    const std::uint32_t other = neighbour.facet;
    Interval interval = neighbour.interval;
    const JoinedFacet &first = facets_[facet], &last = facets_[other];
    const double *first_plane = plane_of(facet), *last_plane = plane_of(other);
    search.depths.clear();
    const auto take = [&](double depth, double depth_of_other) {
      interval.take(depth - first.room, depth_of_other - last.room);
      search.depths.push_back({depth, depth_of_other});
      return !interval.is_empty();
    };
    const std::span<const PointId> own = vertices_of(facet);
    for (std::size_t i = 0; i < own.size(); ++i)
      if (!take(search.own_depths[i], last.top - dot(last_plane, own[i].value))) return false;
    for (const PointId vertex : vertices_of(other)) {
      if (!take(first.top - dot(first_plane, vertex.value), last.top - dot(last_plane, vertex.value)))
        return false;
    }
    place = interval.middle();
    double deepest = 0.0;
    for (const std::array<double, 2>& depth : search.depths)
      deepest = std::max(deepest, (1.0 - place) * depth[0] + place * depth[1]);
    std::array<double, D> between;
    mix_planes(first_plane, last_plane, place, between.data());
    return deepest < width_ * length_of_(between.data());
  }

  static void mix_planes(const double* first, const double* last, double place, double* out) {
    for (std::size_t k = 0; k < D; ++k) out[k] = (1.0 - place) * first[k] + place * last[k];
  }

  void join(std::uint32_t facet, const JoinHost& found) {
    const auto [host, place] = found;
    if (host == kNone) return;
    for_members(facet, [&](std::uint32_t row) { facet_of_[row] = host; });
    double* const between = planes_.data() + std::size_t{host} * D;
    mix_planes(plane_of(facet), between, place, between);
    if (table_.own_plane[host] == kNone) {
      table_.own_plane[host] = static_cast<std::uint32_t>(table_.own_planes.size() / D);
      table_.own_planes.resize(table_.own_planes.size() + D);
    }
    std::copy_n(between, D, table_.own_planes.data() + std::size_t{table_.own_plane[host]} * D);
    table_.lengths[host] = static_cast<float>(length_of_(between));
    table_.tops[host] = (1.0 - place) * table_.tops[facet] + place * table_.tops[host];
    // Vertices of the host, then those that only the facet has.
    union_.clear();
    ++pass_;
    for (const std::uint32_t part : {host, facet}) {
      for (const PointId vertex : vertices_of(part)) {
        if (pass_of_[vertex.value] == pass_) continue;
        pass_of_[vertex.value] = pass_;
        union_.push_back(vertex);
      }
    }
    facets_[host] = {.simplices = facets_[host].simplices + facets_[facet].simplices,
                     .first_vertex = static_cast<std::uint32_t>(listed_.size() + joined_.size()),
                     .vertex_count = static_cast<std::uint32_t>(union_.size()),
                     .top = table_.tops[host],
                     .room = width_ * double{table_.lengths[host]}};
    facets_[facet].simplices = 0;
    joined_.insert(joined_.end(), union_.begin(), union_.end());
    next_[last_[host]] = facet;
    last_[host] = last_[facet];
  }

  /// Leaves the facets that have not joined another, with all that have joined them.
  void drop_joined() {
    planes_ = {};  // in whose memory lists find place
    std::vector<SimplexId> members(table_.begin.back());
    std::vector<std::uint32_t> begin;
    begin.reserve(table_.begin.size());
    std::uint32_t used = 0, count = 0;
    for (std::uint32_t facet = 0; facet < table_.count(); ++facet) {
      if (facets_[facet].simplices == 0) continue;
      begin.push_back(count);
      for_members(facet, [&](std::uint32_t row) { members[count++] = SimplexId{row}; });
      table_.seeds[used] = table_.seeds[facet];
      table_.own_plane[used] = table_.own_plane[facet];
      table_.tops[used] = table_.tops[facet];
      table_.lengths[used++] = table_.lengths[facet];
    }
    begin.push_back(count);
    table_.members = std::move(members);
    table_.begin = std::move(begin);
    table_.vertex_begin = {};
    table_.seeds.resize(used);
    table_.own_plane.resize(used);
    table_.tops.resize(used);
    table_.lengths.resize(used);
  }

  const SimplicialComplex& complex_;
  const double* coordinates_;
  GradientLength<D> length_of_;
  double width_;
  DualFacets& table_;
  std::vector<std::uint32_t> facet_of_;  // per row of the complex: as joined
  std::vector<JoinedFacet> facets_;
  HugeArray<double> planes_;                      // facets x D
  std::vector<std::uint32_t> next_, last_;        // per facet: chains of those that have joined it
  std::vector<PointId> listed_, joined_, union_;  // each facet's vertices once, those of joined ones behind
  std::vector<std::uint32_t> pass_of_;            // per point: the last join that met it
  std::uint32_t pass_ = 0;
};

}  // namespace

void join_along_segments(const SimplicialComplex& complex, const double* coordinates,
                         std::span<const double> gradient_factor, std::size_t point_count, double width,
                         std::size_t most_simplices, DualFacets& facets) {
  call_with_dimension<2, kMaxRank>(complex.rank, [&](auto d) {
    SegmentMerger<d>(complex, coordinates, gradient_factor, point_count, width, facets).run(most_simplices);
  });
}

}  // namespace ndhull
