// Idea. Slabs that hold a handful of simplices are little more than a seed and those of its neighbours that
// are less than the width below its plane: its star. Which those are is asked of all simplices first, in the
// order of memory. Then the largest stars are taken first, as in a greedy set cover, and each grows on over
// further neighbours. What is left has no star: two of them fit below a plane between theirs more often.
//
// Of neighbours i and j let a and b be the dual planes, v and w the vertices opposite their ridge. w lies
// p = 1 - a.w below a. In the cone of i, w has the coordinates l with sum a.w, and l_v = -det j / det i; so v
// lies q = 1 - b.v = p det i / det j below b, and b is not looked at. All planes (1 - u) a + u b pass through
// the ridge; w is (1 - u) p below, v is u q: least at u = p / (p + q) = det j / (det i + det j), the plane
// of the mean normal.
#include "approx/slabs/thin_slabs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "approx/slabs/seed_planes.h"
#include "approx/slabs/star_passes.h"
#include "approx/slabs/star_search.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Rows whose way from memory has begun.
constexpr std::size_t kRowsAhead = 8, kMembersAhead = 1;
constexpr std::size_t kPairRowsInBlock = 1 << 13;

template <std::size_t D>
class ThinPartitioner {
 public:
  ThinPartitioner(const WidthSpace& space, const double* coordinates, std::span<const double> factor,
                  PointsAbove above, double width, GrownStars grown,
                  const FindDeterminants& find_determinants, DualFacets facets)
      : complex_(*facets.complex),
        coordinates_(coordinates),
        find_determinants_(find_determinants),
        planes_(complex_, space, factor, above, width),
        width_(width),
        grows_from_(grown == GrownStars::kFromTwo ? 2 : D / 2),
        row_count_(static_cast<std::uint32_t>(complex_.row_count)),
        facets_(std::move(facets)),
        fitting_(row_count_),
        point_count_(space.point_count()) {}

  DualFacets run() {
    StarSearch<D> stars(complex_, std::span(coordinates_, point_count_ * D), facets_.marks, planes_, width_);
    stars.find(fitting_);
    do_beside([&] { take_all_stars(); },
              [&] { determinants_ = find_determinants_([](std::size_t, std::size_t) {}); });
    take_pairs();
    take_others();
    fitting_ = {};  // in whose memory tables of facets find place
    list_facets(facets_, member_count_, with_planes_);
    // Planes between two others, and raised ones, are no nearer.
    facets_.are_far_from_centre = facets_.are_far_from_centre && stars.are_far_from_centre();
    return std::move(facets_);
  }

 private:
  bool is_taken(std::uint32_t row) const { return facets_.marks.is_taken(row); }
  const std::uint32_t* row_of(std::uint32_t row) const {
    return complex_.topology.data() + std::size_t{row} * 2 * D;
  }
  const double* plane_of(std::uint32_t row) const { return complex_.planes.data() + std::size_t{row} * D; }
  double dot(const double* plane, std::uint32_t point) const {
    return dot_in_frame<D>(plane, coordinates_ + std::size_t{point} * D);
  }
  std::uint32_t vertex_across(std::uint32_t row, std::size_t k) const {
    const std::uint32_t* const vertices = row_of(row);
    return facets_.marks.vertex_across(facets_.marks[row], vertices[k], facets_.marks[vertices[D + k]]);
  }

  /// Largest first, as in a greedy cover. All sizes, one by one, would save 1.5 % of the facets in 8-d and
  /// take a fifth more time.
  void take_all_stars() {
    passes_.list(fitting_);
    for (unsigned pass = passes_.kCount - 1; pass > 0; --pass)
      for (const std::span<const std::uint32_t> rows : {passes_.listed(pass), passes_.again(pass)})
        take_stars(rows, passes_.takes(pass));
  }

  /// Takes those stars with so many neighbours that are in no other. Others come again in a later pass.
  void take_stars(std::span<const std::uint32_t> rows, unsigned least) {
    for_each_open(
        0, rows.size(), [&](std::size_t i) { return rows[i]; }, [](std::uint32_t) {},
        [&](std::uint32_t row) {
          prefetch(&fitting_[row]);
          if (least >= grows_from_) prefetch(plane_of(row), D);
        },
        [&](std::uint32_t row) { take_star(row, least); });
  }

