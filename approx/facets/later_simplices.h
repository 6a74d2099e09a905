// The simplices of a hull that was found without them, made when they are first asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "approx/facets/facet_layout.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {

/// Several threads may ask at once; what throws is said where they are made.
class LaterSimplices {
 public:
  LaterSimplices() = default;
  LaterSimplices(const LaterSimplices&) = delete;
  LaterSimplices& operator=(const LaterSimplices&) = delete;
  virtual ~LaterSimplices() = default;

  virtual std::uint64_t count_of(FacetId facet) const = 0;
  /// Point i is now ids[i]. Before simplices were asked for.
  virtual void rename_points(std::span<const std::uint32_t> ids) = 0;

  const SimplicialComplex& complex() const { return made().complex; }
  FacetId facet_of(SimplexId simplex) const;
  std::span<const SimplexId> of(FacetId facet) const;
  /// As far as lists of vertices and neighbours need it (facet_lists.h). `simplicial`: so many facets, which
  /// come first, are one simplex each.
  FacetLayout layout(std::size_t simplicial) const;

 private:
  virtual GroupedComplex make() const = 0;
  const GroupedComplex& made() const;

  mutable std::once_flag is_made_;
  mutable GroupedComplex made_;
  mutable std::vector<SimplexId> own_ids_;  // 0, 1, 2, ...
};

}  // namespace ndhull
