// A covering of a hull that has grown since: what is still there stays in its facet, and the new simplices go
// to facets around those that they have replaced.
#pragma once

#include <cstdint>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Which simplices a complex has, to tell them from those that later stand in their rows.
class SimplexNames {
 public:
  explicit SimplexNames(const SimplicialComplex& complex);
  /// The simplex that stood in this row is there still, but for one in four thousand millions that is another.
  bool is_same(const SimplicialComplex& complex, std::uint32_t row) const {
    return row < names_.size() && names_[row] != kFree && names_[row] == name_of(complex, row);
  }

 private:
  static constexpr std::uint32_t kFree = 0;
  static std::uint32_t name_of(const SimplicialComplex& complex, std::uint32_t row);

  std::vector<std::uint32_t> names_;  // per row
};

/// `covering` is of the complex as `before` has it. New simplices go to facets of their neighbours, from the
/// rim inwards, until none lies higher in another neighbour's; those deeper than `width` [distance] look at all
/// facets beside new simplices and that have lost some. Facets left without a simplex are dropped, the
/// planes of all others measured.
///
/// Shapes  space: of the complex as it is now.
/// Cost    of each new simplex some products for each of its neighbours, in some passes; of each simplex its
///         vertices; of each facet a product of its normal with all points.
Covering carry_facets(const SimplicialComplex& complex, const WidthSpace& space, const SimplexNames& before,
                      const Covering& covering, double width);

}  // namespace ndhull