  /// Calls visit for those of the rows row_at(begin) up to row_at(end - 1) that are in no facet, in this
  /// order; `ask` for each some time before, and `fetch` between.
  template <class RowAt, class Ask, class Fetch, class Visit>
  void for_each_open(std::size_t begin, std::size_t end, const RowAt& row_at, const Ask& ask,
                     const Fetch& fetch, const Visit& visit) {
    constexpr std::size_t kAtATime = 1024;
    std::array<std::uint32_t, kAtATime + 1> rows;
    for (std::size_t first = begin; first < end; first += kAtATime) {
      const std::size_t last = std::min(first + kAtATime, end);
      std::size_t count = 0;
      for (std::size_t i = first; i < last; ++i) {
        rows[count] = static_cast<std::uint32_t>(row_at(i));
        count += is_taken(rows[count]) ? 0u : 1u;  // no branch
      }
      for (std::size_t i = 0; i < count + 3 * kRowsAhead; ++i) {
        if (i < count) prefetch(row_of(rows[i]), 2 * D);
        if (i >= kRowsAhead && i < count + kRowsAhead) ask(rows[i - kRowsAhead]);
        if (i >= 2 * kRowsAhead && i < count + 2 * kRowsAhead) fetch(rows[i - 2 * kRowsAhead]);
        if (i >= 3 * kRowsAhead && !is_taken(rows[i - 3 * kRowsAhead])) visit(rows[i - 3 * kRowsAhead]);
      }
    }
  }

  void take_star(std::uint32_t row, unsigned least) {
    keep_open(row, fitting_[row]);
    SeedPlane<D> own;  // far away in memory: not read where bits say all
    const bool is_raised = planes_.may_have_points_above();
    if (is_raised && count_bits(fitting_[row]) >= least) {
      own = planes_.own(row);
      planes_.raise_top(own);
      keep_above(row, own, fitting_[row]);
    }
    if (count_bits(fitting_[row]) < least) return passes_.put_back(row, fitting_[row]);
    add_facet(row);
    const std::size_t first = member_count_;
    for (unsigned bits = fitting_[row]; bits != 0; bits &= bits - 1)
      take(row_of(row)[D + static_cast<std::size_t>(std::countr_zero(bits))]);
    if (member_count_ - first < grows_from_) return;
    for (std::size_t i = first; i < member_count_; ++i) prefetch(row_of(facets_.members[i].value), 2 * D);
    if (!is_raised) own = planes_.own(row);
    grow(first, own);
  }

  /// Of these neighbours those that are in no facet.
  void keep_open(std::uint32_t row, NeighbourBits& bits) const {
    unsigned open = 0;
    for (unsigned left = bits; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      open |= (is_taken(row_of(row)[D + k]) ? 0u : 1u) << k;
    }
    bits = static_cast<NeighbourBits>(open);
  }

  /// Of these neighbours those in the slab; none where the seed itself is not.
  void keep_above(std::uint32_t row, const SeedPlane<D>& own, NeighbourBits& bits) const {
    unsigned above = 0;
    for (unsigned left = own.least <= 1.0 ? bits : 0u; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      above |= (dot(own.plane.data(), vertex_across(row, k)) >= own.least ? 1u : 0u) << k;
    }
    bits = static_cast<NeighbourBits>(above);
  }

  /// Into the last facet.
  void take(std::uint32_t row) {
    facets_.marks.set_taken(row, true);
    facets_.members[member_count_++] = SimplexId{row};
  }

