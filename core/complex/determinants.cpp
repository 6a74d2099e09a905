#include "core/complex/determinants.h"

#include <cmath>

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/complex/determinants.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/dimension_switch.h"
#include "core/linear/block_elimination-inl.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {
// Simplices that one thread takes at a time: a multiple of all vectors' lanes.
constexpr std::size_t kSimplicesInBlock = 2048;

constexpr std::size_t kLanes = hn::MaxLanes(Tag());
/// Rows whose way from memory has begun. The machine's own foresight ends with each page.
constexpr std::size_t kRowsAhead = 32;
/// Diagonal entries from which on elimination without pivots has lost no digits to speak of.
constexpr double kSmall = 1e-4;

/// Rows of as many entries as a vector has lanes become columns.
HWY_INLINE void transpose([[maybe_unused]] Lane (&rows)[kLanes]) {
#if HWY_TARGET != HWY_SCALAR
  // A perfect unshuffle of all entries for each doubling.
  for (std::size_t step = 1; step < kLanes; step *= 2) {
    Lane unshuffled[kLanes];
    for (std::size_t i = 0; i < kLanes / 2; ++i) {
      unshuffled[i] = hn::ConcatEven(Tag(), rows[2 * i + 1], rows[2 * i]);
      unshuffled[i + kLanes / 2] = hn::ConcatOdd(Tag(), rows[2 * i + 1], rows[2 * i]);
    }
    for (std::size_t i = 0; i < kLanes; ++i) rows[i] = unshuffled[i];
  }
#endif
}

/// Point i of the simplex in each lane, points[lane * D + i], becomes row i of its matrix; the right side
/// is 1.
template <std::size_t D>
HWY_INLINE void load_points(const double* const* points, Lane (&matrix)[D][D + 1]) {
  const Tag tag;
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t first = 0; first < D; first += kLanes) {
      const std::size_t used = std::min(kLanes, D - first);
      Lane entries[kLanes];
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double* const point = points[lane * D + i] + first;
        entries[lane] =
            used == kLanes ? hn::LoadU(tag, point) : hn::MaskedLoad(hn::FirstN(tag, used), tag, point);
      }
      transpose(entries);
      for (std::size_t k = 0; k < used; ++k) matrix[i][first + k] = entries[k];
    }
    matrix[i][D] = hn::Set(tag, 1.0);
  }
}

/// What elimination finds of the simplices of a block, one a lane.
template <std::size_t D>
struct SolvedBlock {
  HWY_ALIGN double dual[D * kLanes];  // entry k of a lane at k * kLanes + lane
  HWY_ALIGN double determinant[kLanes];
  HWY_ALIGN double smallest[kLanes];  // diagonal entry
};

template <std::size_t D, bool kPivots>
void solve_block(const double* const* points, SolvedBlock<D>& solved) {
  const Tag tag;
  Lane matrix[D][D + 1], dual[D], smallest = hn::Set(tag, 1.0);
  load_points<D>(points, matrix);
  const Lane determinant = eliminate<D, kPivots>(matrix, dual, &smallest);
  for (std::size_t k = 0; k < D; ++k) hn::Store(dual[k], tag, solved.dual + k * kLanes);
  hn::Store(determinant, tag, solved.determinant);
  hn::Store(smallest, tag, solved.smallest);
}

/// The determinants alone, without pivots: the right side is not looked at.
template <std::size_t D>
void find_determinants_of_block(const double* const* points, SolvedBlock<D>& found) {
  const Tag tag;
  Lane matrix[D][D + 1], dual[D], smallest;
  load_points<D>(points, matrix);
  hn::Store(eliminate<D, false>(matrix, dual, &smallest), tag, found.determinant);
  hn::Store(smallest, tag, found.smallest);
}

/// Has elimination without pivots lost no digits to speak of? Then the solved plane agrees with that of
/// growth. It may agree where the determinant is wrong, since the right side can be blind to what was lost:
/// then a diagonal entry is small. Simplices that fail are few.
template <std::size_t D>
bool is_good(const SolvedBlock<D>& solved, std::size_t lane, const double* plane) {
  constexpr double kAgreement = 1e-11;
  double largest = 0.0, difference = 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    largest = std::max(largest, std::abs(plane[k]));
    difference += std::abs(solved.dual[k * kLanes + lane] - plane[k]);  // keeps NaN
  }
  return difference <= kAgreement * largest && solved.smallest[lane] > kSmall;
}

