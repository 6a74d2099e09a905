#include "approx/slabs/row_cover.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "approx/geometry/gradient_length.h"
#include "approx/slabs/slab_growth.h"
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
constexpr std::size_t kRowsSolved = 1 << 14;

/// The plane through a simplex as a dual vertex, by elimination with partial pivoting. Returns |determinant|.
template <std::size_t D>
double solve_simplex(std::array<std::array<double, D>, D>& matrix, std::array<double, D>& plane) {
  plane.fill(1.0);
  double determinant = 1.0;
  for (std::size_t c = 0; c < D; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < D; ++r)
      if (std::abs(matrix[r][c]) > std::abs(matrix[pivot][c])) pivot = r;
    std::swap(matrix[c], matrix[pivot]);
    std::swap(plane[c], plane[pivot]);
    determinant *= matrix[c][c];
    const double inverse = 1.0 / matrix[c][c];
    for (std::size_t r = c + 1; r < D; ++r) {
      const double factor = matrix[r][c] * inverse;
      for (std::size_t k = c + 1; k < D; ++k) matrix[r][k] -= factor * matrix[c][k];
      plane[r] -= factor * plane[c];
    }
  }
  for (std::size_t c = D; c-- > 0;) {
    for (std::size_t k = c + 1; k < D; ++k) plane[c] -= matrix[c][k] * plane[k];
    plane[c] /= matrix[c][c];
  }
  return std::abs(determinant);
}

struct RowScratch {
  RowScratch(const WidthSpace& space, std::size_t vertex_count) : slabs(space), is_among(vertex_count) {}
  SlabScratch slabs;
  std::vector<std::uint8_t> is_among;
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

template <std::size_t D>
class RowCover {
 public:
  RowCover(const SimplexRows& rows, const WidthSpace& space, const double* coordinates,
           std::span<const double> area_factor, double width, const CoverQuestion& gives_up)
      : rows_(rows),
        space_(space),
        length_of_(space.gradient_factor()),
        area_of_(area_factor),
        width_(width),
        gives_up_(gives_up),
        state_(rows.count()),
        seeds_(D, kLanes),
        grower_(seeds_, space, nullptr, false),
        scratch_of_thread_([&] { return RowScratch(space, rows.vertex_count()); }) {
    vertices_.resize(rows.vertex_count() * D);
    for (std::uint32_t vertex = 0; vertex < rows.vertex_count(); ++vertex) {
      const double* y = coordinates + std::size_t{space.point_of(vertex).value} * D;
      std::copy_n(y, D, vertices_.data() + vertex * D);
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
  using Plane = std::array<double, D>;
  /// |determinant| of a row's vertices.
  double solve(std::uint32_t row, Plane& plane) const {
    std::array<std::uint32_t, D> ids;
    rows_.vertices_of(row, ids.data());
    std::array<std::array<double, D>, D> matrix;
    for (std::size_t k = 0; k < D; ++k) std::copy_n(vertices_.data() + ids[k] * D, D, matrix[k].data());
    return solve_simplex<D>(matrix, plane);
  }

  void classify() {
    double longest = 0.0;
    for (std::uint32_t vertex = 0; vertex < rows_.vertex_count(); ++vertex) {
      double length_sq = 0.0;
      for (std::size_t k = 0; k < D; ++k) length_sq += space_.row(vertex)[k] * space_.row(vertex)[k];
      longest = std::max(longest, std::sqrt(length_sq));
    }
    std::vector<double> least((rows_.count() + kRowsSolved - 1) / kRowsSolved, HUGE_VAL);
    for_each_block(rows_.count(), kRowsSolved, [&](std::size_t begin, std::size_t end) {
      Plane plane;
      for (std::size_t row = begin; row < end; ++row) {
        solve(static_cast<std::uint32_t>(row), plane);
        const double distance = 1.0 / length_of_(plane.data());
        least[begin / kRowsSolved] = std::min(least[begin / kRowsSolved], distance);
        state_[row] =
            static_cast<std::uint8_t>(std::min(kRowClasses - 1.0, kRowClasses * distance / longest));
      }
    });
    facets_.least_distance = *std::min_element(least.begin(), least.end());
  }

  /// The slabs of seeds, one a lane.
  void find_slabs(std::span<RowLane* const> lanes) {
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      std::array<std::uint32_t, D> ids;
      rows_.vertices_of(lanes[i]->seed, ids.data());
      for (std::size_t k = 0; k < D; ++k) seeds_.topology[i * 2 * D + k] = space_.point_of(ids[k]).value;
      Plane plane;
      solve(lanes[i]->seed, plane);
      std::copy_n(plane.data(), D, seeds_.planes.data() + i * D);
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
    facets_.planes.resize(facets_.planes.size() + D);
    facets_.area_vectors.resize(facets_.area_vectors.size() + D);
    facets_.determinants.push_back(0.0);
    return true;
  }

  /// The tables of the facets that were just made.
  void sum_up(std::span<RowLane* const> lanes) {
    for_each_block(lanes.size(), 1, [&](std::size_t i, std::size_t) {
      RowLane& lane = *lanes[i];
      lane.surface = 0.0;
      if (lane.facet == kNone) return;
      std::vector<std::uint8_t>& is_among = scratch_of_thread_.local().is_among;
      double* const plane_of_facet = facets_.planes.data() + std::size_t{lane.facet} * D;
      double* const area = facets_.area_vectors.data() + std::size_t{lane.facet} * D;
      space_.plane_of(lane.slab.plane.normal.data(), lane.slab.plane.height, plane_of_facet);
      for (const std::uint32_t row : lane.held) {
        Plane plane;
        const double determinant = solve(row, plane);
        facets_.determinants[lane.facet] += determinant;
        lane.surface += determinant * area_of_(plane.data());
        for (std::size_t k = 0; k < D; ++k) area[k] += determinant * plane[k];
        if (lane.held.size() == 1) std::copy_n(plane.data(), D, plane_of_facet);
        std::array<std::uint32_t, D> ids;
        rows_.vertices_of(row, ids.data());
        for (const std::uint32_t id : ids) is_among[id] = 1;
      }
      std::erase_if(lane.slab.vertices, [&](std::uint32_t vertex) { return is_among[vertex] == 0; });
      for (const std::uint32_t vertex : lane.slab.vertices) is_among[vertex] = 0;
    });
    for (RowLane* const lane : lanes) {
      facets_.surface += lane->surface;
      if (lane->facet == kNone) continue;
      facets_.vertices.append(lane->slab.vertices);
    }
  }

  const SimplexRows& rows_;
  const WidthSpace& space_;
  GradientLength<D> length_of_, area_of_;
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
  return call_with_dimension<3, kMaxRank>(rows.rank(), [&](auto d) {
    return RowCover<d>(rows, space, coordinates, area_factor, width, gives_up).run();
  });
}

}  // namespace ndhull
