// Transforms and hard cases of point sets: what makes a hull's tests find something.
//
// The set a transform gets is not changed; rows keep their order unless it says otherwise. All randomness
// comes from the seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/points/point_set.h"

namespace ndhull {

/// A d x d orthogonal matrix, row-major, orthogonal to a few 2^-53; uniform (Haar) up to rounding.
std::vector<double> random_orthogonal(std::size_t d, std::uint64_t seed);
/// Rows multiplied by `matrix` (set.dimension x columns, row-major): row -> row * matrix.
PointSet multiplied(const PointSet& set, std::span<const double> matrix, std::size_t columns);
/// Rotated (or mirrored) by random_orthogonal.
PointSet rotated(const PointSet& set, std::uint64_t seed);
/// Isometrically into `dimension` >= set.dimension coordinates: same rank, rounded.
PointSet embedded(const PointSet& set, std::size_t dimension, std::uint64_t seed);
/// `offset` (dimension values) added to each row.
PointSet moved(const PointSet& set, std::span<const double> offset);
/// Column k times factors[k]; exact for powers of two.
PointSet axis_scaled(const PointSet& set, std::span<const double> factors);
/// Column `column` negated; exact.
PointSet mirrored(const PointSet& set, std::size_t column);
/// The rows and behind them their mirror images.
PointSet with_mirror_images(const PointSet& set, std::size_t column);
/// Rows in another order: new row k is old row old_of_new[k], when that is asked for.
PointSet permuted_rows(const PointSet& set, std::uint64_t seed,
                       std::vector<std::size_t>* old_of_new = nullptr);
/// `count` copies of random rows behind the others.
PointSet with_duplicates(const PointSet& set, std::size_t count, std::uint64_t seed);
/// `count` points behind the others, convex combinations of all rows: strictly inside when the rows span the
/// space, up to rounding.
PointSet with_interior_points(const PointSet& set, std::size_t count, std::uint64_t seed);
/// All pairs of a point of one set and a point of the other: each facet is one of either's with all of the other.
PointSet product(const PointSet& left, const PointSet& right);
/// Each coordinate moved up or down to the next double, or left, at random.
PointSet moved_by_one_ulp(const PointSet& set, std::uint64_t seed);

/// `n` points of [-1, 1]^(d-1) x [-thickness/2, thickness/2].
PointSet slab(std::size_t n, std::size_t d, double thickness, std::uint64_t seed);
/// `n` normal points, of which every second lies, up to rounding, in one random flat of dimension d - k.
/// k = d - 1: collinear points. Precondition: k <= d.
PointSet co_flat(std::size_t n, std::size_t d, std::size_t k, std::uint64_t seed);

/// A point set and what is hard about it, with the seed: enough to replay it.
struct DegenerateCase {
  std::string description;
  PointSet points;
};
/// One case of each kind: duplicate, collinear, co-flat, one-ulp-moved, mirrored, cospherical, lattice, slab,
/// stretched axes, small integers, far from the origin, flat. About n points (the lattice at most, and at
/// least 2^d) in d >= 2 dimensions.
std::vector<DegenerateCase> degenerate_cases(std::size_t n, std::size_t d, std::uint64_t seed);

}  // namespace ndhull
