#include "core/determinants.h"

#include <cmath>

#include "core/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/determinants.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/block_elimination-inl.h"
#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/prefetch.h"
#include "core/row_slots-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
// Simplices that one thread takes at a time: a multiple of all vectors' lanes.
constexpr std::size_t kSimplicesInBlock = 2048;

/// What elimination finds of the simplices of a block, one a lane.
template <std::size_t D>
struct SolvedBlock {
  HWY_ALIGN double dual[D * HWY_MAX_BYTES / sizeof(double)];  // entry k of a lane at k * lanes + lane
  HWY_ALIGN double determinant[HWY_MAX_BYTES / sizeof(double)];
  HWY_ALIGN double smallest[HWY_MAX_BYTES / sizeof(double)];  // diagonal entry
};

template <std::size_t D, bool kPivots>
void solve_block(const double* const* rows, SolvedBlock<D>& solved) {
  const Tag tag;
  const std::size_t lanes = hn::Lanes(tag);
  HWY_ALIGN double entries[D * D * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double* row = rows[lane * D + i];
      for (std::size_t k = 0; k < D; ++k) entries[(i * D + k) * lanes + lane] = row[k];
    }
  }
  Lane matrix[D][D + 1], dual[D], smallest = hn::Set(tag, 1.0);
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t k = 0; k < D; ++k) matrix[i][k] = hn::Load(tag, entries + (i * D + k) * lanes);
    matrix[i][D] = hn::Set(tag, 1.0);
  }
  const Lane determinant = eliminate<D, kPivots>(matrix, dual, &smallest);
  for (std::size_t k = 0; k < D; ++k) hn::StoreU(dual[k], tag, solved.dual + k * lanes);
  hn::Store(determinant, tag, solved.determinant);
  hn::Store(smallest, tag, solved.smallest);
}

/// Has elimination without pivots lost no digits to speak of? Then the solved plane agrees with that of
/// growth. It may agree where the determinant is wrong, since the right side can be blind to what was lost:
/// then a diagonal entry is small. Simplices that fail are few.
template <std::size_t D>
bool is_good(const SolvedBlock<D>& solved, std::size_t lane, const double* plane, std::size_t lanes) {
  constexpr double kAgreement = 1e-11, kSmall = 1e-4;
  double largest = 0.0, difference = 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    largest = std::max(largest, std::abs(plane[k]));
    difference += std::abs(solved.dual[k * lanes + lane] - plane[k]);  // keeps NaN
  }
  return difference <= kAgreement * largest && solved.smallest[lane] > kSmall;
}

/// Takes the solved plane when it is one: finite and near the plane that growth made.
template <std::size_t D>
void take_plane(double* plane, const double* solved, std::size_t lanes) {
  constexpr double kSamePlane = 1e-6;
  double largest = 0.0, change = 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    largest = std::max(largest, std::abs(plane[k]));
    const double difference = std::abs(solved[k * lanes] - plane[k]);
    change = difference <= change ? change : difference;  // keeps NaN
  }
  if (!(change <= kSamePlane * largest)) return;
  for (std::size_t k = 0; k < D; ++k) plane[k] = solved[k * lanes];
}

/// Solves simplices, as many at a time as a vector has lanes. What one gets does not depend on those beside
/// it.
template <std::size_t D>
class BatchSolver {
 public:
  /// `is_shifted`: one a point, or none.
  BatchSolver(const SimplicialComplex& complex, const double* points,
              std::span<const std::uint8_t> is_shifted)
      : complex_(complex),
        points_(points),
        is_shifted_(is_shifted),
        lanes_(hn::Lanes(Tag())),
        rows_(lanes_ * D),
        is_replaced_(lanes_),
        wants_pivots_(lanes_) {}

  std::size_t lanes() const { return lanes_; }

