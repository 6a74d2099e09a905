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
  /// `first_rows`: of the simplicial facets, which come first, rank points each, oriented alike. `begin`: of
  /// each facet in faces.facets, and the end; empty: each is one of these.
  PulledSimplices(PulledFaces faces, std::vector<std::uint32_t> first_rows, std::vector<std::uint32_t> begin)
      : faces_(std::move(faces)), first_rows_(std::move(first_rows)), begin_(std::move(begin)) {}

  std::uint64_t count_of(FacetId facet) const override;
  void rename_points(std::span<const std::uint32_t> ids) override;

 private:
  GroupedComplex make() const override;

  PulledFaces faces_;
  std::vector<std::uint32_t> first_rows_, begin_;
};

}  // namespace ndhull
