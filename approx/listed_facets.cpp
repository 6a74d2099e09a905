#include "approx/listed_facets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <vector>

#include "approx/gradient_length.h"
#include "core/blocks.h"
#include "core/dimension_switch.h"
#include "core/id_rows.h"
#include "core/plane_kernels.h"
#include "core/prefetch.h"

namespace ndhull {
namespace {

constexpr std::size_t kRowsAhead = 24;  // whose way from memory has begun

/// The vertices of some facets one after the other, as rows of the points.
class VertexLister {
 public:
  explicit VertexLister(const CertificatePoints& points)
      : points_(&points), last_facet_(points.row_of_point.size(), FacetId::kNone) {}

  void clear() {
    rows_.begin.assign(1, 0);
    count_ = 0;
  }
  /// Of the present facet. Whether one was met before cannot be predicted.
  void add(std::span<const PointId> vertices, std::uint32_t facet) {
    if (count_ + vertices.size() > rows_.values.size()) rows_.values.resize(2 * (count_ + vertices.size()));
    std::uint32_t* const values = rows_.values.data();
    for (const PointId id : vertices) {
      values[count_] = points_->row_of_point[id.value];
      count_ += last_facet_[id.value] != facet ? 1u : 0u;
      last_facet_[id.value] = facet;
    }
  }
  void end_facet() { rows_.begin.push_back(static_cast<std::uint32_t>(count_)); }
  const IdRows& rows() const { return rows_; }

 private:
  const CertificatePoints* points_;
  std::vector<std::uint32_t> last_facet_;  // per point: that met it
  IdRows rows_;                            // of the points, facet by facet
  std::size_t count_ = 0;                  // of its values
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
  tbb::enumerable_thread_specific<VertexLister> lister_of_thread([&] { return VertexLister(points); });
  const auto list_vertices = [&](std::uint32_t facet, VertexLister& lister) {
    if (vertices != nullptr) {
      lister.add(as_ids<PointId>(vertices->row(facet - layout.in_place)), facet);
    } else {
      const std::span<const SimplexId> simplices = layout.simplices_of(FacetId{facet});
      const auto first = static_cast<std::size_t>(simplices.data() - layout.simplices.data());
      for (std::size_t i = 0; i < simplices.size(); ++i) {
        const std::size_t later = std::min(first + i + kRowsAhead, layout.simplices.size() - 1);
        prefetch(complex.vertices(layout.simplices[later]).data());
        lister.add(complex.vertices(simplices[i]), facet);
      }
    }
    lister.end_facet();
  };
  for_each_block(layout.facets - layout.in_place, kListedAtATime, [&](std::size_t begin, std::size_t end) {
    VertexLister& lister = lister_of_thread.local();
    lister.clear();
    const std::size_t first = layout.in_place + begin, count = end - begin;
    for (std::size_t i = 0; i < count; ++i) list_vertices(static_cast<std::uint32_t>(first + i), lister);
    listed_dots(points.dimension, {normals + first * points.dimension, count * points.dimension}, points.rows,
                lister.rows(), dots.low.subspan(first, count), dots.high.subspan(first, count),
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
