// What a plane and a volume in the frame are in input units.
#pragma once

#include <cstddef>
#include <vector>

#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// ratio * 2^exponent: what doubles cannot always hold.
struct ScaledRatio {
  double ratio = 0.0;
  int exponent = 0;
};

/// |det| of the frame's map on the subspace of the data: frame volume per input volume.
ScaledRatio volume_scale(const Frame& frame);

/// Unit normals in input coordinates of planes in the frame; of flat data, normals that lie in the subspace.
class NormalMap {
 public:
  explicit NormalMap(const Frame& frame);

  /// Shapes   planes: count x rank. out: count x dimension; the same memory when rank equals dimension.
  /// lengths  count numbers, or null: the length of the normal before it was made a unit one, which is one
  ///          over the distance [input units] of the plane a.y = 1 from the frame's centre.
  /// Promise  the error is that of the planes, in the frame, and of one rounding: of thin data, whose map has
  ///          large entries that cancel, sums are compensated.
  /// Cost     rank x dimension multiply-adds a plane, ten times that of thin data; dimension where the frame
  ///          only scales the axes.
  void map(const double* planes, std::size_t count, double* out, double* lengths = nullptr) const;

 private:
  template <std::size_t D>
  void scale_rows(const double* planes, std::size_t count, double* out, double* lengths) const;

  std::size_t rank_, dimension_;
  bool is_diagonal_;
  std::vector<double> to_input_;  // rank x dimension
  std::vector<double> diagonal_;  // of it, when there is nothing else
  std::vector<double> columns_;   // of it, dimension x rank, when it is of thin data
};

/// Rows normal, offset of dimension - rank independent equations normal . x + offset = 0 of the subspace that
/// the data lie in; empty when that is the whole space.
std::vector<double> find_subspace_equations(const Frame& frame);

/// How far points are from the subspace at most; 0 where it is the whole space. [distance]
/// Cost  of flat data a pass over the points.
double distance_off_subspace(const PointView& points, const Frame& frame);

/// Are points so far off the subspace, for its extent, that a proof of being inside in the subspace says
/// nothing of planes that have their own rounding? Flat data far from the origin are.
bool is_roughly_flat(const PointView& points, const Frame& frame);

/// Bound on the error of a computed sum of `terms` products of the given size: gamma_terms * size.
/// Source  Higham. Accuracy and Stability of Numerical Algorithms, 2nd ed., eq. 3.5.
double sum_error(std::size_t terms, double size);

}  // namespace ndhull
