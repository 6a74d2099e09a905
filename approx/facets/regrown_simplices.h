// The simplices of a hull that was found star by star: its vertices' hull, grown whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/facets/later_simplices.h"
#include "core/id_rows.h"
#include "core/ids.h"

namespace ndhull {

/// Throws Error kTooManySimplices where growth of the vertices does not end in the simplices counted.
class RegrownSimplices : public LaterSimplices {
 public:
  /// Shapes  coordinates: vertices x rank, the hull of which holds 0. ids: the points that these are.
  ///         facet_vertices, sizes: of each facet numbers of vertices and simplices. turns: in which order
  ///         facets took their simplices (approx/slabs/row_cover.h).
  RegrownSimplices(std::size_t rank, std::vector<double> coordinates, std::vector<std::uint32_t> ids,
                   IdRows facet_vertices, std::vector<std::uint32_t> sizes, std::vector<std::uint32_t> turns)
      : rank_(rank),
        coordinates_(std::move(coordinates)),
        ids_(std::move(ids)),
        facet_vertices_(std::move(facet_vertices)),
        sizes_(std::move(sizes)),
        turns_(std::move(turns)) {}

  std::uint64_t count_of(FacetId facet) const override { return sizes_[facet.value]; }
  void rename_points(std::span<const std::uint32_t> ids) override {
    for (std::uint32_t& id : ids_) id = ids[id];
  }

 private:
  GroupedComplex make() const override;
  std::vector<std::uint32_t> facets_of_rows(const SimplicialComplex& complex) const;

  std::size_t rank_;
  std::vector<double> coordinates_;
  std::vector<std::uint32_t> ids_;
  IdRows facet_vertices_;
  std::vector<std::uint32_t> sizes_, turns_;
};

}  // namespace ndhull