/// Takes the solved plane when it is one: finite and near the plane that growth made.
template <std::size_t D>
void take_plane(double* plane, const double* solved) {
  constexpr double kSamePlane = 1e-6;
  double largest = 0.0, change = 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    largest = std::max(largest, std::abs(plane[k]));
    const double difference = std::abs(solved[k * kLanes] - plane[k]);
    change = difference <= change ? change : difference;  // keeps NaN
  }
  if (!(change <= kSamePlane * largest)) return;
  for (std::size_t k = 0; k < D; ++k) plane[k] = solved[k * kLanes];
}

/// Begins the way from memory of the rows that some batches later is the turn of.
template <std::size_t D>
HWY_INLINE void ask_for_rows(const SimplicialComplex& complex, std::size_t first) {
  for (std::size_t row = first + kRowsAhead; row < first + kRowsAhead + kLanes; ++row) {
    prefetch(complex.topology.data() + row * 2 * D, D);
    prefetch(complex.planes.data() + row * D, D);
  }
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
        rows_(kLanes * D),
        is_replaced_(kLanes),
        wants_pivots_(kLanes) {}

  /// Of at least one simplex, at most one a lane.
  void solve(std::span<const std::uint32_t> simplices) {
    std::size_t replaced = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto vertices = complex_.vertices(SimplexId{simplices[std::min(lane, simplices.size() - 1)]});
      for (std::size_t i = 0; i < D; ++i) rows_[lane * D + i] = points_ + std::size_t{vertices[i].value} * D;
      if (is_shifted_.empty()) continue;
      std::uint8_t any = 0;
      for (const PointId id : vertices) any |= is_shifted_[id.value];
      is_replaced_[lane] = any;
      replaced += any;
    }
    if (replaced < kLanes) solve_block<D, false>(rows_.data(), plain_);
    bool any_wants = false;
    for (std::size_t lane = 0; lane < simplices.size(); ++lane) {
      const double* const plane = complex_.plane(SimplexId{simplices[lane]}).data();
      wants_pivots_[lane] = is_replaced_[lane] != 0 || !is_good<D>(plain_, lane, plane) ? 1 : 0;
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
  std::vector<const double*> rows_;
  std::vector<std::uint8_t> is_replaced_, wants_pivots_;
  SolvedBlock<D> plain_, pivoted_;
};

template <std::size_t D>
void solve_simplices_of(SimplicialComplex& complex, const double* points,
                        std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  for_each_block(complex.row_count, kSimplicesInBlock, [&](std::size_t first, std::size_t last) {
    BatchSolver<D> solver(complex, points, is_shifted);
    std::array<std::uint32_t, kLanes> batch;
    for (std::size_t begin = first; begin < last; begin += kLanes) {
      const std::size_t used = std::min(kLanes, last - begin);
      ask_for_rows<D>(complex, begin);
      std::iota(batch.begin(), batch.begin() + used, static_cast<std::uint32_t>(begin));
      solver.solve(std::span(batch).first(used));
      for (std::size_t lane = 0; lane < used; ++lane) {
        determinants[begin + lane] = solver.determinant(lane);
        if (!solver.is_replaced(lane)) continue;
        take_plane<D>(complex.planes.data() + (begin + lane) * D, solver.pivoted_dual(lane));
      }
    }
  });
}

/// Sums of determinants times planes, and of their sizes.
template <std::size_t D>
struct AreaSums {
  std::array<double, D> sums{}, sizes{};

  void add(double determinant, const double* plane) {
    for (std::size_t k = 0; k < D; ++k) {
      const double part = determinant * plane[k];
      sums[k] += part;
      sizes[k] += std::abs(part);
    }
  }
  void add(const AreaSums& others) {
    for (std::size_t k = 0; k < D; ++k) {
      sums[k] += others.sums[k];
      sizes[k] += others.sizes[k];
    }
  }
  bool is_closed() const {
    constexpr double kClosed = 1e-11;
    bool is = true;
    for (std::size_t k = 0; k < D; ++k) is &= std::abs(sums[k]) <= kClosed * sizes[k];  // no NaN
    return is;
  }
};

/// Determinants of the simplices of one block without their planes.
template <std::size_t D>
class DeterminantFinder {
 public:
  DeterminantFinder(const SimplicialComplex& complex, const double* points, std::span<double> determinants)
      : complex_(complex), points_(points), determinants_(determinants), solver_(complex, points, {}) {}

  AreaSums<D> find(std::size_t begin, std::size_t end) {
    const double* corners[kLanes * D];
    SolvedBlock<D> found;
    for (std::size_t first = begin; first < end; first += kLanes) {
      const std::size_t used = std::min(kLanes, end - first);
      ask_for_rows<D>(complex_, first);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const std::size_t row = first + std::min(lane, used - 1);
        const std::span<const PointId> vertices =
            complex_.vertices(SimplexId{static_cast<std::uint32_t>(row)});
        for (std::size_t i = 0; i < D; ++i)
          corners[lane * D + i] = points_ + (is_live(row) ? std::size_t{vertices[i].value} * D : 0);
      }
      find_determinants_of_block<D>(corners, found);
      for (std::size_t lane = 0; lane < used; ++lane) {
        const std::size_t row = first + lane;
        determinants_[row] = is_live(row) ? found.determinant[lane] : 0.0;
        if (is_live(row) && !(found.smallest[lane] > kSmall))
          doubtful_.push_back(static_cast<std::uint32_t>(row));
      }
    }
    solve_doubtful();
    AreaSums<D> areas;
    for (std::size_t row = begin; row < end; ++row)
      areas.add(determinants_[row], complex_.planes.data() + row * D);
    return areas;
  }

 private:
  bool is_live(std::size_t row) const { return complex_.state[row] == SimplexState::kLive; }

  void solve_doubtful() {
    for (std::size_t begin = 0; begin < doubtful_.size(); begin += kLanes) {
      const auto rows = std::span(doubtful_).subspan(begin, std::min(kLanes, doubtful_.size() - begin));
      solver_.solve(rows);
      for (std::size_t lane = 0; lane < rows.size(); ++lane)
        determinants_[rows[lane]] = solver_.determinant(lane);
    }
  }

  const SimplicialComplex& complex_;
  const double* points_;
  std::span<double> determinants_;
  BatchSolver<D> solver_;
  std::vector<std::uint32_t> doubtful_;  // rows
};

