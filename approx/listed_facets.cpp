#include "approx/listed_facets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <vector>

#include "approx/gradient_length.h"
#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/plane_kernels.h"
#include "core/prefetch.h"

namespace ndhull {
namespace {

constexpr std::size_t kRowsAhead = 8;  // whose way from memory has begun

struct FacetListScratch {
  std::vector<std::uint32_t> last_facet;  // per point: that met it
  IdRows rows;                            // of the points, facet by facet
};

template <std::size_t D>
void sum_simplices_of(const SimplicialComplex& complex, std::span<const double> determinants,
                      const FacetLayout& layout, std::size_t begin, SimplexSums& sums) {
  const GradientLength<D> length_of(layout.gradient_factor);
  std::fill(sums.area_vectors.begin(), sums.area_vectors.end(), 0.0);
  std::size_t merged = 0;
  for (std::size_t i = 0; i < sums.determinants.size(); ++i) {
    const std::span<const SimplexId> simplices =
        layout.simplices_of(FacetId{static_cast<std::uint32_t>(begin + i)});
    if (begin + i < layout.simplicial) {
      sums.determinants[i] = determinants[simplices[0].value];
      continue;
    }
    const auto first = static_cast<std::size_t>(simplices.data() - layout.simplices.data());
    double* const area_vector = sums.area_vectors.data() + merged++ * D;
    double sum = 0.0;
    for (std::size_t s = 0; s < simplices.size(); ++s) {
      const SimplexId later = layout.simplices[std::min(first + s + kRowsAhead, layout.simplices.size() - 1)];
      prefetch(complex.plane(later).data(), D);
      prefetch(&determinants[later.value]);
      const double* const plane = complex.plane(simplices[s]).data();
      const double determinant = determinants[simplices[s].value];
      for (std::size_t k = 0; k < D; ++k) area_vector[k] += determinant * plane[k];
      sums.surface += determinant * length_of(plane);
      sum += determinant;
    }
    sums.determinants[i] = sum;
  }
}

}  // namespace

void find_own_dots(const SimplicialComplex& complex, const FacetLayout& layout, const IdRows* vertices,
                   const CertificatePoints& points, const double* normals, const ListedDots& dots,
                   const VisitFacets& also) {
  tbb::enumerable_thread_specific<FacetListScratch> scratch_of_thread([&] {
    return FacetListScratch{std::vector<std::uint32_t>(points.row_of_point.size(), FacetId::kNone), IdRows()};
  });
  const auto list_vertices = [&](std::uint32_t facet, FacetListScratch& scratch) {
    const auto meet = [&](std::uint32_t id) {
      if (scratch.last_facet[id] == facet) return;
      scratch.last_facet[id] = facet;
      scratch.rows.values.push_back(points.row_of_point[id]);
    };
    if (vertices != nullptr) {
      for (const std::uint32_t id : vertices->row(facet - layout.in_place)) meet(id);
    } else {
      const std::span<const SimplexId> simplices = layout.simplices_of(FacetId{facet});
      const auto first = static_cast<std::size_t>(simplices.data() - layout.simplices.data());
      for (std::size_t i = 0; i < simplices.size(); ++i) {
        const std::size_t later = std::min(first + i + kRowsAhead, layout.simplices.size() - 1);
        prefetch(complex.vertices(layout.simplices[later]).data());
        if (simplices.size() == 1) {
          for (const PointId id : complex.vertices(simplices[i]))
            scratch.rows.values.push_back(points.row_of_point[id.value]);
        } else {
          for (const PointId id : complex.vertices(simplices[i])) meet(id.value);
        }
      }
    }
    scratch.rows.begin.push_back(static_cast<std::uint32_t>(scratch.rows.values.size()));
  };
  for_each_block(layout.facets - layout.in_place, kListedAtATime, [&](std::size_t begin, std::size_t end) {
    FacetListScratch& scratch = scratch_of_thread.local();
    scratch.rows.begin.assign(1, 0);
    scratch.rows.values.clear();
    const std::size_t first = layout.in_place + begin, count = end - begin;
    for (std::size_t i = 0; i < count; ++i) list_vertices(static_cast<std::uint32_t>(first + i), scratch);
    listed_dots(points.dimension, {normals + first * points.dimension, count * points.dimension}, points.rows,
                scratch.rows, dots.low.subspan(first, count), dots.high.subspan(first, count),
                dots.close.subspan(begin, count));
    if (also) also(first, first + count);
  });
}

void sum_simplices(const SimplicialComplex& complex, std::span<const double> determinants,
                   const FacetLayout& layout, std::size_t begin, SimplexSums& sums) {
  call_with_dimension<1, kMaxRank>(
      complex.rank, [&](auto d) { sum_simplices_of<d>(complex, determinants, layout, begin, sums); });
}

}  // namespace ndhull
