// Few facets of a given width: slabs below supporting planes that together hold all simplices.
//
// A facet of width T is a set of simplices whose vertices all lie less than T below one supporting plane.
// Which plane is free, so the least number of facets is a problem of covering: choose few directions n such
// that each simplex is within T below the supporting plane of one of them. That looks at the whole hull at
// once, which merging neighbours pair by pair cannot: on spheres it needs 15 to 40 % fewer facets.
//
// Papers  Chvatal. A greedy heuristic for the set-covering problem. Mathematics of Operations Research 4(3),
//         1979. Cohen-Steiner, Alliez, Desbrun. Variational shape approximation. SIGGRAPH 2004 (facets as
//         regions grown from seeds around refitted planes; there in 3-d and for the mean error).
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/covering.h"
#include "approx/merge_rule.h"
#include "approx/plane_fit.h"
#include "approx/width_space.h"
#include "core/simplicial_complex.h"

namespace ndhull {

/// How hard to look for few facets.
struct CoverEffort {
  unsigned choices = 1;  ///< slabs that each simplex is in before slabs are chosen
  unsigned refits = 1;   ///< times that a slab is turned to its simplices and grown again
  unsigned fit_steps = 12;
  unsigned final_fit_steps = 64;
};

class SlabCover {
 public:
  /// The complex may hold free rows. `rule`: which simplices may be in one slab at all; null: all that fit.
  /// All must outlive this.
  SlabCover(const SimplicialComplex& complex, const WidthSpace& space, const SimplexRule* rule = nullptr);

  /// Facets that are no wider than `width`, as far as the points of the space tell; a simplex that alone is
  /// wider becomes a facet all the same. The same for any number of threads.
  /// Cost  each simplex is met some 3 to 5 times, rank checks of rank bytes each; two products of a direction
  ///       with all points of the space for each slab tried and each time it is turned. 4 bytes a row for
  ///       each thread.
  Covering cover(double width, const CoverEffort& effort);

  std::size_t live_count() const { return live_count_; }

 private:
  struct Slab {
    FittedPlane plane;
    std::size_t begin = 0, end = 0;  // of members_
  };
  /// What one thread needs to grow a slab.
  struct Scratch {
    explicit Scratch(const SlabCover& cover);
    PlaneFitWork fit;
    std::vector<std::uint8_t> point_in_slab;  // per point
    std::vector<std::uint32_t> marked;        // rows of the space that are set there
    std::vector<std::uint32_t> stamp;         // per row of the complex: last flood that met it
    std::vector<std::uint32_t> vertex_stamp;  // per row of the space
    std::uint32_t flood = 0, vertex_pass = 0;
    std::vector<std::uint32_t> vertices, grown;
  };
  struct GrownSlab {
    std::uint32_t seed = 0;
    FittedPlane plane;
    std::vector<std::uint32_t> members;
  };

  void grow_slab(GrownSlab& slab, double width, const CoverEffort& effort, Scratch& scratch) const;
  void add_slabs(std::span<GrownSlab> slabs, double width, const CoverEffort& effort);
  bool may_extend(std::uint32_t seed, const double* normal, double width) const;
  void flood(std::uint32_t seed, const FittedPlane& plane, double width, Scratch& scratch) const;
  std::span<const std::uint32_t> vertices_of(std::span<const std::uint32_t> members, Scratch& scratch) const;
  std::vector<std::uint32_t> choose_slabs();
  Covering assign(const std::vector<std::uint32_t>& chosen, double width, const CoverEffort& effort);
  void fit_facets(Covering& covering, double width, const CoverEffort& effort);
  void gather_strays(Covering& covering, double width);
  double low_of(std::span<const std::uint32_t> simplices, const double* dots) const;
  std::span<const std::uint32_t> members_of(const Slab& slab) const {
    return {members_.data() + slab.begin, slab.end - slab.begin};
  }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const SimplexRule* rule_;
  std::size_t live_count_ = 0, point_count_ = 0;
  tbb::enumerable_thread_specific<Scratch> scratch_;
  std::vector<Slab> slabs_;
  std::vector<std::uint32_t> members_;  // of all slabs
  std::vector<std::uint8_t> hits_;      // per row: slabs it is in, at most 255
};

}  // namespace ndhull
