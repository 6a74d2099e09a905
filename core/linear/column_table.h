// Many short columns in an order that lets one product with all of them run at memory speed: the search of
// core/linear/column_simplex.h when the columns are at hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/linear/column_simplex.h"
#include "core/machine/huge_array.h"

namespace ndhull {

/// Columns with `height` entries and a cost each.
///
/// Memory  8 (height + 1) bytes a column.
class ColumnTable {
 public:
  ColumnTable(std::size_t height, std::size_t count);

  std::size_t height() const { return height_; }
  std::size_t count() const { return count_; }
  /// Entries of column `column`, `height` of them, and its cost. Each column has to be set.
  void set(std::size_t column, std::span<const double> entries, double cost);
  void set_cost(std::size_t column, double cost);
  double entry(std::size_t column, std::size_t row) const { return values_[index(column, row)]; }
  double cost(std::size_t column) const { return values_[index(column, height_)]; }

  /// The column with the largest multipliers . (entries, cost), the first of them on a tie.
  /// multipliers: height + 1. `product` is a chain of fused multiply-adds where the machine has them.
  /// Cost  a read of the whole table.
  struct Best {
    std::size_t column = 0;
    double product = 0.0;
  };
  Best largest_product(std::span<const double> multipliers) const;
  /// Of the columns from `first` to `last` (the end not included) alone, and those that share a block with
  /// them.
  Best largest_product(std::span<const double> multipliers, std::size_t first, std::size_t last) const;

  /// The best column for `query`; its entries stay valid until the next call.
  std::optional<LpColumn> price(const LpQuery& query);
  /// The column as the simplex method wants it; entries as above.
  LpColumn column(std::size_t column);

 private:
  /// Columns that are written together with `column`: the last one is repeated to the end of its block, and a
  /// repetition is never the first of a tie.
  std::size_t copies_of(std::size_t column) const {
    return column + 1 == count_ ? (kBlock - column % kBlock) : 1;
  }
  std::size_t index(std::size_t column, std::size_t row) const {
    return (column / kBlock * (height_ + 1) + row) * kBlock + column % kBlock;
  }
  static constexpr std::size_t kBlock = 32;  // columns side by side: a few vectors of any machine

  std::size_t height_, count_;
  HugeArray<double> values_;  // blocks of height + 1 rows x kBlock columns, the costs last
  std::vector<double> multipliers_, entries_;
};

}  // namespace ndhull
