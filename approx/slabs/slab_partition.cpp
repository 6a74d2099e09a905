// Idea. A slab is grown over neighbours from a seed and takes what no other slab has: each simplex is met
// once. The seed's plane is its plane, which no point is above where the hull is convex. Two things keep
// slabs few. Seeds near the hull's centre come first: a lower plane leaves more below the width. And seeds
// most of whose neighbours would be in their slab come before all others: how large a slab becomes shows
// there already, and what was taken of it as well. Where growth was short there is time for a third: the
// plane is turned to what is below it, and again to what the slab took, which makes room for more.
#include "approx/slabs/slab_partition.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "approx/slabs/seed_classes.h"
#include "approx/slabs/seed_planes.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Slabs that are grown to see how many simplices they hold; fewer where these hold an eighth of all.
constexpr std::size_t kSamples = 64, kFewSamples = 16;
/// Slabs are turned to what they hold from so many simplices on, which in the end are a tenth to a quarter
/// fewer: where growth has left out so many points, in parts of the vertices, that it saved the time for it,
/// and where slabs are so large that it hardly takes any. A plane among many points takes longer.
constexpr double kManyLeftOut = 0.5, kLongerOfLarge = 3.0;
constexpr double kTurned = 800.0, kTurnedOfSome = 250.0, kTurnedOfMany = 60.0;
constexpr int kTurns = 2;
/// Of so few slabs, as large as those turned where growth left some points out, it is better to choose among
/// overlapping ones.
constexpr double kFewSlabs = 100.0;
/// Below this mean, or where most are smaller than kMostThin, slabs are found from stars (thin_slabs.h); not of
/// so few simplices, of which walks take no longer. From the last size on they are a seventh more than walks
/// leave, in a tenth less of the whole time: stars of two neighbours are grown on, which leaves fewer.
constexpr double kThinSlabs = 16.0, kMostThin = 9.5, kGrownFromTwo = 5.0;
constexpr std::size_t kFewSimplices = std::size_t{1} << 14;
/// Of a seed's neighbours so many have to be open and in its slab before others are taken, and one more where
/// slabs hold many simplices: looking longer costs little beside them.
template <std::size_t D>
constexpr std::size_t kNeighboursIn = std::min(D, std::max<std::size_t>(5, (3 * D + 4) / 5));
constexpr double kManySimplices = 64.0;
constexpr std::size_t kRowsPrepared = 1 << 13;
/// Rows whose way from memory has begun. Of a slab's members only the next one's neighbours are asked for:
/// rows further ahead are on their way themselves where slabs are small, and to read them would be to wait.
constexpr std::size_t kAhead = 1, kSeedsAhead = 12, kPlanesAhead = 6, kOpenAhead = 3;

template <std::size_t D>
class Partitioner {
 public:
  Partitioner(const SimplicialComplex& complex, const WidthSpace& space, const double* coordinates,
              std::span<const double> factor, PointsAbove above, double width)
      : complex_(complex),
        space_(space),
        coordinates_(coordinates),
        above_(above),
        planes_(complex, space, factor, above, width),
        dots_(space.point_count()) {
    facets_.complex = &complex;
    facets_.marks = SimplexMarks(complex.row_count, space.point_count());
    for (std::uint32_t row = 0; row < complex.row_count; ++row) live_count_ += is_live(row) ? 1u : 0u;
    members_.resize(live_count_ + D);
  }

  /// Slabs will be found by walks.
  void choose_walks() {
    classes_.emplace(complex_, [this](std::size_t row) { return length_sq_of(row); });
  }

  /// To be called for all rows before slabs are found, some at a time, by any thread.
  void prepare(std::size_t begin, std::size_t end) {
    for (auto row = static_cast<std::uint32_t>(begin); row < end; ++row) {
      make_mark(row);
      if (classes_) classes_->put(row, length_sq_of(row));
    }
  }

  /// Of slabs where nothing is taken, before rows are prepared. Where they are large a few tell.
  SlabSizes slab_sizes() {
    constexpr std::size_t kStep = 27;  // prime to kSamples: the first few are from all over
    std::size_t sum = 0, slabs = 0;
    double inverse_sum = 0.0;
    for (std::size_t i = 0; i < (8 * sum < live_count_ ? kSamples : kFewSamples) && 2 * sum < live_count_;
         ++i) {
      const std::size_t place = 2 * (i * kStep % kSamples) + 1;
      const auto row = static_cast<std::uint32_t>(place * complex_.row_count / (2 * kSamples));
      if (!is_live(row)) continue;
      ++slabs;
      make_mark(row);
      SeedPlane<D> own = planes_.own(row);
      if (!planes_.raise_above_points(row, own)) continue;
      grow<true>(row, own);
      sum += count_;
      inverse_sum += 1.0 / static_cast<double>(count_);
      give_back({0, 0});
    }
    if (inverse_sum == 0.0) return {};
    return {static_cast<double>(sum) / static_cast<double>(slabs), static_cast<double>(slabs) / inverse_sum};
  }

