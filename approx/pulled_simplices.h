// The simplices of a hull that was found without them, made when they are first asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "core/face_pulling.h"
#include "core/ids.h"
#include "core/pulled_complex.h"

namespace ndhull {

/// Several threads may ask at once. Throws Error kTooManySimplices (core/pulled_complex.h).
class PulledSimplices {
 public:
  /// `first_rows`: of the simplicial facets, which come first, rank points each, oriented alike.
  PulledSimplices(PulledFaces faces, std::vector<std::uint32_t> first_rows)
      : faces_(std::move(faces)), first_rows_(std::move(first_rows)) {}

  std::uint64_t count_of(FacetId facet) const { return faces_.faces[faces_.facets[facet.value]].simplices; }
  const SimplicialComplex& complex() const { return made().complex; }
  FacetId facet_of(SimplexId simplex) const;
  std::span<const SimplexId> of(FacetId facet) const;

  /// Point i is now ids[i]. Before simplices were asked for.
  void rename_points(std::span<const std::uint32_t> ids);

 private:
  const PulledComplex& made() const;

  PulledFaces faces_;
  std::vector<std::uint32_t> first_rows_;
  mutable std::once_flag is_made_;
  mutable PulledComplex made_;
  mutable std::vector<SimplexId> own_ids_;  // 0, 1, 2, ...
};

}  // namespace ndhull
