// Areas of facets that are sums over simplices, made when they are first asked for.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>

#include "approx/facets/facet_layout.h"
#include "core/ids.h"
#include "core/machine/huge_array.h"

namespace ndhull {

class MeasureScale;

/// Of the hulls whose facets have planes of their own (FacetLayout::planes): there a facet's area takes a
/// look at each of its simplices, which are anywhere in memory. Planes, widths and volume take none.
class LaterAreas {
 public:
  /// Shapes  planes: simplices x rank, of the frame; determinants: one a simplex. They are kept until areas
  ///         are asked for. areas: room for one a facet.
  LaterAreas(std::shared_ptr<const MeasureScale> scale, HugeArray<double> planes,
             HugeArray<double> determinants, HugeArray<double> areas)
      : scale_(std::move(scale)),
        planes_(std::move(planes)),
        determinants_(std::move(determinants)),
        areas_(std::move(areas)) {}

  /// Sums over all simplices, cones about the frame's centre: volume in multiples of 2^volume_exponent, and
  /// area, in input units. The bits are the same for any number of threads.
  /// Cost  a pass over planes and determinants, as they stand.
  struct Totals {
    double volume = 0.0, surface = 0.0;
  };
  Totals totals(const FacetLayout& layout) const;

  /// Of all facets: input units, of the projection of their simplices onto their planes; 0 where most of them
  /// face away. Several threads may ask.
  /// Shapes  normals: facets x dimension, unit.
  /// Cost    the first call reads 8 (rank + 1) bytes for each simplex, anywhere in memory.
  std::span<const double> of_facets(const FacetLayout& layout, const double* normals) const;

 private:
  void make(const FacetLayout& layout, const double* normals) const;

  std::shared_ptr<const MeasureScale> scale_;
  mutable HugeArray<double> planes_, determinants_;
  mutable HugeArray<double> areas_;
  mutable std::once_flag is_made_;
};

}  // namespace ndhull