  /// Is it worth growing overlapping slabs, and choosing a few of them?
  bool is_worth_choosing(const SlabSizes& sizes) const {
    return !above_.are_shifted() && space_.share_of_others() > kSomeLeftOut &&
           sizes.typical > kTurnedOfSome && expected_slabs(sizes) < kFewSlabs;
  }

  bool is_better_by_stars(const SlabSizes& sizes) const {
    return live_count_ >= kFewSimplices && (sizes.mean < kThinSlabs || sizes.typical < kMostThin);
  }

  double expected_slabs(const SlabSizes& sizes) const {
    return static_cast<double>(live_count_) / sizes.typical;
  }

  /// The marks of all simplices, no live one of them taken, and room for as many members.
  DualFacets take_table() {
    facets_.members = std::move(members_);
    return std::move(facets_);
  }

  /// Live rows, those whose planes are nearest to the centre first.
  std::vector<std::uint32_t> seeds_by_distance() {
    std::vector<std::uint32_t> seeds = classes_->sorted(live_count_);
    classes_.reset();
    return seeds;
  }

  /// `seeds`: seeds_by_distance().
  DualFacets run(const SlabSizes& sizes, std::vector<std::uint32_t> seeds) {
    const bool are_large = sizes.mean > kManySimplices && kNeighboursIn<D> + 1 < D;
    are_turned_ = is_worth_turning(sizes);
    for (const std::size_t least : {kNeighboursIn<D> + (are_large ? 1 : 0), std::size_t{2}, std::size_t{0}})
      take_slabs(seeds, least);
    facets_.begin.push_back(static_cast<std::uint32_t>(count_));
    facets_.vertex_begin.push_back(static_cast<std::uint32_t>(vertex_count_));
    facets_.members = std::move(members_);
    facets_.vertices.resize(vertex_count_);
    return std::move(facets_);
  }

 private:
  /// A product of the present slab's plane with a point.
  struct Dot {
    double value;
    std::uint32_t slab = 0;        // that it was computed for
    std::uint32_t is_in_slab = 0;  // a vertex of one of its simplices
  };
  /// How far the lists of facets are.
  struct Ends {
    std::size_t members, vertices;
  };

  void make_mark(std::uint32_t row) {
    std::uint32_t mix = 0;
    for (std::size_t k = 0; k < D; ++k) mix ^= row_of(row)[k];
    facets_.marks.put(row, mix, !is_live(row));
  }
  bool is_live(std::uint32_t row) const { return complex_.state[row] == SimplexState::kLive; }
  const std::uint32_t* row_of(std::uint32_t row) const {
    return complex_.topology.data() + std::size_t{row} * 2 * D;
  }
  double length_sq_of(std::size_t row) const {
    return planes_.length_sq_of(complex_.planes.data() + row * D);
  }
  double dot(const std::array<double, D>& plane, std::uint32_t point) const {
    return dot_in_frame<D>(plane.data(), coordinates_ + std::size_t{point} * D);
  }

  bool is_worth_turning(const SlabSizes& sizes) const {
    const double left_out = space_.share_of_others();
    const double least = left_out > kManyLeftOut   ? kTurnedOfMany
                         : left_out > kSomeLeftOut ? kTurnedOfSome
                                                   : kTurned;
    return sizes.typical > least * (space_.is_large() ? kLongerOfLarge : 1.0);
  }

  /// Appends the simplices of a slab, `own` being its plane: those that are in none yet and connected to the
  /// seed.
  template <bool kMakesMarks = false>
  void grow(std::uint32_t seed, const SeedPlane<D>& own) {
    ++slab_;
    members_[count_++] = SimplexId{seed};
    facets_.marks.set_taken(seed, true);
    make_room(D);
    for (std::size_t k = 0; k < D; ++k) {
      const std::uint32_t vertex = row_of(seed)[k];
      dots_[vertex] = {HUGE_VAL, slab_, 1};
      facets_.vertices[vertex_count_++] = PointId{vertex};
    }
    walk_from<kMakesMarks>(count_ - 1, own);
  }