  /// Takes what is in the slab behind neighbours that were taken from a seed, `next` being the first. What
  /// one turns out to be cannot be foreseen: each is written behind what was taken, and stays there or not.
  void grow(std::size_t next, const SeedPlane<D>& own) {
    SimplexMarks& marks = facets_.marks;
    SimplexId* const members = facets_.members.data();
    for (; next < member_count_; ++next) {
      if (next + kMembersAhead < member_count_) {
        const std::uint32_t* const later = row_of(members[next + kMembersAhead].value) + D;
        for (std::size_t k = 0; k < D; ++k) marks.ask_for(later[k]);
      }
      const std::uint32_t* const row = row_of(members[next].value);
      const SimplexMarks::Mark mark = marks[members[next].value];
      SimplexMarks::Mark open_marks[D];
      std::uint32_t open[D], across[D];
      std::size_t count = 0;
      for (std::size_t k = 0; k < D; ++k) {
        const SimplexMarks::Mark neighbour = marks[row[D + k]];
        open[count] = row[D + k];
        open_marks[count] = neighbour;
        across[count] = marks.vertex_across(mark, row[k], neighbour);
        count += SimplexMarks::is_taken(neighbour) ? 0u : 1u;
      }
      for (std::size_t i = 0; i < count; ++i) {
        const bool is_in = dot(own.plane.data(), across[i]) >= own.least;
        members[member_count_] = SimplexId{open[i]};
        prefetch(row_of(is_in ? open[i] : members[next].value), 2 * D);
        marks.put(open[i], static_cast<std::uint32_t>(open_marks[i]), is_in);
        member_count_ += is_in ? 1u : 0u;
      }
    }
  }

