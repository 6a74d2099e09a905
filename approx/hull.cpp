#include "approx/hull.h"

#include <algorithm>
#include <cmath>

#include "core/id_rows.h"
#include "core/machine/arena.h"

namespace ndhull {

std::string_view to_string(Phase phase) {
  switch (phase) {
    case Phase::kGrowth: return "growth";
    case Phase::kCertify: return "certify";
    case Phase::kMerge: return "merge";
    case Phase::kCount: break;
  }
  return "unknown";
}

std::string_view to_string(HullStatus status) {
  switch (status) {
    case HullStatus::kComplete: return "complete";
    case HullStatus::kFacetLimit: return "facet_limit";
    case HullStatus::kTimeLimit: return "time_limit";
    case HullStatus::kMemoryLimit: return "memory_limit";
    case HullStatus::kInterrupted: return "interrupted";
  }
  return "unknown";
}

double Hull::offset(FacetId facet) const {
  // normal . x + offset = normal . (x - reference) + centred_offset
  double offset = centred_offset(facet);
  const auto n = normal(facet);
  for (std::size_t k = 0; k < dimension; ++k) offset -= n[k] * reference[k];
  return offset;
}

void Hull::widen(double distance) {
  for (std::uint32_t row = 0; row < facet_count(); ++row) {
    // Rounded up: what is claimed must hold to the last bit.
    const double margin = std::nextafter(distance / input_per_length_unit(FacetId{row}), HUGE_VAL);
    outer_[row] = std::nextafter(outer_[row] + margin, HUGE_VAL);
    inner_[row] = std::nextafter(inner_[row] - margin, -HUGE_VAL);
    max_outer_offset = std::max(max_outer_offset, outer_[row]);
    min_inner_offset = std::min(min_inner_offset, inner_[row]);
    max_facet_width = std::max(max_facet_width, outer_[row] - inner_[row]);
  }
}

double Hull::input_per_length_unit(FacetId facet) const { return length_unit_.input_per_unit(normal(facet)); }

const FacetLists& Hull::lists() const {
  // Isolated: a thread that waits inside must not begin other work of the caller's, which may ask again.
  const auto make = [this] {
    const auto list = [this](const FacetLayout& layout) {
      lists_->lists = list_irregular_facets(simplices(), layout, vertices, point_count);
    };
    if (later_) {
      list(later_->layout(layout_.simplicial));
    } else {
      list(numbered_layout());
    }
  };
  call_once_isolated(lists_->made, make);
  return lists_->lists;
}

std::span<const PointId> Hull::vertices_of(FacetId facet) const {
  if (facet.value < layout_.regular) return simplices_.vertices(SimplexId{facet.value});
  return as_ids<PointId>(lists().vertices.row(facet.value - layout_.regular));
}

std::span<const FacetId> Hull::neighbours_of(FacetId facet) const {
  if (facet.value >= layout_.regular)
    return as_ids<FacetId>(lists().neighbours.row(facet.value - layout_.regular));
  const auto neighbours = simplices_.neighbours(SimplexId{facet.value});
  return {reinterpret_cast<const FacetId*>(neighbours.data()), neighbours.size()};
}

const SimplicialComplex& Hull::simplices() const { return later_ ? later_->complex() : simplices_; }

FacetId Hull::facet_of(SimplexId simplex) const {
  return later_ ? later_->facet_of(simplex) : numbered_layout().facet_of(simplex);
}

const FacetLayout& Hull::numbered_layout() const {
  call_once_isolated(lists_->numbered, [&] { layout_.number_simplices(); });
  return layout_;
}

std::uint64_t Hull::simplex_count_of(FacetId facet) const {
  return later_ ? later_->count_of(facet) : simplices_of(facet).size();
}

std::span<const SimplexId> Hull::simplices_of(FacetId facet) const {
  if (later_) return later_->of(facet);
  return layout_.simplices_of(facet);
}

}  // namespace ndhull