  /// Of at least one simplex, at most one a lane.
  void solve(std::span<const std::uint32_t> simplices) {
    std::size_t replaced = 0;
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
      const auto vertices = complex_.vertices(SimplexId{simplices[std::min(lane, simplices.size() - 1)]});
      for (std::size_t i = 0; i < D; ++i) rows_[lane * D + i] = points_ + std::size_t{vertices[i].value} * D;
      if (is_shifted_.empty()) continue;
      std::uint8_t any = 0;
      for (const PointId id : vertices) any |= is_shifted_[id.value];
      is_replaced_[lane] = any;
      replaced += any;
    }
    if (replaced < lanes_) solve_block<D, false>(rows_.data(), plain_);
    bool any_wants = false;
    for (std::size_t lane = 0; lane < simplices.size(); ++lane) {
      const double* const plane = complex_.plane(SimplexId{simplices[lane]}).data();
      wants_pivots_[lane] = is_replaced_[lane] != 0 || !is_good<D>(plain_, lane, plane, lanes_) ? 1 : 0;
      any_wants = any_wants || wants_pivots_[lane] != 0;
    }
    if (any_wants) solve_block<D, true>(rows_.data(), pivoted_);
  }

  double determinant(std::size_t lane) const {
    // A zero pivot, of a simplex without volume, turns into NaN further down.
    const double determinant = (wants_pivots_[lane] != 0 ? pivoted_ : plain_).determinant[lane];
    return std::isfinite(determinant) ? determinant : 0.0;
  }
  /// Has it a shifted vertex?
  bool is_replaced(std::size_t lane) const { return is_replaced_[lane] != 0; }
  const double* pivoted_dual(std::size_t lane) const { return pivoted_.dual + lane; }

 private:
  const SimplicialComplex& complex_;
  const double* points_;
  std::span<const std::uint8_t> is_shifted_;
  std::size_t lanes_;
  std::vector<const double*> rows_;
  std::vector<std::uint8_t> is_replaced_, wants_pivots_;
  SolvedBlock<D> plain_, pivoted_;
};

template <std::size_t D>
void solve_simplices_of(SimplicialComplex& complex, const double* points,
                        std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  for_each_block(complex.row_count, kSimplicesInBlock, [&](std::size_t first, std::size_t last) {
    BatchSolver<D> solver(complex, points, is_shifted);
    std::array<std::uint32_t, HWY_MAX_BYTES / sizeof(double)> batch;
    for (std::size_t begin = first; begin < last; begin += solver.lanes()) {
      const std::size_t used = std::min(solver.lanes(), last - begin);
      std::iota(batch.begin(), batch.begin() + used, static_cast<std::uint32_t>(begin));
      solver.solve(std::span(batch).first(used));
      for (std::size_t lane = 0; lane < used; ++lane) {
        determinants[begin + lane] = solver.determinant(lane);
        if (!solver.is_replaced(lane)) continue;
        take_plane<D>(complex.planes.data() + (begin + lane) * D, solver.pivoted_dual(lane), solver.lanes());
      }
    }
  });
}

/// How deep a point is below a plane, 1 - a.y.
template <std::size_t D>
HWY_INLINE double depth_below(const double* HWY_RESTRICT plane, const double* HWY_RESTRICT y) {
  double even = 1.0, odd = 0.0;
  for (std::size_t k = 0; k + 1 < D; k += 2) {
    even = __builtin_fma(-plane[k], y[k], even);
    odd = __builtin_fma(-plane[k + 1], y[k + 1], odd);
  }
  if (D % 2 != 0) even = __builtin_fma(-plane[D - 1], y[D - 1], even);
  return even + odd;
}

/// Determinants by way of neighbours with smaller rows. `Mix`: holds all PointIds.
template <std::size_t D, class Mix>
class DeterminantChain {
 public:
  DeterminantChain(const SimplicialComplex& complex, const double* points, std::span<double> determinants)
      : complex_(complex),
        points_(points),
        determinants_(determinants),
        solver_(complex, points, {}),
        mixes_(complex.row_count) {}

  /// False: the sum of the areas times their normals is not 0.
  bool run() {
    for (std::size_t begin = 0; begin < complex_.row_count; begin += kRowsInBlock) {
      const std::size_t end = std::min(begin + kRowsInBlock, complex_.row_count);
      choose_ways(begin, end);
      solve_first();
      for (std::size_t row = begin; row < end; ++row) {
        prefetch(plane_of(row + kAhead), D);
        if (ways_[row - begin] < D) follow(row, ways_[row - begin]);
        add_area(row);
      }
    }
    bool is_closed = true;
    for (std::size_t k = 0; k < D; ++k) is_closed &= std::abs(sums_[k]) <= kClosed * sizes_[k];  // no NaN
    return is_closed;
  }

 private:
  static constexpr std::size_t kRowsInBlock = 1024, kAhead = 16;  // rows whose way from memory has begun
  static constexpr std::uint8_t kNoWay = 0xFF;
  static constexpr double kLeastDepth = 1e-4, kClosed = 1e-11;

  const std::uint32_t* row_of(std::size_t row) const { return complex_.topology.data() + row * 2 * D; }
  const double* plane_of(std::size_t row) const { return complex_.planes.data() + row * D; }

