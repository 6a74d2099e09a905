#include "approx/slabs/held_simplices.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "approx/slabs/plane_fit.h"
#include "approx/slabs/slab_growth.h"
#include "core/complex/simplicial_complex.h"
#include "core/ids.h"

namespace ndhull {
namespace {

/// Facets that are compared with a simplex, and simplices that they are looked for around.
constexpr std::size_t kMostFacets = 24, kMostWalked = 48;
/// Of those so many are turned to it, the nearest first.
constexpr std::size_t kMostTurned = 4;
constexpr unsigned kSteps = 128;
/// Fits for all of them, some 10 us each: so many, and one for each so many simplices.
constexpr std::size_t kManyFits = 1024, kSimplicesForFit = 128;

class UnfitSimplices {
 public:
  UnfitSimplices(const WidthSpace& space, const double* coordinates, double width, DualFacets& facets)
      : space_(space),
        complex_(*facets.complex),
        coordinates_(coordinates),
        width_(width),
        facets_(facets),
        facet_of_(facets.facet_of_rows()),
        held_(facets.count(), true) {}

  void run() {
    const std::vector<std::uint32_t> unfit = std::exchange(facets_.unfit, {});
    for (const std::uint32_t row : unfit) held_[facet_of_[row]] = false;
    fits_left_ = kManyFits + facets_.members.size() / kSimplicesForFit;
    for (const std::uint32_t row : unfit) {
      if (find_plane(row)) {
        held_[facet_of_[row]] = true;
      } else {
        facets_.unfit.push_back(row);
      }
    }
  }

 private:
  bool find_plane(std::uint32_t row) {
    list_beside(row);
    nearest_.clear();
    for (const std::uint32_t facet : beside_) nearest_.push_back({missing_below(facet, row), facet});
    const std::size_t count = std::min(nearest_.size(), kMostTurned);
    std::partial_sort(nearest_.begin(), nearest_.begin() + static_cast<std::ptrdiff_t>(count),
                      nearest_.end());
    if (count > 0 && nearest_[0].first <= 0.0) {
      const std::uint32_t facet = nearest_[0].second;
      const std::span<const double> plane = facets_.plane(facet);
      set_plane(row, {plane.begin(), plane.end()}, facets_.tops[facet], facets_.lengths[facet]);
      return true;
    }
    for (std::size_t i = 0; i < count && fits_left_ > 0; ++i, --fits_left_)
      if (fit(row, nearest_[i].second)) return true;
    return false;
  }

  /// The nearest facets with planes, across ridges of simplices without.
  void list_beside(std::uint32_t row) {
    beside_.clear();
    walked_.assign(1, row);
    for (std::size_t i = 0; i < walked_.size() && beside_.size() < kMostFacets; ++i) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{walked_[i]})) {
        const std::uint32_t facet = facet_of_[neighbour.value];
        std::vector<std::uint32_t>& list = held_[facet] ? beside_ : walked_;
        const std::uint32_t entry = held_[facet] ? facet : neighbour.value;
        const bool is_full = !held_[facet] && list.size() == kMostWalked;
        if (!is_full && std::find(list.begin(), list.end(), entry) == list.end()) list.push_back(entry);
      }
    }
  }

  /// How much deeper than the width the simplex is below the facet's plane. [distance]
  double missing_below(std::uint32_t facet, std::uint32_t row) const {
    const std::span<const double> plane = facets_.plane(facet);
    double low = HUGE_VAL;
    for (const PointId vertex : complex_.vertices(SimplexId{row})) {
      const double* y = coordinates_ + std::size_t{vertex.value} * plane.size();
      low = std::min(low, std::inner_product(plane.begin(), plane.end(), y, 0.0));
    }
    return (facets_.tops[facet] - low) / double{facets_.lengths[facet]} - kDepthRoom * width_;
  }

  bool fit(std::uint32_t row, std::uint32_t from) {
    vertices_.clear();
    for (const PointId id : complex_.vertices(SimplexId{row})) vertices_.push_back(space_.row_of(id));
    std::vector<double> plane(complex_.rank);
    space_.normal_of(facets_.plane(from), plane.data());
    const FittedPlane start = measure_plane(space_, plane, vertices_, work_);
    const FittedPlane fitted = narrow_plane(space_, start, vertices_, kSteps, work_);
    if (fitted.width() > width_) return false;
    space_.plane_of(fitted.normal.data(), fitted.height, plane.data());
    set_plane(row, plane, 1.0, static_cast<float>(1.0 / fitted.height));
    return true;
  }

  void set_plane(std::uint32_t row, const std::vector<double>& plane, double top, float length) {
    const std::uint32_t facet = facet_of_[row];
    facets_.own_plane[facet] = static_cast<std::uint32_t>(facets_.own_planes.size() / plane.size());
    facets_.own_planes.insert(facets_.own_planes.end(), plane.begin(), plane.end());
    facets_.tops[facet] = top;
    facets_.lengths[facet] = length;
    facets_.are_far_from_centre &= top > width_ * double{length};
  }

  const WidthSpace& space_;
  const SimplicialComplex& complex_;
  const double* coordinates_;
  double width_;
  DualFacets& facets_;
  std::vector<std::uint32_t> facet_of_;  // per row of the complex
  std::vector<bool> held_;               // per facet: its plane holds it
  std::vector<std::uint32_t> beside_, walked_, vertices_;
  std::vector<std::pair<double, std::uint32_t>> nearest_;  // by how much is missing, facets
  std::size_t fits_left_ = 0;
  PlaneFitWork work_;
};

}  // namespace

void hold_unfit(const WidthSpace& space, const double* coordinates, double width, DualFacets& facets) {
  if (!facets.unfit.empty() && facets.may_join()) UnfitSimplices(space, coordinates, width, facets).run();
}

}  // namespace ndhull
