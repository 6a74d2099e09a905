#include "approx/facets/facet_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "approx/geometry/gradient_length.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// Puts row old_of_new[r] of a table of `width` columns into row r, for the rows that old_of_new has; what
/// was there is lost.
void take_rows(std::span<double> table, std::size_t width, std::span<const std::uint32_t> old_of_new) {
  std::vector<double> moved;
  for (std::uint32_t row = 0; row < old_of_new.size(); ++row) {
    if (old_of_new[row] == row) continue;
    const double* old = table.data() + std::size_t{old_of_new[row]} * width;
    moved.insert(moved.end(), old, old + width);
  }
  const double* next = moved.data();
  for (std::uint32_t row = 0; row < old_of_new.size(); ++row) {
    if (old_of_new[row] == row) continue;
    std::copy_n(next, width, table.data() + std::size_t{row} * width);
    next += width;
  }
}

/// What a row is, in the order in which they will stand.
enum Kind : std::uint8_t { kRegular, kBeside, kMerged, kKinds };

struct RowKinds {
  std::vector<Kind> of_row;
  std::array<std::size_t, kKinds> count{};
};

RowKinds find_kinds(const SimplicialComplex& complex, const FacetClusters& clusters) {
  const auto count = static_cast<std::uint32_t>(complex.row_count);
  RowKinds kinds;
  kinds.of_row.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    const bool is_merged = clusters.cluster_of[row] != kNone;
    kinds.of_row[row] = is_merged ? kMerged : kRegular;
    kinds.count[kMerged] += is_merged ? 1u : 0u;
  }
  for (std::uint32_t row = 0; row < count; ++row) {
    if (kinds.of_row[row] != kMerged) continue;
    for (const SimplexId neighbour : complex.neighbours(SimplexId{row})) {
      Kind& kind = kinds.of_row[neighbour.value];
      if (kind != kRegular) continue;
      ++kinds.count[kBeside];
      kind = kBeside;
    }
  }
  kinds.count[kRegular] = count - kinds.count[kMerged] - kinds.count[kBeside];
  return kinds;
}

/// Rows that are not among their kind change places; each kind's come in ascending order.
std::vector<std::uint32_t> row_order(const RowKinds& kinds) {
  std::array<std::uint32_t, kKinds> end{};
  std::inclusive_scan(kinds.count.begin(), kinds.count.end(), end.begin(),
                      [](std::size_t a, std::size_t b) { return static_cast<std::uint32_t>(a + b); });
  const auto home_of = [&](std::uint32_t row) {
    return row < end[0] ? kRegular : row < end[1] ? kBeside : kMerged;
  };
  std::vector<std::uint32_t> old_of_new(kinds.of_row.size());
  std::iota(old_of_new.begin(), old_of_new.end(), 0u);
  std::array<std::vector<std::uint32_t>, kKinds> strangers;  // rows of each kind that stand elsewhere
  for (std::uint32_t row = 0; row < old_of_new.size(); ++row)
    if (kinds.of_row[row] != home_of(row)) strangers[kinds.of_row[row]].push_back(row);
  std::array<std::size_t, kKinds> next{};
  for (std::uint32_t row = 0; row < old_of_new.size(); ++row) {
    const Kind home = home_of(row);
    if (kinds.of_row[row] != home) old_of_new[row] = strangers[home][next[home]++];
  }
  return old_of_new;
}

/// The places of clusters in the order of their first simplex, and how many simplices each has.
struct ClusterPlaces {
  std::vector<std::uint32_t> place_of, cluster_at, size;
  std::size_t merged_rows = 0;
};

ClusterPlaces find_places(const FacetClusters& clusters) {
  ClusterPlaces places;
  places.place_of.assign(clusters.count, kNone);
  places.size.resize(clusters.count);
  for (const std::uint32_t cluster : clusters.cluster_of) {
    if (cluster == kNone) continue;
    if (places.place_of[cluster] == kNone) {
      places.place_of[cluster] = static_cast<std::uint32_t>(places.cluster_at.size());
      places.cluster_at.push_back(cluster);
    }
    ++places.size[places.place_of[cluster]];
    ++places.merged_rows;
  }
  return places;
}

