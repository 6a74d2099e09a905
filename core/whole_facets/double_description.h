// Growing facets that are no simplices: for points of which many lie on one plane, as those of cubes, grids
// and 0/1 polytopes, where the simplices of a triangulation are thousands of times more than the facets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/whole_facets/incidence_kernels.h"

namespace ndhull {

/// Facets as planes and the points in them.
struct FacetIncidence {
  std::size_t rank = 0;
  std::size_t words = 0;              ///< of a facet's bits
  std::vector<double> planes;         ///< count x rank: the dual vertex a with a.y = 1 on the facet
  std::vector<std::uint64_t> points;  ///< count x words: bit i says that point i is in the facet's plane
  /// The facets that share a ridge with it, in no order.
  std::vector<std::vector<std::uint32_t>> neighbours;

  std::size_t count() const { return neighbours.size(); }
  std::span<const double> plane(std::size_t facet) const { return {planes.data() + facet * rank, rank}; }
  std::span<const std::uint64_t> bits(std::size_t facet) const {
    return {points.data() + facet * words, words};
  }
};

/// One hull that grows by whole facets, in pieces of work of a given size.
///
/// Method  Of a point that is added the facets are above, below or through it. Each ridge between one below
///         and one above makes a new facet, the plane turned about the ridge until it meets the point; those
///         through it take it in. Which of the facets at the point are neighbours follows from the points
///         they have in common. No two of the new facets can lie on one plane.
/// Order   Furthest from the mean first, in units of the covariance, so that orbits of a symmetry group stay
///         together in any affine image; among these nearest to the first simplex first, which keeps the
///         facets on the way few: a front that goes over the hull.
/// Promise The incidences are right as long as every decision is clear: a point within kInPlane of a plane is
///         in it, and between kInPlane and kClear nothing may be. Otherwise the outcome is kGivenUp.
/// Source  Motzkin, Raiffa, Thompson, Thrall. The double description method. 1953. Fukuda, Prodon. Double
///         description method revisited. 1996.
class DoubleDescription {
 public:
  static constexpr double kInPlane = 4e-12;  ///< [ratio] of gauges: that within which simplices are merged
  static constexpr double kClear = 1e-8;     ///< [ratio]

  enum class Outcome { kGoing, kDone, kGivenUp };

  /// Shapes  points: count x rank, in the frame, the interior point at 0; must outlive this. simplex: rank +
  ///         1 affinely independent points around 0. most_words: of all facets' bits, 256 MB at most.
  /// Cost    O(count rank^2).
  DoubleDescription(const double* points, std::size_t count, std::size_t rank,
                    std::span<const PointId> simplex, std::uint64_t most_words);

  /// Adds points until about `work` elementary steps (some nanoseconds each) are done, or all are in, or a
  /// decision is not clear, or the facets' bits are too many.
  Outcome run(std::uint64_t work);

  double share_added() const { return static_cast<double>(next_) / static_cast<double>(order_.size()); }
  /// Facets now, and how many of them have no more points than a simplex.
  std::size_t facet_count() const { return live_; }
  std::size_t simplicial_count() const;
  std::uint64_t created() const { return created_; }

  /// After kDone, once: bit i of a facet's row is point i.
  FacetIncidence take();

 private:
  enum class Side : std::uint8_t { kFree, kBelow, kAbove, kThrough, kNew };

  void start(std::span<const PointId> simplex);
  void choose_order(std::span<const PointId> simplex);
  std::uint32_t make_row();
  bool classify(const double* point);
  bool add(std::size_t place);
  void make_facet(std::uint32_t above, std::uint32_t below, std::size_t place);
  void join_neighbours();
  std::uint64_t* bits(std::uint32_t row) { return bits_.data() + row * words_; }
  void set_bit(std::uint32_t row, std::size_t place) {
    bits(row)[place / 64] |= std::uint64_t{1} << (place % 64);
  }

  const double* points_;
  std::size_t count_, rank_, words_;
  std::uint64_t most_words_;
  std::vector<std::uint32_t> order_;  // of points; bits are places in it, so that early on few words count
  std::size_t next_ = 0;              // place of the point that is added next
  std::uint64_t work_ = 0, created_ = 0;
  std::size_t live_ = 0;

  // Rows of facets, some of them free.
  std::vector<double> planes_, gauges_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::vector<std::uint32_t>> neighbours_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> free_;

  // Of the point that is added.
  std::vector<std::uint32_t> above_, through_, at_point_;
  std::vector<const std::uint64_t*> rows_;
  std::vector<FacetPair> pairs_;
};

}  // namespace ndhull
