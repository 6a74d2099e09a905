// Idea. A simplex' star is those of its neighbours that are less than the width below its plane. Of all
// simplices at once stars are looked for as the rows stand in memory: vertices across ridges from two bytes
// a neighbour, products in single precision first.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "approx/slabs/dual_facets.h"
#include "approx/slabs/product_bits_kernel.h"
#include "approx/slabs/seed_planes.h"
#include "approx/slabs/simplex_marks.h"
#include "core/complex/simplicial_complex.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {

/// The stars of the rows that no mark says are taken, as if no point were above a row's plane: such points
/// would leave less.
template <std::size_t D>
class StarSearch {
 public:
  /// All must outlive this. coordinates: of all points in the frame, points x rank.
  StarSearch(const SimplicialComplex& complex, std::span<const double> coordinates, const SimplexMarks& marks,
             const SeedPlanes<D>& planes, double width)
      : complex_(complex),
        coordinates_(coordinates),
        marks_(marks),
        planes_(planes),
        width_(width),
        row_count_(static_cast<std::uint32_t>(complex.row_count)) {}

  /// Shapes  fitting: one a row.  Cost  some 30 ns a row in 8-d, shared by all threads.
  void find(std::span<NeighbourBits> fitting) {
    // Of more points than simplices a second table would take memory that no limit knows of.
    std::optional<FloatPoints> points;
    if (coordinates_.size() / D <= row_count_) points.emplace(D, coordinates_);
    for_each_block(row_count_, kRowsInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = begin; first < end; first += kRowsAtATime)
        find_some(points ? &*points : nullptr, static_cast<std::uint32_t>(first),
                  static_cast<std::uint32_t>(std::min(first + kRowsAtATime, end)), fitting);
    });
  }

  /// Is the plane of each of these rows further from the frame's centre than the width?
  bool are_far_from_centre() const { return are_far_from_centre_; }

 private:
  static constexpr std::size_t kRowsInBlock = 1 << 13, kRowsAtATime = 64;
  /// Whose marks, rows and planes have begun their way from memory: the next pages are not foreseen there.
  static constexpr std::size_t kMarksAhead = 8, kRowsAhead = 24;
  static constexpr double kNothingFits = 1e30;  // a product that no point has

  const std::uint32_t* row_of(std::size_t row) const {
    return complex_.topology.data() + std::min<std::size_t>(row, row_count_ - 1) * 2 * D;
  }
  const double* plane_of(std::size_t row) const {
    return complex_.planes.data() + std::min<std::size_t>(row, row_count_ - 1) * D;
  }
  std::uint32_t vertex_across(std::uint32_t row, std::size_t k) const {
    const std::uint32_t* const vertices = row_of(row);
    return marks_.vertex_across(marks_[row], vertices[k], marks_[vertices[D + k]]);
  }

  void find_some(const FloatPoints* points, std::uint32_t begin, std::uint32_t end,
                 std::span<NeighbourBits> fitting) {
    std::array<std::uint32_t, kRowsAtATime * D> across;
    std::array<double, kRowsAtATime> least{};
    std::array<ProductBits, kRowsAtATime> bits;
    for (std::uint32_t row = begin; row < end; ++row) {
      prefetch(row_of(row + kRowsAhead), 2 * D);
      prefetch(plane_of(row + kRowsAhead), D);
      for (std::size_t k = 0; k < D; ++k) marks_.ask_for(row_of(row + kMarksAhead)[D + k]);
      const bool is_open = !marks_.is_taken(row);
      for (std::size_t k = 0; k < D; ++k)
        across[(row - begin) * D + k] = is_open ? vertex_across(row, k) : 0u;
      least[row - begin] = planes_.length_sq_of(plane_of(row));
    }
    // All roots in one loop: one by one, each would be waited for.
    for (std::size_t i = 0; i < end - begin; ++i) least[i] = 1.0 - width_ * std::sqrt(least[i]);
    for (std::uint32_t row = begin; row < end; ++row)
      if (marks_.is_taken(row)) least[row - begin] = kNothingFits;
    if (*std::min_element(least.begin(), least.begin() + (end - begin)) <= 0.0)
      are_far_from_centre_.store(false, std::memory_order_relaxed);
    if (points != nullptr) {
      compare_products(*points, plane_of(begin), across.data(), std::span(least).first(end - begin),
                       std::span(bits).first(end - begin));
    } else {
      constexpr auto kAll = static_cast<std::uint16_t>((1u << D) - 1);
      for (std::size_t i = 0; i < end - begin; ++i)
        bits[i] = {0, least[i] == kNothingFits ? std::uint16_t{0} : kAll};
    }
    for (std::uint32_t row = begin; row < end; ++row) {
      const ProductBits& found = bits[row - begin];
      unsigned star = found.at_least;
      for (unsigned left = found.unknown; left != 0; left &= left - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(left));
        const double* const vertex = coordinates_.data() + std::size_t{vertex_across(row, k)} * D;
        star |= (dot_in_frame<D>(plane_of(row), vertex) >= least[row - begin] ? 1u : 0u) << k;
      }
      fitting[row] = static_cast<NeighbourBits>(star);
    }
  }

  const SimplicialComplex& complex_;
  std::span<const double> coordinates_;
  const SimplexMarks& marks_;
  const SeedPlanes<D>& planes_;
  double width_;
  std::uint32_t row_count_;
  std::atomic<bool> are_far_from_centre_ = true;
};

}  // namespace ndhull