  /// Turns the plane of the slab that begins there to the vertices that it has, and appends what it then
  /// takes.
  void grow_on(Ends begin, SeedPlane<D>& own) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const std::size_t before = count_;
      const auto vertices =
          std::span(facets_.vertices).subspan(begin.vertices, vertex_count_ - begin.vertices);
      if (count_ - begin.members == 1 || !planes_.turn_to(vertices, own)) return;
      ++slab_;
      for (const PointId vertex : vertices) dots_[vertex.value] = {HUGE_VAL, slab_, 1};
      walk_from<false>(begin.members, own);
      if (count_ == before) return;
    }
  }

  /// Takes what is in the slab beside these members and those appended.
  template <bool kMakesMarks>
  void walk_from(std::size_t next, const SeedPlane<D>& own) {
    SimplexMarks& marks = facets_.marks;
    SimplexId* const members = members_.data();
    const std::uint32_t slab = slab_;
    for (; next < count_; ++next) {
      if (next + kAhead < count_) {
        const std::uint32_t* later = row_of(members[next + kAhead].value) + D;
        for (std::size_t k = 0; k < D; ++k) marks.ask_for(later[k]);
      }
      const std::uint32_t* row = row_of(members[next].value);
      const SimplexMarks::Mark mark = marks[members[next].value];
      SimplexMarks::Mark open_marks[D];
      std::uint32_t open[D], across[D];
      std::size_t open_count = 0;
      for (std::size_t k = 0; k < D; ++k) {
        if (kMakesMarks && !marks.is_taken(row[D + k])) make_mark(row[D + k]);
        const SimplexMarks::Mark neighbour = marks[row[D + k]];
        open[open_count] = row[D + k];
        open_marks[open_count] = neighbour;
        across[open_count] = marks.vertex_across(mark, row[k], neighbour);
        open_count += SimplexMarks::is_taken(neighbour) ? 0u : 1u;
      }
      make_room(D);
      for (std::size_t i = 0; i < open_count; ++i) {
        Dot& known = dots_[across[i]];
        if (known.slab != slab) known = {dot(own.plane, across[i]), slab, 0};
        const bool is_taken = known.value >= own.least;
        facets_.vertices[vertex_count_] = PointId{across[i]};
        vertex_count_ += is_taken ? 1u - known.is_in_slab : 0u;
        known.is_in_slab = is_taken ? 1u : 0u;  // one that is not taken now never is
        members[count_] = SimplexId{open[i]};
        const std::uint32_t* asked = row_of(is_taken ? open[i] : members[next].value);
        prefetch(asked, 2 * D);
        marks.put(open[i], static_cast<std::uint32_t>(open_marks[i]), is_taken);
        count_ += is_taken ? 1u : 0u;
      }
    }
  }

  /// For so many more vertices.
  void make_room(std::size_t count) {
    if (vertex_count_ + count > facets_.vertices.size())
      facets_.vertices.resize(2 * facets_.vertices.size() + count);
  }

  void give_back(Ends begin) {
    for (std::size_t i = begin.members; i < count_; ++i) facets_.marks.set_taken(members_[i].value, false);
    count_ = begin.members;
    vertex_count_ = begin.vertices;
  }

  void add_facet(Ends begin, const SeedPlane<D>& own, bool fits) {
    facets_.seeds.push_back(members_[begin.members].value);
    facets_.begin.push_back(static_cast<std::uint32_t>(begin.members));
    facets_.vertex_begin.push_back(static_cast<std::uint32_t>(begin.vertices));
    if (count_ - begin.members == 1) vertex_count_ = begin.vertices;
    facets_.own_plane.push_back(own.is_fitted ? static_cast<std::uint32_t>(facets_.own_planes.size() / D)
                                              : kNone);
    if (own.is_fitted)
      facets_.own_planes.insert(facets_.own_planes.end(), own.plane.begin(), own.plane.end());
    if (fits) facets_.are_far_from_centre = facets_.are_far_from_centre && own.least > 0.0;
    facets_.tops.push_back(own.top);
    facets_.lengths.push_back(static_cast<float>(own.length));
  }

  /// Are so many of the seed's neighbours open at least?
  bool has_open(std::uint32_t seed, std::size_t least) const {
    std::size_t open = 0;
    for (std::size_t k = 0; k < D; ++k) open += facets_.marks.is_taken(row_of(seed)[D + k]) ? 0u : 1u;
    return open >= least;
  }
  /// Are they in the slab too? All are looked at, without a branch for each: what it turns on cannot be
  /// foreseen.
  bool has_in_slab(std::uint32_t seed, std::size_t least, const SeedPlane<D>& own) const {
    const SimplexMarks& marks = facets_.marks;
    const std::uint32_t* const row = row_of(seed);
    const SimplexMarks::Mark mark = marks[seed];
    std::size_t found = 0;
    for (std::size_t k = 0; k < D; ++k) {
      const SimplexMarks::Mark neighbour = marks[row[D + k]];
      const bool is_in = dot(own.plane, marks.vertex_across(mark, row[k], neighbour)) >= own.least;
      found += (is_in ? 1u : 0u) & (SimplexMarks::is_taken(neighbour) ? 0u : 1u);
    }
    return found >= least;
  }

  /// Grows slabs from the seeds in their order, those with `least` neighbours in their slab. What is left are
  /// the seeds that are in none.
  void take_slabs(std::vector<std::uint32_t>& seeds, std::size_t least) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      fetch(seeds, i);
      const std::uint32_t seed = seeds[i];
      if (facets_.marks.is_taken(seed)) continue;
      if (!take_slab(seed, least)) seeds[left++] = seed;
    }
    seeds.resize(left);
  }

  /// Begins the way from memory of what the seeds after this one are made of, and of their neighbours' marks.
  void fetch(std::span<const std::uint32_t> seeds, std::size_t place) const {
    const auto later = [&](std::size_t ahead) { return seeds[std::min(place + ahead, seeds.size() - 1)]; };
    facets_.marks.ask_for(later(kSeedsAhead));
    if (const std::uint32_t seed = later(kPlanesAhead); !facets_.marks.is_taken(seed)) {
      prefetch(complex_.planes.data() + std::size_t{seed} * D, D);
      prefetch(row_of(seed), 2 * D);
    }
    if (const std::uint32_t seed = later(kOpenAhead); !facets_.marks.is_taken(seed)) {
      for (std::size_t k = 0; k < D; ++k) facets_.marks.ask_for(row_of(seed)[D + k]);
    }
  }

  bool take_slab(std::uint32_t seed, std::size_t least) {
    if (!has_open(seed, least)) return false;
    SeedPlane<D> own = planes_.own(seed);
    if (!has_in_slab(seed, least, own)) return false;
    const bool fits = planes_.raise_above_points(seed, own);
    if (planes_.may_have_points_above() && least > 0 && !(fits && has_in_slab(seed, least, own)))
      return false;
    const Ends begin{count_, vertex_count_};
    if (fits) {
      if (are_turned_) planes_.turn_to_vertices_below(seed, own);
      grow(seed, own);
      if (are_turned_) grow_on(begin, own);
    } else {
      members_[count_++] = SimplexId{seed};
      facets_.marks.set_taken(seed, true);
    }
    add_facet(begin, own, fits);
    if (!fits) facets_.unfit.push_back(seed);
    return true;
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const double* coordinates_;
  PointsAbove above_;
  SeedPlanes<D> planes_;
  std::optional<SeedClasses> classes_;
  std::vector<Dot> dots_;  // per point
  bool are_turned_ = false;
  std::uint32_t slab_ = 0;          // each time that a plane is new
  std::vector<SimplexId> members_;  // as far as they are listed: count_
  std::size_t live_count_ = 0, count_ = 0, vertex_count_ = 0;
  DualFacets facets_;
};

}  // namespace

