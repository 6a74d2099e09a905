// One slab: simplices around a seed whose vertices all lie less than a width below one supporting plane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/merge_rule.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// How hard to look for few facets.
struct CoverEffort {
  unsigned choices = 1;  ///< slabs that each simplex is in before slabs are chosen
  unsigned refits = 1;   ///< times that a slab is turned to its simplices and grown again
  unsigned fit_steps = 12;
  unsigned final_fit_steps = 64;
};

/// Depths are kept in single precision, rounded up: what is taken into a slab of some width is less deep by
/// this part of it, so that the width holds all the same.
inline constexpr double kDepthRoom = 1.0 - 3e-7;
inline float rounded_up_depth(double depth) { return (1.0f + 1.2e-7f) * static_cast<float>(depth); }

/// A slab as it grew.
struct GrownSlab {
  std::uint32_t seed = 0;
  FittedPlane plane;                   ///< height 0: the seed alone, its own plane, not measured
  std::vector<std::uint32_t> members;  ///< rows of the complex, the seed first
  std::vector<float> depths;           ///< [distance] of each below the plane's height, rounded up
};

/// A slab by the vertices that are in it, whatever simplices they have.
struct VertexSlab {
  std::uint32_t seed = 0;
  FittedPlane plane;                    ///< measured
  std::vector<std::uint32_t> vertices;  ///< rows of the space, those of the seed among them
  std::vector<double> depths;           ///< [distance] of each below the plane's height
};

/// What a flood knows of a simplex without looking at its vertices.
struct MetSimplex {
  std::uint32_t flood = 0;  ///< the last that met it
  std::uint32_t mix = 0;    ///< XOR of its vertices (rows of the space)
};

/// What one thread needs to grow slabs, and to fit their planes.
struct SlabScratch {
  explicit SlabScratch(const WidthSpace& space);
  /// Before the first flood.
  void prepare(const SimplicialComplex& complex, const WidthSpace& space);
  /// At least so many places in `grown`.
  void make_room(std::size_t count);
  void copy_grown(GrownSlab& slab) const;

  PlaneFitWork fit;
  PlaneFitWork rule_fit;                    // of the rule, while a slab grows by what `fit` has measured
  std::vector<MetSimplex> met;              // per row of the complex; empty before the first flood
  std::vector<std::uint32_t> vertex_stamp;  // per row of the space: last pass over vertices
  std::uint32_t flood = 0, vertex_pass = 0;
  std::vector<double> dots;  // per row of the space with this pass: product with the flood's normal
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> grown;  // of the last flood the first `grown_count`, the seed first
  std::vector<float> depths;         // of these
  std::size_t grown_count = 0;
  RulePlane compared;
};

/// Grows slabs; holds no state but what it was given, so threads may share it.
class SlabGrower {
 public:
  /// `rule`: which simplices may be in one slab at all; null: all that fit. `is_convex`: no point of the
  /// space is above any simplex's plane by more than rounding. All must outlive this.
  SlabGrower(const SimplicialComplex& complex, const WidthSpace& space, const SimplexRule* rule,
             bool is_convex);

  /// Fills `slab` from its seed. Seeds that are wider than `width` alone are slabs of their own.
  /// Cost  each simplex beside the slab is met once. A product of a direction with all points, two more each
  ///       time the slab is turned; none for small slabs where the hull is convex; a search instead where the
  ///       space is large.
  void grow(GrownSlab& slab, double width, const CoverEffort& effort, SlabScratch& scratch) const;

  /// Fills `slab` from its seed, with the vertices that are less than `width` below its plane. Of a seed that
  /// is wider than `width` alone only its own.
  /// Cost  some three products of a direction with all points; with the vertices, and searches, where the
  ///       space is large.
  void find_vertices_of(VertexSlab& slab, double width, const CoverEffort& effort,
                        SlabScratch& scratch) const;

  /// So few points that each large slab has its products with all of them.
  bool meets_all_points() const;

  /// The different vertices, as rows of the space.
  std::span<const std::uint32_t> vertices_of(std::span<const std::uint32_t> members,
                                             SlabScratch& scratch) const;

 private:
  bool may_extend(std::uint32_t seed, const double* normal, double width) const;
  double dot_of(const double* normal, std::uint32_t row) const;
  void set_own_plane(GrownSlab& slab) const;
  void fit_plane_to_seed(std::uint32_t seed, double width, const CoverEffort& effort, FittedPlane& plane,
                         SlabScratch& scratch) const;
  bool holds(const FittedPlane& plane, double width, std::uint32_t simplex) const;
  void measure(FittedPlane& plane, SlabScratch& scratch) const;
  void find_vertices_below(const FittedPlane& plane, double width, SlabScratch& scratch) const;
  void turn_to_vertices_below(FittedPlane& plane, double width, const CoverEffort& effort,
                              SlabScratch& scratch) const;
  void turn_to_members(GrownSlab& slab, double width, const CoverEffort& effort, SlabScratch& scratch) const;
  void flood(std::uint32_t seed, const FittedPlane& plane, double width, std::size_t enough,
             SlabScratch& scratch) const;
  template <std::size_t D>
  void flood_in(std::uint32_t seed, const FittedPlane& plane, double width, std::size_t enough,
                SlabScratch& scratch) const;

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const SimplexRule* rule_;
  bool is_convex_;
};

}  // namespace ndhull
