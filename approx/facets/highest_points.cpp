#include "approx/facets/highest_points.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/counting_order.h"
#include "core/machine/blocks.h"
#include "core/search/bundle_search.h"
#include "core/search/furthest_points.h"

namespace ndhull {
namespace {

/// Facets in bundles: those of which the same vertex comes first in the tree, and vertices that come one after
/// the other in it, have normals that are near each other.
class BundledFacets {
 public:
  BundledFacets(const SimplicialComplex& complex, const FacetLayout& layout, const CertificatePoints& points,
                const FacetHeights& heights)
      : complex_(complex),
        layout_(layout),
        points_(points),
        heights_(heights),
        tree_(points.dimension, points.rows),
        place_of_row_(tree_.place_of_rows()) {}

  void run() {
    constexpr std::size_t kFacetsAtATime = std::size_t{1} << 22;  // their order takes little memory then
    const std::size_t facets = heights_.highest.size();
    for (std::size_t begin = 0; begin < layout_.in_place; begin += kFacetsAtATime)
      search(begin, std::min(begin + kFacetsAtATime, layout_.in_place), complex_.rank, {});
    for (std::size_t begin = layout_.in_place; begin < facets; begin += kFacetsAtATime) {
      const std::size_t end = std::min(begin + kFacetsAtATime, facets);
      search(begin, end, 0, heights_.close.subspan(begin - layout_.in_place, end - begin));
    }
  }

 private:
  /// `own_count`: vertices of each facet; 0: they differ.
  void search(std::size_t begin, std::size_t end, std::size_t own_count,
              std::span<const std::uint32_t> close) {
    const std::size_t count = end - begin, dimension = points_.dimension;
    highest_dots(tree_, heights_.normals.subspan(begin * dimension, count * dimension),
                 order_by_vertex(begin, end),
                 {heights_.low.subspan(begin, count), heights_.high.subspan(begin, count), own_count, close},
                 heights_.highest.subspan(begin, count));
  }

  /// The facets [begin, end), counted from the first, by the first of their vertices in the tree. Its place
  /// stands where the highest product will.
  std::vector<std::uint32_t> order_by_vertex(std::size_t begin, std::size_t end) const {
    constexpr std::size_t kFacetsInBlock = 4096;
    const std::span<double> places = heights_.highest.subspan(begin, end - begin);
    for_each_block(places.size(), kFacetsInBlock, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        std::uint32_t least = ~std::uint32_t{0};
        for (const PointId id : complex_.vertices(first_simplex_of(begin + i)))
          least = std::min(least, place_of_row_[points_.row_of_point[id.value]]);
        places[i] = least;
      }
    });
    return counting_order<double>(places, place_of_row_.size());
  }

  SimplexId first_simplex_of(std::size_t facet) const {
    const auto id = static_cast<std::uint32_t>(facet);
    return facet < layout_.in_place ? SimplexId{id} : layout_.simplices_of(FacetId{id}).front();
  }

  const SimplicialComplex& complex_;
  const FacetLayout& layout_;
  const CertificatePoints& points_;
  const FacetHeights& heights_;
  PointTree tree_;
  std::vector<std::uint32_t> place_of_row_;
};

void search_one_by_one(const CertificatePoints& points, const FacetHeights& heights) {
  constexpr std::size_t kFacetsAtATime = 1 << 16;  // what is found of each takes little memory then
  const std::size_t dimension = points.dimension, facets = heights.highest.size();
  const StridedRows rows{points.rows.data(), points.rows.size() / dimension, dimension};
  std::vector<double> lowest(dimension, HUGE_VAL), largest(dimension, -HUGE_VAL);
  for (std::size_t i = 0; i < points.rows.size(); i += dimension) {
    for (std::size_t k = 0; k < dimension; ++k) {
      lowest[k] = std::min(lowest[k], points.rows[i + k]);
      largest[k] = std::max(largest[k], points.rows[i + k]);
    }
  }
  FurthestPoints search(dimension, rows, lowest, largest, false);
  search.expect(facets);
  std::vector<FurthestPoint> furthest;
  for (std::size_t begin = 0; begin < facets; begin += kFacetsAtATime) {
    const std::size_t count = std::min(kFacetsAtATime, facets - begin);
    furthest.assign(count, FurthestPoint{});
    for (std::size_t i = 0; i < count; ++i) furthest[i].dot = heights.high[begin + i];
    search.find(heights.normals.subspan(begin * dimension, count * dimension), furthest);
    for (std::size_t i = 0; i < count; ++i) heights.highest[begin + i] = furthest[i].dot;
  }
}

/// Facets of which those that come together are near each other: where they are not twice as many as the
/// points, a search for each took less (13,408 facets of 20,000 points in 6-d: a sixth).
bool are_dense(std::size_t points, std::size_t facets) { return facets / 2 >= points; }

}  // namespace

bool are_many_points(std::size_t dimension, std::size_t points, std::size_t facets) {
  // In bundles 3,000 points are enough in 4-d, 5,000 in 5-d and 8,000 in 6-d.
  constexpr std::size_t kMany = 1 << 13, kManyInLow = 5000, kLowDimension = 5;
  return points >= kMany || (points >= kManyInLow && dimension <= kLowDimension && are_dense(points, facets));
}

void find_highest_of_many(const SimplicialComplex& complex, const FacetLayout& layout,
                          const CertificatePoints& points, const FacetHeights& heights) {
  if (are_dense(points.rows.size() / points.dimension, heights.highest.size())) {
    BundledFacets(complex, layout, points, heights).run();
  } else {
    search_one_by_one(points, heights);
  }
}

}  // namespace ndhull