std::optional<DualFacets> partition_into_slabs(const SimplicialComplex& complex, const WidthSpace& space,
                                               const double* coordinates,
                                               std::span<const double> gradient_factor, PointsAbove above,
                                               double width, const FindDeterminants& find_determinants,
                                               PartitionTask& task) {
  if (space.point_count() > SimplexMarks::kMostPoints) return std::nullopt;
  return call_with_dimension<2, kMaxRank>(complex.rank, [&](auto d) -> std::optional<DualFacets> {
    Partitioner<d> partitioner(complex, space, coordinates, gradient_factor, above, width);
    const SlabSizes sizes = task.sizes ? *task.sizes : partitioner.slab_sizes();
    if (partitioner.is_worth_choosing(sizes)) return std::nullopt;
    task.expected_facets = partitioner.expected_slabs(sizes);
    if (task.has_too_many()) return std::nullopt;
    const bool walks = !(find_determinants && partitioner.is_better_by_stars(sizes));
    if (walks) partitioner.choose_walks();
    const auto prepare = [&](std::size_t begin, std::size_t end) { partitioner.prepare(begin, end); };
    // One thread finds them while it has the rows near; not where points left out may have to come in before.
    const bool finds_beside = find_determinants && has_more_threads();
    const bool finds_first = find_determinants && !finds_beside && above.are_none();
    if (finds_first && walks) {
      find_determinants(prepare);
    } else {
      for_each_block(complex.row_count, kRowsPrepared, prepare);
    }
    const auto grown = sizes.typical < kGrownFromTwo ? GrownStars::kOfHalf : GrownStars::kFromTwo;
    if (!walks)
      return partition_into_thin_slabs(space, coordinates, gradient_factor, above, width, grown,
                                       find_determinants, partitioner.take_table());
    std::vector<std::uint32_t> seeds = partitioner.seeds_by_distance();
    DualFacets facets;
    const auto run = [&] { facets = partitioner.run(sizes, std::move(seeds)); };
    if (finds_beside) {
      do_beside(run, [&] { find_determinants([](std::size_t, std::size_t) {}); });
    } else {
      run();
    }
    task.sizes = {sizes.mean, static_cast<double>(facets.begin.back()) / static_cast<double>(facets.count())};
    return facets;
  });
}

}  // namespace ndhull