  /// Over which ridge each row's smallest neighbour is; what is known of that one is fetched. Lists rows
  /// without a smaller one.
  void choose_ways(std::size_t begin, std::size_t end) {
    first_.clear();
    for (std::size_t row = begin; row < end; ++row) {
      std::uint8_t& way = ways_[row - begin];
      way = kNoWay;
      determinants_[row] = 0.0;
      if (complex_.state[row] != SimplexState::kLive) continue;
      const std::uint32_t* const entries = row_of(row);
      prefetch(row_of(row + kAhead), 2 * D);
      std::uint32_t mix = 0, smallest = static_cast<std::uint32_t>(row);
      for (std::size_t k = 0; k < D; ++k) {
        mix ^= entries[k];
        smallest = std::min(smallest, entries[D + k]);
      }
      if (smallest < row)
        way = static_cast<std::uint8_t>(slot_of<D, RowHalf::kNeighbours>(entries, smallest));
      mixes_[row] = static_cast<Mix>(mix);
      if (way == kNoWay) {
        first_.push_back(static_cast<std::uint32_t>(row));
      } else {
        prefetch(plane_of(smallest), D);
        prefetch(&determinants_[smallest]);
      }
    }
  }

  void solve_first() {
    for (std::size_t begin = 0; begin < first_.size(); begin += solver_.lanes())
      solve(std::span(first_).subspan(begin, std::min(solver_.lanes(), first_.size() - begin)));
  }
  void solve(std::span<const std::uint32_t> rows) {
    solver_.solve(rows);
    for (std::size_t lane = 0; lane < rows.size(); ++lane)
      determinants_[rows[lane]] = solver_.determinant(lane);
  }

  void follow(std::size_t row, std::size_t k) {
    const std::uint32_t* const entries = row_of(row);
    const std::uint32_t vertex = entries[k], other = entries[D + k];
    const std::uint32_t across = static_cast<Mix>(mixes_[row] ^ mixes_[other] ^ vertex);
    const double own = depth_below<D>(plane_of(other), points_ + std::size_t{vertex} * D);
    const double opposite = depth_below<D>(plane_of(row), points_ + std::size_t{across} * D);
    if (own >= kLeastDepth && opposite >= kLeastDepth && determinants_[other] != 0.0) {
      determinants_[row] = determinants_[other] * own / opposite;
    } else {
      const auto alone = static_cast<std::uint32_t>(row);
      solve({&alone, 1});
    }
  }

  void add_area(std::size_t row) {
    const double* const plane = plane_of(row);
    for (std::size_t k = 0; k < D; ++k) {
      const double part = determinants_[row] * plane[k];
      sums_[k] += part;
      sizes_[k] += std::abs(part);
    }
  }

  const SimplicialComplex& complex_;
  const double* points_;
  std::span<double> determinants_;
  BatchSolver<D> solver_;
  std::vector<Mix> mixes_;                       // per row: XOR of its vertices
  std::array<std::uint8_t, kRowsInBlock> ways_;  // of the block's rows
  std::vector<std::uint32_t> first_;
  std::array<double, D> sums_{}, sizes_{};
};

template <std::size_t D>
bool chain_determinants_of(const SimplicialComplex& complex, const double* points, std::size_t point_count,
                           std::span<double> determinants) {
  constexpr std::size_t kFewPoints = std::size_t{1} << 16;
  return point_count <= kFewPoints ? DeterminantChain<D, std::uint16_t>(complex, points, determinants).run()
                                   : DeterminantChain<D, std::uint32_t>(complex, points, determinants).run();
}

void solve_simplices_any(SimplicialComplex& complex, const double* points,
                         std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  call_with_dimension<2, kMaxRank>(
      complex.rank, [&](auto d) { solve_simplices_of<d>(complex, points, is_shifted, determinants); });
}

bool chain_determinants_any(const SimplicialComplex& complex, const double* points, std::size_t point_count,
                            std::span<double> determinants) {
  return call_with_dimension<2, kMaxRank>(complex.rank, [&](auto d) {
    return chain_determinants_of<d>(complex, points, point_count, determinants);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void solve_simplices(SimplicialComplex& complex, const double* points,
                     std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  NDHULL_BEST_OF(solve_simplices_any)(complex, points, is_shifted, determinants);
}

bool chain_determinants(const SimplicialComplex& complex, const double* points, std::size_t point_count,
                        std::span<double> determinants) {
  return NDHULL_BEST_OF(chain_determinants_any)(complex, points, point_count, determinants);
}

}  // namespace ndhull
#endif