  /// Two simplices below a plane between theirs: each, in the order of memory, with the first neighbour that
  /// fits. Where there are threads for it these see first which fit at all.
  void take_pairs() {
    passes_ = {};
    facets_.own_planes.reserve((row_count_ - member_count_) / 2 * D);  // address space: few are used
    const auto list = [&](std::uint32_t row) {
      list_open_partners(row);
      ask_for_partners(row);
    };
    const auto ask_for_marks = [&](std::uint32_t row) {
      for (std::size_t k = 0; k < D; ++k) facets_.marks.ask_for(row_of(row)[D + k]);
    };
    const auto ask = [&](std::uint32_t row) { ask_for_partners(row); };
    const auto take_first = [&](std::uint32_t row) {
      for_fitting_partners(row, [&](std::size_t k, const SeedPlane<D>& plane) {
        add_facet(row, &plane.plane);
        take(row_of(row)[D + k]);
        return false;
      });
    };
    const auto each = [](std::size_t i) { return i; };
    if (!has_more_threads() || planes_.may_have_points_above())
      return for_each_open(0, row_count_, each, ask_for_marks, list, take_first);
    for_each_block(row_count_, kPairRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for_each_open(begin, end, each, ask_for_marks, list, [&](std::uint32_t row) {
        unsigned fitting = 0;
        for_fitting_partners(row, [&](std::size_t k, const SeedPlane<D>&) {
          fitting |= 1u << k;
          return true;
        });
        fitting_[row] = static_cast<NeighbourBits>(fitting);
      });
    });
    std::vector<std::uint32_t> has_any;
    for (std::uint32_t row = 0; row < row_count_; ++row)
      if (!is_taken(row) && fitting_[row] != 0) has_any.push_back(row);
    for_each_open(
        0, has_any.size(), [&](std::size_t i) { return has_any[i]; }, ask_for_marks, ask, take_first);
  }

  /// Neighbours that come later in memory and are in no facet. (Those before were asked.)
  void list_open_partners(std::uint32_t row) {
    unsigned open = 0;
    for (std::size_t k = 0; k < D; ++k) {
      const std::uint32_t other = row_of(row)[D + k];
      open |= ((other > row ? 1u : 0u) & (is_taken(other) ? 0u : 1u)) << k;
    }
    fitting_[row] = static_cast<NeighbourBits>(open);
  }

  void ask_for_partners(std::uint32_t row) const {
    prefetch(plane_of(row), D);
    for (unsigned bits = fitting_[row]; bits != 0; bits &= bits - 1) {
      const std::uint32_t other = row_of(row)[D + static_cast<std::size_t>(std::countr_zero(bits))];
      facets_.marks.ask_for(other);
      prefetch(&determinants_[other]);
      prefetch(plane_of(other), D);
    }
  }

  /// Calls visit(k, plane) for the listed neighbours that are in no facet and fit below a plane with the row,
  /// until it says no.
  template <class Visit>
  void for_fitting_partners(std::uint32_t row, const Visit& visit) {
    // The plane between is no longer than the longer one, which may be the other's: some room for that.
    constexpr double kLonger = 1.1;
    if (fitting_[row] == 0) return;
    const double room = kLonger * width_ * planes_.length_of(plane_of(row)), own = determinants_[row];
    for (unsigned bits = fitting_[row]; bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(bits));
      const std::uint32_t other = row_of(row)[D + k];
      if (is_taken(other)) continue;
      const double depth = 1.0 - dot(plane_of(row), vertex_across(row, k));
      if (!(depth * own <= room * (own + determinants_[other]))) continue;
      const std::optional<SeedPlane<D>> plane = plane_between(row, k);
      if (plane && !visit(k, *plane)) return;
    }
  }

  /// That both simplices are less than the width below. Nothing: there is none.
  std::optional<SeedPlane<D>> plane_between(std::uint32_t row, std::size_t k) {
    const std::uint32_t other = row_of(row)[D + k];
    const double first = determinants_[row], last = determinants_[other], sum = first + last;
    if (!(first > 0.0 && last > 0.0)) return std::nullopt;
    std::array<double, D> mean;
    for (std::size_t i = 0; i < D; ++i)
      mean[i] = (first * plane_of(row)[i] + last * plane_of(other)[i]) / sum;
    SeedPlane<D> plane = planes_.below(mean);
    if (planes_.may_have_points_above()) planes_.raise_top(plane);
    const double lowest =
        std::min({1.0, dot(mean.data(), row_of(row)[k]), dot(mean.data(), vertex_across(row, k))});
    if (!(lowest >= plane.least)) return std::nullopt;
    return plane;
  }

  void take_others() {
    for (std::uint32_t row = 0; row < row_count_; ++row) {
      if (is_taken(row)) continue;
      if (!planes_.may_have_points_above()) {
        add_facet(row);
        continue;
      }
      SeedPlane<D> own = planes_.own(row);
      if (!planes_.raise_above_points(row, own)) facets_.unfit.push_back(row);
      facets_.are_far_from_centre = facets_.are_far_from_centre && own.least > 0.0;
      add_facet(row, own.is_fitted ? &own.plane : nullptr);
    }
  }

  /// No plane: the seed's own. Seeds are marked: the tables, whose sizes are not known, are made in the end.
  void add_facet(std::uint32_t seed, const std::array<double, D>* plane = nullptr) {
    if (plane != nullptr) {
      with_planes_.push_back(seed);
      facets_.own_planes.insert(facets_.own_planes.end(), plane->begin(), plane->end());
    }
    take(seed);
    facets_.members[member_count_ - 1].value |= kSeedBit;
  }

  const SimplicialComplex& complex_;
  const double* coordinates_;
  const FindDeterminants& find_determinants_;
  std::span<const double> determinants_;
  SeedPlanes<D> planes_;
  double width_;
  std::size_t grows_from_;  // neighbours in a star from which on more are looked for behind them
  std::uint32_t row_count_;
  DualFacets facets_;
  std::vector<NeighbourBits> fitting_;  // per row: of the neighbours that its slab would take
  std::size_t point_count_;
  StarPasses<D> passes_;
  std::size_t member_count_ = 0;            // of those listed in facets_
  std::vector<std::uint32_t> with_planes_;  // seeds of facets that have planes of their own, in order
};

}  // namespace

DualFacets partition_into_thin_slabs(const WidthSpace& space, const double* coordinates,
                                     std::span<const double> gradient_factor, PointsAbove above, double width,
                                     GrownStars grown, const FindDeterminants& find_determinants,
                                     DualFacets facets) {
  return call_with_dimension<2, kMaxRank>(facets.complex->rank, [&](auto d) {
    return ThinPartitioner<d>(space, coordinates, gradient_factor, above, width, grown, find_determinants,
                              std::move(facets))
        .run();
  });
}

}  // namespace ndhull
