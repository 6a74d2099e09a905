// Narrower facets of the same number: simplices change facets and planes turn, by turns.
//
// A covering takes what slabs of one width can hold, and holds some simplices in several; which of its facets
// end up full is chance. Here each simplex goes to the neighbouring facet below whose plane it lies highest,
// and planes are fitted to what they have then. Neither makes the widest facet wider over the points of the
// space, but for rounding in single precision.
//
// Papers  Lloyd. Least squares quantization in PCM. IEEE Trans. Inf. Theory 28, 1982; Cohen-Steiner, Alliez,
//         Desbrun. Variational shape approximation. SIGGRAPH 2004 (there for the mean error); Gonzalez.
//         Clustering to minimize the maximum intercluster distance. Theor. Comput. Sci. 38, 1985 (the deepest
//         as the next seed).
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

class FacetBalance {
 public:
  /// The complex may hold free rows. `is_convex`: no point of the space is above any simplex's plane by more
  /// than rounding. Complex and space must outlive this.
  FacetBalance(const SimplicialComplex& complex, const WidthSpace& space, bool is_convex, Covering covering);

  const Covering& covering() const { return covering_; }
  /// The same simplices, whole facets of which may have become one, the others with the normals that they
  /// had: what is known of those stays known.
  void set_joined(Covering joined);

  /// Lets simplices change facets, and fits the planes of facets that are not what they were; facets left
  /// without a simplex are dropped. False: nothing has changed. The same for any number of threads.
  /// Cost  a product of vertices and neighbouring planes for each simplex at a border that may have moved, a
  ///       fit (approx/slabs/plane_fit.h) for each facet that has changed.
  bool turn();

  /// Of the widest facets, as many as are to come more, the deepest simplex becomes a facet of its own, which
  /// takes its part from the others in the turns that follow. Cost  a product for each of their vertices.
  void split_widest(std::size_t count);

 private:
  void find_depths();
  bool exchange(bool is_first);
  template <std::size_t D>
  double dot(std::uint32_t facet, PointId vertex) const;
  template <std::size_t D>
  float depth_in(std::uint32_t row, std::uint32_t facet) const;
  template <std::size_t D>
  void move_to_highest(std::uint32_t row, bool is_first);
  void mark_changed(const std::vector<std::uint32_t>& before);
  /// What one thread needs.
  struct BalanceScratch {
    PlaneFitWork fit;
    FacetVertices vertices;
  };
  void fit(std::uint32_t facet, std::span<const std::uint32_t> members, BalanceScratch& scratch);
  void drop_empty();
  std::uint32_t deepest_of(std::span<const std::uint32_t> members, const FittedPlane& plane) const;

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  bool is_convex_;
  Covering covering_;
  std::vector<double> normals_, heights_;  // of the facets as they turned last: facets x rank, and facets
  std::vector<std::uint8_t> is_turned_;    // per facet: its plane is not what it was a turn ago
  std::vector<std::uint8_t> is_changed_;   // per facet: it has lost simplices or got some
  std::vector<float> depth_of_;            // per row: below its facet's plane
  std::vector<std::uint32_t> next_;        // per row: the facet it goes to
  std::vector<std::uint8_t> is_near_;      // per row: beside one that has just moved
  tbb::enumerable_thread_specific<BalanceScratch> scratch_;
};

}  // namespace ndhull