/// Fills the tables of simplices. `old_row`: of each row; the clusters know those.
template <class OldRow>
void list_simplices(const FacetClusters& clusters, const ClusterPlaces& places, const OldRow& old_row,
                    FacetLayout& layout) {
  const auto simplicial = static_cast<std::uint32_t>(layout.simplicial);
  const auto rows = static_cast<std::uint32_t>(clusters.cluster_of.size());
  const auto in_place = static_cast<std::uint32_t>(layout.in_place);
  std::vector<std::uint32_t> next(clusters.count);
  std::exclusive_scan(places.size.begin(), places.size.end(), next.begin(), simplicial);
  layout.merged_begin = next;
  layout.merged_begin.push_back(rows);
  layout.simplices.resize(rows);
  layout.facet_of_others.resize(rows - in_place);
  for (std::uint32_t row = 0; row < in_place; ++row) layout.simplices[row] = SimplexId{row};
  std::uint32_t alone = in_place;
  for (std::uint32_t row = in_place; row < rows; ++row) {
    const std::uint32_t cluster = clusters.cluster_of[old_row(row)];
    std::uint32_t facet = alone;
    if (cluster == kNone) {
      layout.simplices[alone++] = SimplexId{row};
    } else {
      facet = simplicial + places.place_of[cluster];
      layout.simplices[next[places.place_of[cluster]]++] = SimplexId{row};
    }
    layout.facet_of_others[row - in_place] = FacetId{facet};
  }
}

/// Sums over the simplices of each merged facet: determinants, those times the planes, and areas.
struct MergedSums {
  std::vector<double> determinants, area_vectors, surface;
};

/// As the rows stand in memory: of many facets the sums are anywhere, and fetched some rows ahead.
template <std::size_t D>
void sum_rows(const SimplicialComplex& complex, std::span<const double> determinants,
              const FacetClusters& clusters, const ClusterPlaces& places, std::span<const double> factor,
              MergedSums& sums) {
  constexpr std::size_t kAhead = 8;
  const GradientLength<D> length_of(factor);
  for (std::size_t row = 0; row < complex.row_count; ++row) {
    const std::uint32_t later = clusters.cluster_of[std::min(row + kAhead, complex.row_count - 1)];
    if (later != kNone) {
      const double* const sum = sums.area_vectors.data() + std::size_t{places.place_of[later]} * D;
      prefetch(sum, D);
    }
    if (clusters.cluster_of[row] == kNone) continue;
    const std::size_t m = places.place_of[clusters.cluster_of[row]];
    const double* plane = complex.planes.data() + row * D;
    double* area_vector = sums.area_vectors.data() + m * D;
    for (std::size_t k = 0; k < D; ++k) area_vector[k] += determinants[row] * plane[k];
    sums.surface[m] += determinants[row] * length_of(plane);
    sums.determinants[m] += determinants[row];
  }
}

MergedSums sum_merged(const SimplicialComplex& complex, std::span<const double> determinants,
                      const FacetClusters& clusters, const ClusterPlaces& places,
                      std::span<const double> factor) {
  MergedSums sums;
  sums.determinants.resize(clusters.count);
  sums.surface.resize(clusters.count);
  sums.area_vectors.resize(clusters.count * complex.rank);
  call_with_dimension<1, kMaxRank>(
      complex.rank, [&](auto d) { sum_rows<d>(complex, determinants, clusters, places, factor, sums); });
  return sums;
}

/// No row moves: facets get planes of their own, here those of [begin, end). Only those of simplicial ones
/// look at lists.
/// `cluster_at`: of each merged facet.
template <class ClusterAt>
void take_facet_planes(const SimplicialComplex& complex, const FacetClusters& clusters,
                       const ClusterAt& cluster_at, std::size_t begin, std::size_t end, FacetLayout& layout) {
  constexpr std::size_t kPlanesInBlock = 4096, kAhead = 16;  // they are anywhere in memory
  const std::size_t rank = complex.rank;
  const auto plane_of = [&](std::size_t facet) {
    if (facet < layout.simplicial) return complex.plane(layout.simplices[facet]).data();
    return clusters.plane_of(complex, cluster_at(facet - layout.simplicial));
  };
  for_each_block(end - begin, kPlanesInBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t facet = begin + first; facet < begin + last; ++facet) {
      prefetch(plane_of(std::min(facet + kAhead, begin + last - 1)), rank);
      std::copy_n(plane_of(facet), rank, layout.planes.data() + facet * rank);
    }
  });
}

}  // namespace

