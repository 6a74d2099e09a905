#include "approx/facets/flat_facets.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

class FlatSearch {
 public:
  FlatSearch(const SimplicialComplex& complex, const double* points, double tolerance,
             std::vector<std::uint32_t>& cluster_of)
      : complex_(complex), points_(points), tolerance_(tolerance), cluster_of_(cluster_of) {}

  std::vector<FlatFacet> run(std::span<const double> determinants) {
    cluster_of_.assign(complex_.row_count, FacetId::kNone);
    list_vertices();
    std::vector<std::uint32_t> left = by_area(determinants);
    most_planes_ = kMostMisses + complex_.row_count / vertices_.size();
    for (std::size_t before = 0;; before = facets_.size()) {
      assign(left, before);
      if (facets_.size() - before < kPlanesInRound) break;
    }
    walk_.resize(complex_.row_count + complex_.rank);
    point_seen_by_.resize(planes_of_.size(), FacetId::kNone);
    for (std::uint32_t facet = 0; facet < facets_.size(); ++facet) walk_over(facet);
    for (std::uint32_t& facet : cluster_of_)
      facet = facet == FacetId::kNone || (facet & kReached) == 0 ? FacetId::kNone : facet & ~kReached;
    return std::move(facets_);
  }

 private:
  static constexpr std::size_t kPlanesInRound = 64;  // a bit each
  static constexpr std::size_t kMostMisses = 16;
  static constexpr std::size_t kAhead = 8;  // simplices on their way from memory
  // Marks a simplex that its facet's walk met.
  static constexpr std::uint32_t kReached = std::uint32_t{1} << 31;

  void list_vertices() {
    std::vector<std::uint8_t> is_vertex;
    for (std::size_t row = 0; row < complex_.row_count; ++row) {
      for (const PointId id : complex_.vertices(SimplexId{static_cast<std::uint32_t>(row)})) {
        if (id.value >= is_vertex.size()) is_vertex.resize(2 * std::size_t{id.value} + 2);
        is_vertex[id.value] = 1;
      }
    }
    for (std::size_t id = 0; id < is_vertex.size(); ++id)
      if (is_vertex[id]) vertices_.push_back(PointId{static_cast<std::uint32_t>(id)});
    planes_of_.resize(std::size_t{vertices_.back().value} + 1);
  }

  /// The simplices by the exponent of the square of their area, largest first: good seeds need no more.
  std::vector<std::uint32_t> by_area(std::span<const double> determinants) const {
    constexpr std::size_t kExponents = 2048;
    std::vector<std::uint16_t> exponent(complex_.row_count);
    std::vector<std::uint32_t> begin(kExponents + 1, 0);
    for (std::size_t row = 0; row < complex_.row_count; ++row) {
      // |det| / height is the area up to a constant factor.
      double square = 0.0;
      for (const double entry : complex_.plane(SimplexId{static_cast<std::uint32_t>(row)}))
        square += entry * entry;
      const double area = determinants[row] * determinants[row] * square;
      const std::uint64_t bits = (std::bit_cast<std::uint64_t>(area) >> 52) & (kExponents - 1);  // no sign
      exponent[row] = static_cast<std::uint16_t>(kExponents - 1 - bits);
      ++begin[exponent[row] + 1u];
    }
    for (std::size_t e = 0; e < kExponents; ++e) begin[e + 1] += begin[e];
    std::vector<std::uint32_t> rows(complex_.row_count);
    for (std::size_t row = 0; row < complex_.row_count; ++row)
      rows[begin[exponent[row]]++] = static_cast<std::uint32_t>(row);
    return rows;
  }

