// The support function of a table of points: how far it reaches in a direction, and where.
//
// Idea. Products in single precision say which few points may be the furthest; those are computed in double
// precision. Half the memory is read, which is all that counts where the table is larger than the first
// cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// Of one direction with all points, in single precision; memory that is used again.
struct SupportProducts {
  std::vector<float> dots;                ///< in the table's own scale
  std::vector<std::uint32_t> candidates;  ///< that may be the furthest
};

/// Points as columns in blocks, for products of one direction with all of them.
class SupportTable {
 public:
  SupportTable() = default;
  /// Shapes  rows: count x dimension, row-major, which must outlive this. dimension 1 to kMaxRank.
  SupportTable(std::size_t dimension, std::span<const double> rows);

  std::size_t dimension() const { return dimension_; }
  std::size_t count() const { return count_; }

  /// The furthest row along `direction` (the first of equal ones), and its product in double precision.
  /// `products` are for rows_above.
  /// Precondition: count >= 1; no entry of `direction` is larger than 1.
  /// Cost    count x dimension fused multiply-adds of floats, at close to the machine's peak, and a product
  ///         for each point that is within their rounding of the furthest.
  std::uint32_t find(const double* direction, SupportProducts& products, double& height) const;

  /// Appends those of the first `end` rows with products of `low` or more, ascending; some that are less by
  /// rounding of single precision may be among them.
  void rows_above(const SupportProducts& products, double low, std::size_t end,
                  std::vector<std::uint32_t>& rows) const;

 private:
  std::size_t dimension_ = 0, count_ = 0;
  const double* rows_ = nullptr;
  double scale_ = 1.0;         // a power of two: scaled coordinates are at most 1
  float rounding_ = 0.0f;      // no product in single precision is off by more, in scaled coordinates
  std::vector<float> blocks_;  // whole blocks of 16 points x dimension; the last point again as padding
};

}  // namespace ndhull