void FacetLayout::number_simplices() {
  constexpr std::size_t kFacetsInBlock = 1 << 12, kAskedBefore = 16;
  if (in_place == facets || !facet_of_others.empty()) return;
  facet_of_others.resize(simplices.size() - in_place);
  for_each_block(facets - in_place, kFacetsInBlock, [&](std::size_t first, std::size_t last) {
    for (std::size_t facet = in_place + first; facet < in_place + last; ++facet) {
      const auto id = FacetId{static_cast<std::uint32_t>(facet)};
      for (const SimplexId& simplex : simplices_of(id)) {
        const SimplexId* const later = &simplex + kAskedBefore;
        prefetch(facet_of_others.data() +
                 (later < simplices.data() + simplices.size() ? *later : simplex).value - in_place);
        facet_of_others[simplex.value - in_place] = id;
      }
    }
  });
}

void FacetClusters::release_lone_simplices(const SimplicialComplex& complex) {
  constexpr double kRounding = 1e-13;
  constexpr std::uint32_t kSeveral = kNone - 1;
  std::vector<std::uint32_t> only_row(count, kNone);
  for (std::uint32_t row = 0; row < cluster_of.size(); ++row)
    if (const std::uint32_t cluster = cluster_of[row]; cluster != kNone)
      only_row[cluster] = only_row[cluster] == kNone ? row : kSeveral;
  const auto is_lone = [&](std::uint32_t cluster) {
    if (only_row[cluster] == kSeveral || only_row[cluster] == kNone) return false;
    const double* const own = complex.plane(SimplexId{only_row[cluster]}).data();
    const double* const plane = planes.data() + std::size_t{cluster} * complex.rank;
    const double ratio = std::sqrt(std::inner_product(plane, plane + complex.rank, plane, 0.0) /
                                   std::inner_product(own, own + complex.rank, own, 0.0));
    double largest = 0.0, difference = 0.0;
    for (std::size_t k = 0; k < complex.rank; ++k) {
      largest = std::max(largest, std::abs(plane[k]));
      difference = std::max(difference, std::abs(plane[k] - ratio * own[k]));
    }
    return difference <= kRounding * largest;
  };
  std::vector<std::uint32_t> new_of(count, kNone);
  std::uint32_t kept = 0;
  for (std::uint32_t cluster = 0; cluster < count; ++cluster) {
    if (is_lone(cluster)) continue;
    std::copy_n(planes.data() + std::size_t{cluster} * complex.rank, complex.rank,
                planes.data() + std::size_t{kept} * complex.rank);
    new_of[cluster] = kept++;
  }
  planes.resize(std::size_t{kept} * complex.rank);
  count = kept;
  for (std::uint32_t& cluster : cluster_of)
    if (cluster != kNone) cluster = new_of[cluster];
}

std::vector<double> FacetClusters::planes_of(const SimplicialComplex& complex) const {
  std::vector<double> all(count * complex.rank);
  for (std::uint32_t cluster = 0; cluster < count; ++cluster)
    std::copy_n(plane_of(complex, cluster), complex.rank, all.data() + cluster * complex.rank);
  return all;
}

std::size_t FacetClusters::facets_of(std::size_t simplices_in_all) const {
  if (are_listed()) return begin.front() + count;
  const auto alone = std::count(cluster_of.begin(), cluster_of.end(), kNone);
  const std::size_t merged = cluster_of.size() - static_cast<std::size_t>(alone);
  return count + simplices_in_all - merged;
}

void FacetClusters::number_rows(std::size_t row_count) {
  cluster_of.assign(row_count, kNone);
  for (std::uint32_t cluster = 0; cluster < count; ++cluster)
    for (std::size_t i = begin[cluster]; i < begin[cluster + 1]; ++i)
      cluster_of[simplices[i].value] = cluster;
  simplices = {};
  begin = {};
}

void FacetClusters::move_rows(std::span<const RowMove> moves, std::size_t row_count) {
  if (count == 0) return;
  // The last rows go first.
  std::vector<std::uint32_t> new_of_last(moves.empty() ? 0 : moves.front().from - row_count + 1);
  for (const RowMove& one : moves) new_of_last[one.from - row_count] = one.to;
  const auto move = [&](std::uint32_t& row) {
    if (row >= row_count) row = new_of_last[row - row_count];
  };
  if (are_listed()) {
    for (SimplexId& simplex : simplices) move(simplex.value);
  } else {
    for (const RowMove& one : moves) cluster_of[one.to] = cluster_of[one.from];
    cluster_of.resize(row_count);
  }
  for (std::uint32_t& seed : seeds) move(seed);
}

