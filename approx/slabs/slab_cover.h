// Few facets of a given width: slabs below supporting planes that together hold all simplices.
//
// A facet of width T is a set of simplices whose vertices all lie less than T below one supporting plane.
// Which plane is free, so the least number of facets is a problem of covering: choose few directions n such
// that each simplex is within T below the supporting plane of one of them. That looks at the whole hull at
// once, which merging neighbours pair by pair cannot: on spheres it needs 15 to 40 % fewer facets.
//
// Paper  Cohen-Steiner, Alliez, Desbrun. Variational shape approximation. SIGGRAPH 2004 (facets as regions
//        grown from seeds around refitted planes; there in 3-d and for the mean error).
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/slab_choice.h"
#include "approx/slabs/slab_growth.h"
#include "approx/slabs/slab_seeds.h"
#include "approx/slabs/wide_cover.h"
#include "approx/slabs/width_space.h"
#include "approx/work_end.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

class SlabCover {
 public:
  /// The complex may hold free rows. `is_convex`: no point of the space is above any simplex's plane by more
  /// than rounding. `rule`: which simplices may be in one slab at all; null: all that fit. All must outlive
  /// this.
  SlabCover(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex,
            const SimplexRule* rule = nullptr);

  /// Facets that are no wider than `width`, as far as the points of the space tell; a simplex that alone is
  /// wider becomes a facet all the same. The same for any number of threads. Given up, without planes, when it
  /// turns out that they would be far more than `most`: expected_facets() then says about how many. So when
  /// `end` comes first, where that may say too few.
  /// Cost  growing the slabs (slab_growth.h, wide_cover.h), which hold each simplex 1.5 to 5 times. 4 bytes
  ///       a row for each thread, 8 for each place in a slab.
  Covering cover(double width, const CoverEffort& effort, std::size_t most = SIZE_MAX,
                 const WorkEnd& end = WorkEnd());

  double expected_facets() const { return expected_facets_; }
  std::size_t live_count() const { return seeds_.live_count(); }

 private:
  using Members = std::span<const std::uint32_t>;

  bool is_given_up(const CoverEffort& effort, std::size_t most, const WorkEnd& end);
  void add_slabs(std::span<const SeedChoice> seeds, double width, const CoverEffort& effort);
  Covering assign(const std::vector<std::uint32_t>& chosen, double width, const CoverEffort& effort);
  void measure_facets(Covering& covering, double width, const CoverEffort& effort);
  void settle(Members members, double width, const CoverEffort& effort, FittedPlane& plane);

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  bool is_convex_;
  double expected_facets_ = 0.0;
  SlabGrower grower_;
  SlabSeeds seeds_;
  std::vector<GrownSlab> batch_;
  std::optional<WideCover> wide_;  // of enough simplices with few vertices
  tbb::enumerable_thread_specific<SlabScratch> scratch_;
  std::vector<FittedPlane> planes_;     // of all slabs
  std::vector<MemberRange> slabs_;      // of members_
  std::vector<std::uint32_t> members_;  // of all slabs
  std::vector<float> depths_;           // of each member in its slab
  std::vector<float> depth_of_;         // per row: in the facet it was assigned to
};

}  // namespace ndhull