  /// Takes planes of those left over, at most a round of them, and keeps those that are in none.
  void assign(std::vector<std::uint32_t>& left, std::size_t before) {
    for (const PointId id : vertices_) planes_of_[id.value] = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (i + kAhead < left.size()) prefetch(complex_.vertices(SimplexId{left[i + kAhead]}).data());
      const std::uint32_t row = left[i];
      const auto vertices = complex_.vertices(SimplexId{row});
      std::uint64_t common = ~std::uint64_t{0};
      for (const PointId id : vertices) common &= planes_of_[id.value];
      if (common == 0 && facets_.size() - before < kPlanesInRound && may_try() && try_plane(row, before))
        common = std::uint64_t{1} << (facets_.size() - 1 - before);
      if (common == 0) {
        left[kept++] = row;
        continue;
      }
      cluster_of_[row] =
          static_cast<std::uint32_t>(before + static_cast<std::size_t>(std::countr_zero(common)));
    }
    left.resize(kept);
  }

  bool may_try() const { return misses_ < kMostMisses + 2 * facets_.size() && tried_ < most_planes_; }

  bool try_plane(std::uint32_t seed, std::size_t before) {
    const std::size_t rank = complex_.rank;
    const double* plane = complex_.plane(SimplexId{seed}).data();
    const auto own = complex_.vertices(SimplexId{seed});
    in_plane_.assign(own.begin(), own.end());
    for (const PointId id : vertices_) {
      const double* point = points_ + std::size_t{id.value} * rank;
      double gauge = -1.0;
      for (std::size_t k = 0; k < rank; ++k) gauge = __builtin_fma(plane[k], point[k], gauge);
      if (std::abs(gauge) <= tolerance_ && std::find(own.begin(), own.end(), id) == own.end())
        in_plane_.push_back(id);
    }
    ++tried_;
    if (in_plane_.size() == rank) {
      ++misses_;
      return false;
    }
    const std::uint64_t bit = std::uint64_t{1} << (facets_.size() - before);
    for (const PointId id : in_plane_) planes_of_[id.value] |= bit;
    facets_.push_back({seed, {}, {}});
    return true;
  }

  // From the seed over neighbours in the same plane. Others are let go: where points are about as rough as
  // the tolerance, simplices behind an edge may have all vertices near the plane as well.
  void walk_over(std::uint32_t facet) {
    FlatFacet& flat = facets_[facet];
    const std::uint32_t reached = facet | kReached;
    std::size_t count = 1;
    walk_[0] = flat.seed;
    cluster_of_[flat.seed] = reached;
    for (std::size_t i = 0; i < count; ++i) {
      if (i + kAhead < count) prefetch(complex_.vertices(SimplexId{walk_[i + kAhead]}).data());
      const SimplexId simplex{walk_[i]};
      for (const SimplexId neighbour : complex_.neighbours(simplex)) {
        std::uint32_t& other = cluster_of_[neighbour.value];
        const std::uint32_t is_new = other == facet;
        other |= is_new << 31;
        walk_[count] = neighbour.value;
        count += is_new;
      }
      for (const PointId id : complex_.vertices(simplex)) {
        if (point_seen_by_[id.value] == facet) continue;
        point_seen_by_[id.value] = facet;
        flat.points.push_back(id);
      }
    }
    flat.simplices.assign(walk_.begin(), walk_.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(flat.points.begin(), flat.points.end());
  }

  const SimplicialComplex& complex_;
  const double* points_;
  double tolerance_;
  std::vector<std::uint32_t>& cluster_of_;
  std::vector<PointId> vertices_;
  std::vector<std::uint64_t> planes_of_;  // per point, a bit for each plane of the round that it is in
  std::vector<PointId> in_plane_;
  std::vector<std::uint32_t> point_seen_by_;  // the last facet
  std::vector<std::uint32_t> walk_;
  std::vector<FlatFacet> facets_;
  std::size_t tried_ = 0, misses_ = 0, most_planes_ = 0;
};

}  // namespace

std::vector<FlatFacet> find_flat_facets(const SimplicialComplex& complex, const double* points,
                                        std::span<const double> determinants, double tolerance,
                                        std::vector<std::uint32_t>& cluster_of) {
  return FlatSearch(complex, points, tolerance, cluster_of).run(determinants);
}

}  // namespace ndhull