ScaledFactor scale_factor(std::span<const double> gradient_factor) {
  ScaledFactor scaled{{gradient_factor.begin(), gradient_factor.end()}};
  double largest = 0.0;
  for (const double entry : gradient_factor) largest = std::max(largest, std::abs(entry));
  std::frexp(largest, &scaled.exponent);
  for (double& entry : scaled.factor) entry = std::ldexp(entry, -scaled.exponent);
  return scaled;
}

FacetLayout simplicial_layout(const SimplicialComplex& complex) {
  FacetLayout layout;
  layout.regular = layout.in_place = layout.simplicial = layout.facets = complex.row_count;
  layout.merged_begin.push_back(static_cast<std::uint32_t>(complex.row_count));
  layout.simplices.resize(complex.row_count);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) layout.simplices[row] = SimplexId{row};
  return layout;
}

FacetLayout lay_out(SimplicialComplex& complex, std::span<double> determinants, FacetClusters clusters,
                    std::span<const double> gradient_factor) {
  if (clusters.count == 0) return simplicial_layout(complex);
  const std::size_t rank = complex.rank;
  if (clusters.are_listed() && 2 * clusters.begin.front() > complex.row_count)
    clusters.number_rows(complex.row_count);
  const bool takes_lists = clusters.are_listed();
  const ClusterPlaces places = takes_lists ? ClusterPlaces() : find_places(clusters);
  const ScaledFactor scaled = scale_factor(gradient_factor);
  FacetLayout layout;
  layout.simplicial = takes_lists ? clusters.begin.front() : complex.row_count - places.merged_rows;
  layout.facets = layout.simplicial + clusters.count;
  layout.surface_exponent = scaled.exponent;
  if (2 * layout.simplicial <= complex.row_count) {
    layout.gradient_factor = scaled.factor;
    layout.planes = HugeArray<double>::to_write(layout.facets * rank);
    const auto cluster_at = [&](std::size_t merged) {
      return takes_lists ? static_cast<std::uint32_t>(merged) : places.cluster_at[merged];
    };
    if (takes_lists) {
      layout.simplices = std::move(clusters.simplices);
      layout.merged_begin = std::move(clusters.begin);
      take_facet_planes(complex, clusters, cluster_at, 0, layout.facets, layout);
      return layout;
    }
    do_beside(
        [&] {
          list_simplices(
              clusters, places, [](std::uint32_t row) { return row; }, layout);
        },
        [&] { take_facet_planes(complex, clusters, cluster_at, layout.simplicial, layout.facets, layout); });
    take_facet_planes(complex, clusters, cluster_at, 0, layout.simplicial, layout);
    return layout;
  }
  const RowKinds kinds = find_kinds(complex, clusters);
  layout.regular = kinds.count[kRegular];
  layout.in_place = layout.simplicial;
  const std::vector<std::uint32_t> old_of_new = row_order(kinds);
  MergedSums sums;
  do_beside(
      [&] {
        list_simplices(
            clusters, places, [&](std::uint32_t row) { return old_of_new[row]; }, layout);
      },
      [&] { sums = sum_merged(complex, determinants, clusters, places, scaled.factor); });
  layout.area_vectors = std::move(sums.area_vectors);
  layout.merged_surface = std::accumulate(sums.surface.begin(), sums.surface.end(), 0.0);
  const std::vector<double> planes = clusters.planes_of(complex);  // seeds are about to move
  const auto rows = std::span<const std::uint32_t>(old_of_new).first(layout.simplicial);
  take_rows({complex.planes.data(), complex.row_count * rank}, rank, rows);
  take_rows(determinants, 1, rows);
  // Merged facets are no more than their simplices: there is room.
  for (std::size_t m = 0; m < clusters.count; ++m) {
    const std::size_t row = layout.simplicial + m;
    determinants[row] = sums.determinants[m];
    std::copy_n(planes.data() + std::size_t{places.cluster_at[m]} * rank, rank,
                complex.planes.data() + row * rank);
  }
  permute_topology(complex, old_of_new, layout.facets);
  return layout;
}

}  // namespace ndhull
