#include "approx/slabs/row_cover.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "approx/geometry/gradient_length.h"
#include "approx/slabs/slab_growth.h"
#include "core/complex/determinants.h"
#include "core/complex/simplicial_complex.h"
#include "core/dimension_switch.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Parts of the mean number of simplices, where nothing is taken yet, that a slab has to take, pass by pass.
constexpr std::array<double, 3> kWorthTaking{0.3, 0.05, 0.0};
/// Seeds whose slabs are found side by side, each from its own part of the rows: they hardly ever meet.
constexpr std::size_t kLanes = 64;
/// What the byte of a row says: its class, by its plane's distance from the centre; that its slab was put off
/// in this pass; that it is in a facet.
constexpr std::uint8_t kPutOff = 0x80, kTaken = 0xFF;
constexpr double kRowClasses = 127.0;
constexpr std::size_t kRowsSolved = 1 << 10;  // at a time

/// Some rows with their planes, as dual vertices.
struct SolvedRows {
  std::vector<std::uint32_t> vertices;        // rows x rank
  std::vector<double> planes;                 // rows x rank
  std::vector<double> determinants, lengths;  // determinants > 0
};

/// lengths[i] = |R a| for each of the planes a, R being `factor`.
void find_lengths(std::size_t rank, std::span<const double> factor, std::span<const double> planes,
                  std::span<double> lengths) {
  call_with_dimension<3, kMaxRank>(rank, [&](auto d) {
    const GradientLength<d> length_of(factor);
    for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = length_of(planes.data() + i * d);
  });
}

struct RowScratch {
  RowScratch(const WidthSpace& space, std::size_t vertex_count) : slabs(space), is_among(vertex_count) {}
  SlabScratch slabs;
  std::vector<std::uint8_t> is_among;
  SolvedRows solved;
};
/// The slab of one lane's seed, and the rows that it holds and no facet has.
struct RowLane {
  std::uint32_t next = 0, end = 0;
  std::uint32_t seed = 0;
  bool fits = false;
  VertexSlab slab;
  std::vector<std::uint32_t> held;
  std::uint32_t facet = kNone;
  double surface = 0.0;  // of what became the facet
};

class RowCover {
 public:
  RowCover(const SimplexRows& rows, const WidthSpace& space, const double* coordinates,
           std::span<const double> area_factor, double width, const CoverQuestion& gives_up)
      : rows_(rows),
        space_(space),
        area_factor_(area_factor),
        rank_(rows.rank()),
        width_(width),
        gives_up_(gives_up),
        state_(rows.count()),
        seeds_(rank_, kLanes),
        grower_(seeds_, space, nullptr, false),
        scratch_of_thread_([&] { return RowScratch(space, rows.vertex_count()); }) {
    vertices_.reserve(rows.vertex_count() * rank_);
    for (std::uint32_t vertex = 0; vertex < rows.vertex_count(); ++vertex) {
      const double* y = coordinates + std::size_t{space.point_of(vertex).value} * rank_;
      vertices_.insert(vertices_.end(), y, y + rank_);
    }
  }

  std::optional<RowFacets> run() {
    classify();
    const double mean = mean_size();
    for (const double part : kWorthTaking)
      if (!pass(std::max<std::size_t>(1, static_cast<std::size_t>(part * mean)))) return std::nullopt;
    return std::move(facets_);
  }

 private:
  /// row_at(i) for i < count; lengths by `factor`.
  template <class RowAt>
  void solve(std::size_t count, const RowAt& row_at, std::span<const double> factor,
             SolvedRows& solved) const {
    solved.vertices.resize(count * rank_);
    solved.planes.resize(count * rank_);
    solved.determinants.resize(count);
    solved.lengths.resize(count);
    for (std::size_t i = 0; i < count; ++i) rows_.vertices_of(row_at(i), solved.vertices.data() + i * rank_);
    solve_planes(rank_, vertices_.data(), solved.vertices, solved.planes, solved.determinants);
    for (double& determinant : solved.determinants) determinant = std::abs(determinant);
    find_lengths(rank_, factor, solved.planes, solved.lengths);
  }

