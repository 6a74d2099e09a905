#include "approx/facets/listed_facets.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "core/id_rows.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"
#include "core/search/plane_kernels.h"

namespace ndhull {
namespace {

constexpr std::size_t kRowsAhead = 24, kFacetsAhead = 24;  // whose way from memory has begun

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

/// Looks at facets with lists of simplices or vertices.
class ListedFacets {
 public:
  ListedFacets(const SimplicialComplex& complex, FacetLayout& layout, const IdRows* vertices,
               const CertificatePoints& points, const double* normals, const ListedDots& dots)
      : complex_(complex),
        layout_(layout),
        vertices_(vertices),
        points_(points),
        normals_(normals),
        dots_(dots),
        words_((points.rows.size() / points.dimension + kBitsInWord - 1) / kBitsInWord) {}

  void run() {
    if (is_better_by_rows()) {
      look_at_rows();
    } else {
      look_at_facets();
    }
  }

 private:
  static constexpr std::size_t kBitsInWord = 64, kListedAtATime = 64;

  /// Can one thread keep which points each facet has near, while rows pass by in the order of memory?
  bool is_better_by_rows() const {
    // Bits in the second cache, or in the third where rows are so many that each list would have pages of
    // its own.
    constexpr std::size_t kNear = std::size_t{1} << 20, kRowBytesPerByte = 4, kMostWords = 64;
    constexpr std::size_t kFurther = std::size_t{1} << 22, kRowBytesPerFurtherByte = 12;
    const std::size_t bytes = 8 * layout_.facets * words_,
                      row_bytes = 16 * complex_.rank * complex_.row_count;
    return layout_.in_place == 0 && vertices_ == nullptr && !has_more_threads() && words_ <= kMostWords &&
           ((bytes <= kNear && kRowBytesPerByte * bytes <= row_bytes) ||
            (bytes <= kFurther && kRowBytesPerFurtherByte * bytes <= row_bytes));
  }

  /// Facet by facet: its simplices are anywhere in memory.
  void look_at_facets() {
    tbb::enumerable_thread_specific<VertexLister> lister_of_thread([&] { return VertexLister(points_); });
    for_each_block(layout_.facets - layout_.in_place, kListedAtATime,
                   [&](std::size_t begin, std::size_t end) {
                     VertexLister& lister = lister_of_thread.local();
                     lister.clear();
                     const std::size_t first = layout_.in_place + begin, count = end - begin;
                     for (std::size_t i = 0; i < count; ++i)
                       list_vertices(static_cast<std::uint32_t>(first + i), lister);
                     find_dots(first, lister.rows(), count);
                   });
  }

  void list_vertices(std::uint32_t facet, VertexLister& lister) const {
    if (vertices_ != nullptr) {
      lister.add(as_ids<PointId>(vertices_->row(facet - layout_.in_place)), facet);
    } else {
      const std::span<const SimplexId> simplices = layout_.simplices_of(FacetId{facet});
      for (std::size_t i = 0; i < simplices.size(); ++i) {
        prefetch(complex_.vertices(later_simplex(simplices, i)).data(), complex_.rank);
        lister.add(complex_.vertices(simplices[i]), facet);
      }
    }
    lister.end_facet();
  }

  /// Some places behind simplex `i` of a facet.
  SimplexId later_simplex(std::span<const SimplexId> simplices, std::size_t i) const {
    const auto first = static_cast<std::size_t>(simplices.data() - layout_.simplices.data());
    return layout_.simplices[std::min(first + i + kRowsAhead, layout_.simplices.size() - 1)];
  }

  /// Row by row: of each facet one bit for each vertex.
  void look_at_rows() {
    layout_.number_simplices();
    std::vector<std::uint64_t> is_vertex(layout_.facets * words_);
    const auto last = static_cast<std::uint32_t>(complex_.row_count - 1);
    for (std::uint32_t row = 0; row <= last; ++row) {
      prefetch(is_vertex.data() + facet_of_row(std::min<std::uint32_t>(row + kFacetsAhead, last)) * words_,
               words_);
      std::uint64_t* const bits = is_vertex.data() + facet_of_row(row) * words_;
      for (const PointId id : complex_.vertices(SimplexId{row})) {
        const std::uint32_t point = points_.row_of_point[id.value];
        bits[point / kBitsInWord] |= std::uint64_t{1} << (point % kBitsInWord);
      }
    }
    IdRows lists;
    for (std::size_t begin = 0; begin < layout_.facets; begin += kListedAtATime) {
      const std::size_t end = std::min(begin + kListedAtATime, layout_.facets);
      list_bits(std::span(is_vertex).subspan(begin * words_, (end - begin) * words_), lists);
      find_dots(begin, lists, end - begin);
    }
  }

  std::size_t facet_of_row(std::uint32_t row) const { return layout_.facet_of(SimplexId{row}).value; }

  /// One list for each `words_` words of bits.
  void list_bits(std::span<const std::uint64_t> bits, IdRows& lists) const {
    lists.begin.assign(1, 0);
    lists.values.resize(std::max(lists.values.size(), bits.size() * kBitsInWord));  // if all were set
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < bits.size(); i += words_) {
      for (std::size_t word = 0; word < words_; ++word)
        for (std::uint64_t left = bits[i + word]; left != 0; left &= left - 1)
          lists.values[count++] = static_cast<std::uint32_t>(word * kBitsInWord) +
                                  static_cast<std::uint32_t>(std::countr_zero(left));
      lists.begin.push_back(count);
    }
  }

  /// Of facets `first` and on.
  void find_dots(std::size_t first, const IdRows& lists, std::size_t count) const {
    listed_dots(points_.dimension, {normals_ + first * points_.dimension, count * points_.dimension},
                points_.rows, lists, dots_.low.subspan(first, count), dots_.high.subspan(first, count),
                dots_.close.subspan(first - layout_.in_place, count));
  }

  const SimplicialComplex& complex_;
  FacetLayout& layout_;
  const IdRows* vertices_;
  const CertificatePoints& points_;
  const double* normals_;
  const ListedDots& dots_;
  std::size_t words_;  // of bits for all points
};

}  // namespace

void find_own_dots(const SimplicialComplex& complex, FacetLayout& layout, const IdRows* vertices,
                   const CertificatePoints& points, const double* normals, const ListedDots& dots) {
  ListedFacets(complex, layout, vertices, points, normals, dots).run();
}

}  // namespace ndhull
