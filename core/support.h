// The support function of a table of points: how far it reaches in a direction, and where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Points as columns, for products of one direction with all of them.
class SupportTable {
 public:
  SupportTable() = default;
  /// Shapes  rows: count x dimension, row-major. dimension 1 to kMaxRank.
  SupportTable(std::size_t dimension, std::span<const double> rows) { assign(dimension, rows); }
  /// The same in an old table's memory.
  void assign(std::size_t dimension, std::span<const double> rows);

  std::size_t dimension() const { return dimension_; }
  std::size_t count() const { return count_; }
  /// Numbers that `dots` must have room for: the count, rounded up to whole vectors.
  std::size_t padded_count() const { return stride_; }

  /// Fills dots[row] = direction . point and returns the row of the largest (the first of equal ones).
  /// Precondition: count >= 1.
  /// Cost    count x dimension fused multiply-adds, at close to the machine's peak.
  std::uint32_t find(const double* direction, double* dots) const;

  /// Appends the rows with dots[row] >= low, ascending, to `rows`.
  void rows_above(const double* dots, double low, std::vector<std::uint32_t>& rows) const;

 private:
  std::size_t dimension_ = 0, count_ = 0, stride_ = 0;
  std::vector<double> columns_;  // dimension x stride; the last point again as padding
};

}  // namespace ndhull
