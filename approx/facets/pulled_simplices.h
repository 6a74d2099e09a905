// The simplices of a hull that was found by whole facets: those of its pulling triangulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/facets/later_simplices.h"
#include "core/ids.h"
#include "core/whole_facets/face_pulling.h"

namespace ndhull {

/// Throws Error kTooManySimplices (core/whole_facets/pulled_complex.h).
class PulledSimplices : public LaterSimplices {
 public:
  /// `first_rows`: of the simplicial facets, which come first, rank points each, oriented alike.
  PulledSimplices(PulledFaces faces, std::vector<std::uint32_t> first_rows)
      : faces_(std::move(faces)), first_rows_(std::move(first_rows)) {}

  std::uint64_t count_of(FacetId facet) const override {
    return faces_.faces[faces_.facets[facet.value]].simplices;
  }
  void rename_points(std::span<const std::uint32_t> ids) override;

 private:
  GroupedComplex make() const override;

  PulledFaces faces_;
  std::vector<std::uint32_t> first_rows_;
};

}  // namespace ndhull