  void classify() {
    double longest = 0.0;
    for (std::uint32_t vertex = 0; vertex < rows_.vertex_count(); ++vertex) {
      double length_sq = 0.0;
      for (std::size_t k = 0; k < rank_; ++k) length_sq += space_.row(vertex)[k] * space_.row(vertex)[k];
      longest = std::max(longest, std::sqrt(length_sq));
    }
    std::vector<double> least((rows_.count() + kRowsSolved - 1) / kRowsSolved, HUGE_VAL);
    for_each_block(rows_.count(), kRowsSolved, [&](std::size_t begin, std::size_t end) {
      SolvedRows& solved = scratch_of_thread_.local().solved;
      solve(
          end - begin, [&](std::size_t i) { return static_cast<std::uint32_t>(begin + i); },
          space_.gradient_factor(), solved);
      for (std::size_t row = begin; row < end; ++row) {
        const double distance = 1.0 / solved.lengths[row - begin];
        least[begin / kRowsSolved] = std::min(least[begin / kRowsSolved], distance);
        state_[row] =
            static_cast<std::uint8_t>(std::min(kRowClasses - 1.0, kRowClasses * distance / longest));
      }
    });
    facets_.least_distance = *std::min_element(least.begin(), least.end());
  }

  /// The slabs of seeds, one a lane.
  void find_slabs(std::span<RowLane* const> lanes) {
    SolvedRows seeds;
    solve(
        lanes.size(), [&](std::size_t i) { return lanes[i]->seed; }, space_.gradient_factor(), seeds);
    std::copy(seeds.planes.begin(), seeds.planes.end(), seeds_.planes.data());
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      for (std::size_t k = 0; k < rank_; ++k)
        seeds_.topology[i * 2 * rank_ + k] = space_.point_of(seeds.vertices[i * rank_ + k]).value;
      lanes[i]->slab.seed = static_cast<std::uint32_t>(i);
    }
    for_each_block(lanes.size(), 1, [&](std::size_t i, std::size_t) {
      RowScratch& scratch = scratch_of_thread_.local();
      RowLane& lane = *lanes[i];
      grower_.find_vertices_of(lane.slab, width_, CoverEffort(), scratch.slabs);
      std::vector<std::uint32_t>& vertices = lane.slab.vertices;
      std::sort(vertices.begin(), vertices.end());
      const double deepest = *std::max_element(lane.slab.depths.begin(), lane.slab.depths.end());
      lane.fits = deepest <= width_;
      for (const std::uint32_t vertex : vertices) scratch.is_among[vertex] = 1;
      lane.held.clear();
      rows_.for_each_within(vertices, scratch.is_among.data(), [&](std::uint32_t row) {
        if (state_[row] != kTaken) lane.held.push_back(row);
      });
      for (const std::uint32_t vertex : vertices) scratch.is_among[vertex] = 0;
    });
  }

  double mean_size() {
    std::vector<RowLane> lanes(kLanes);
    std::vector<RowLane*> chosen;
    for (std::size_t i = 0; i < kLanes; ++i) {
      lanes[i].seed = static_cast<std::uint32_t>((2 * i + 1) * rows_.count() / (2 * kLanes));
      chosen.push_back(&lanes[i]);
    }
    find_slabs(chosen);
    std::size_t sum = 0;
    for (const RowLane& lane : lanes) sum += lane.held.size();
    return static_cast<double>(sum) / kLanes;
  }

  /// Slabs around all rows that are in none, those of the nearest planes first. False: given up.
  bool pass(std::size_t least) {
    for (std::uint8_t& state : state_)
      if (state != kTaken) state &= static_cast<std::uint8_t>(~kPutOff);
    std::vector<RowLane> lanes(kLanes);
    for (std::size_t row_class = 0; row_class < static_cast<std::size_t>(kRowClasses); ++row_class) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        lanes[i].next = static_cast<std::uint32_t>(i * rows_.count() / kLanes);
        lanes[i].end = static_cast<std::uint32_t>((i + 1) * rows_.count() / kLanes);
      }
      for (std::vector<RowLane*> chosen(1); !chosen.empty();) {
        chosen.clear();
        for (RowLane& lane : lanes) {
          const auto found = std::find(state_.begin() + lane.next, state_.begin() + lane.end,
                                       static_cast<std::uint8_t>(row_class));
          lane.seed = static_cast<std::uint32_t>(found - state_.begin());
          lane.next = std::min(lane.seed + 1, lane.end);
          if (lane.seed < lane.end) chosen.push_back(&lane);
        }
        if (chosen.empty()) break;
        if (gives_up_ && gives_up_(rows_.count() - taken_, facets_.count())) return false;
        find_slabs(chosen);
        for (RowLane* const lane : chosen)
          if (!take(*lane, least)) return false;
        sum_up(chosen);
      }
    }
    return true;
  }

  /// Makes a facet of what the slab holds, or puts it off. False: the seed alone is too wide.
  bool take(RowLane& lane, std::size_t least) {
    lane.facet = kNone;
    if (!lane.fits) return false;
    std::erase_if(lane.held, [&](std::uint32_t row) { return state_[row] == kTaken; });
    if (state_[lane.seed] == kTaken) return true;  // by a lane before this one
    if (lane.held.size() < least) {
      for (const std::uint32_t row : lane.held) state_[row] |= kPutOff;
      state_[lane.seed] |= kPutOff;
      return true;
    }
    for (const std::uint32_t row : lane.held) state_[row] = kTaken;
    taken_ += lane.held.size();
    lane.facet = static_cast<std::uint32_t>(facets_.count());
    facets_.sizes.push_back(static_cast<std::uint32_t>(lane.held.size()));
    facets_.planes.resize(facets_.planes.size() + rank_);
    facets_.area_vectors.resize(facets_.area_vectors.size() + rank_);
    facets_.determinants.push_back(0.0);
    return true;
  }

  /// The tables of the facets that were just made.
  void sum_up(std::span<RowLane* const> lanes) {
    for_each_block(lanes.size(), 1, [&](std::size_t i, std::size_t) {
      RowLane& lane = *lanes[i];
      lane.surface = 0.0;
      if (lane.facet == kNone) return;
      RowScratch& scratch = scratch_of_thread_.local();
      std::vector<std::uint8_t>& is_among = scratch.is_among;
      double* const plane_of_facet = facets_.planes.data() + lane.facet * rank_;
      double* const area = facets_.area_vectors.data() + lane.facet * rank_;
      space_.plane_of(lane.slab.plane.normal.data(), lane.slab.plane.height, plane_of_facet);
      for (std::size_t begin = 0; begin < lane.held.size(); begin += kRowsSolved) {
        const std::size_t count = std::min(kRowsSolved, lane.held.size() - begin);
        solve(
            count, [&](std::size_t r) { return lane.held[begin + r]; }, area_factor_, scratch.solved);
        add_up(scratch.solved, lane, area);
        for (const std::uint32_t vertex : scratch.solved.vertices) is_among[vertex] = 1;
      }
      if (lane.held.size() == 1) std::copy_n(scratch.solved.planes.data(), rank_, plane_of_facet);
      std::erase_if(lane.slab.vertices, [&](std::uint32_t vertex) { return is_among[vertex] == 0; });
      for (const std::uint32_t vertex : lane.slab.vertices) is_among[vertex] = 0;
    });
    for (RowLane* const lane : lanes) {
      facets_.surface += lane->surface;
      if (lane->facet == kNone) continue;
      facets_.vertices.append(lane->slab.vertices);
    }
  }

  /// Determinants and areas of some simplices of the lane's facet.
  void add_up(const SolvedRows& solved, RowLane& lane, double* area) {
    for (std::size_t i = 0; i < solved.determinants.size(); ++i) {
      const double determinant = solved.determinants[i];
      facets_.determinants[lane.facet] += determinant;
      lane.surface += determinant * solved.lengths[i];
      for (std::size_t k = 0; k < rank_; ++k) area[k] += determinant * solved.planes[i * rank_ + k];
    }
  }

  const SimplexRows& rows_;
  const WidthSpace& space_;
  std::span<const double> area_factor_;
  std::size_t rank_;
  double width_;
  const CoverQuestion& gives_up_;
  std::vector<std::uint8_t> state_;  // per row
  std::uint64_t taken_ = 0;
  SimplicialComplex seeds_;  // of the slabs that are being found
  SlabGrower grower_;
  tbb::enumerable_thread_specific<RowScratch> scratch_of_thread_;
  std::vector<double> vertices_;  // in the frame
  RowFacets facets_;
};

}  // namespace

std::optional<RowFacets> cover_rows(const SimplexRows& rows, const WidthSpace& space,
                                    const double* coordinates, std::span<const double> area_factor,
                                    double width, const CoverQuestion& gives_up) {
  return RowCover(rows, space, coordinates, area_factor, width, gives_up).run();
}

}  // namespace ndhull