template <std::size_t D>
bool find_determinants_of(const SimplicialComplex& complex, const double* points,
                          std::span<double> determinants, const BlockWork& also) {
  std::vector<AreaSums<D>> of_block((complex.row_count + kSimplicesInBlock - 1) / kSimplicesInBlock);
  for_each_block(complex.row_count, kSimplicesInBlock, [&](std::size_t begin, std::size_t end) {
    of_block[begin / kSimplicesInBlock] =
        DeterminantFinder<D>(complex, points, determinants).find(begin, end);
    also(begin, end);
  });
  AreaSums<D> all;
  for (const AreaSums<D>& some : of_block) all.add(some);
  return all.is_closed();
}

template <std::size_t D>
void solve_planes_of(const double* points, std::span<const std::uint32_t> vertices, std::span<double> planes,
                     std::span<double> determinants) {
  const double* corners[kLanes * D];
  SolvedBlock<D> solved;
  for (std::size_t begin = 0; begin < determinants.size(); begin += kLanes) {
    const std::size_t used = std::min(kLanes, determinants.size() - begin);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      for (std::size_t i = 0; i < D; ++i)
        corners[lane * D + i] =
            points + std::size_t{vertices[(begin + std::min(lane, used - 1)) * D + i]} * D;
    solve_block<D, true>(corners, solved);
    for (std::size_t lane = 0; lane < used; ++lane) {
      determinants[begin + lane] = solved.determinant[lane];
      for (std::size_t k = 0; k < D; ++k) planes[(begin + lane) * D + k] = solved.dual[k * kLanes + lane];
    }
  }
}

void solve_simplices_any(SimplicialComplex& complex, const double* points,
                         std::span<const std::uint8_t> is_shifted, std::span<double> determinants) {
  call_with_dimension<2, kMaxRank>(
      complex.rank, [&](auto d) { solve_simplices_of<d>(complex, points, is_shifted, determinants); });
}

bool find_determinants_any(const SimplicialComplex& complex, const double* points,
                           std::span<double> determinants, const BlockWork& also) {
  return call_with_dimension<2, kMaxRank>(
      complex.rank, [&](auto d) { return find_determinants_of<d>(complex, points, determinants, also); });
}

void solve_planes_any(std::size_t rank, const double* points, std::span<const std::uint32_t> vertices,
                      std::span<double> planes, std::span<double> determinants) {
  call_with_dimension<2, kMaxRank>(
      rank, [&](auto d) { solve_planes_of<d>(points, vertices, planes, determinants); });
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

bool find_determinants(const SimplicialComplex& complex, const double* points, std::span<double> determinants,
                       const BlockWork& also) {
  return NDHULL_BEST_OF(find_determinants_any)(complex, points, determinants, also);
}

void solve_planes(std::size_t rank, const double* points, std::span<const std::uint32_t> vertices,
                  std::span<double> planes, std::span<double> determinants) {
  NDHULL_BEST_OF(solve_planes_any)(rank, points, vertices, planes, determinants);
}

}  // namespace ndhull
#endif
