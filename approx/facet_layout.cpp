#include "approx/facet_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "approx/gradient_length.h"
#include "core/dimension_switch.h"
#include "core/ids.h"

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

/// Looks at the neighbours of what is merged, where that is less than half.
RowKinds find_kinds(const SimplicialComplex& complex, const FacetClusters& clusters) {
  const auto count = static_cast<std::uint32_t>(complex.row_count);
  RowKinds kinds;
  kinds.of_row.resize(count);
  for (std::uint32_t row = 0; row < count; ++row) {
    const bool is_merged = clusters.cluster_of[row] != kNone;
    kinds.of_row[row] = is_merged ? kMerged : kRegular;
    kinds.count[kMerged] += is_merged ? 1u : 0u;
  }
  const std::size_t alone = count - kinds.count[kMerged];
  if (kinds.count[kMerged] >= alone) {  // hardly any is beside none
    std::ranges::replace(kinds.of_row, kRegular, kBeside);
    kinds.count[kBeside] = alone;
    return kinds;
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
  kinds.count[kRegular] = alone - kinds.count[kBeside];
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
  }
  return places;
}

/// Fills the tables of merged facets.
void list_simplices(const FacetClusters& clusters, const ClusterPlaces& places,
                    std::span<const std::uint32_t> old_of_new, FacetLayout& layout) {
  const auto simplicial = static_cast<std::uint32_t>(layout.simplicial);
  std::vector<std::uint32_t> next(clusters.count);
  std::exclusive_scan(places.size.begin(), places.size.end(), next.begin(), simplicial);
  layout.merged_begin = next;
  layout.merged_begin.push_back(static_cast<std::uint32_t>(old_of_new.size()));
  layout.simplices.resize(old_of_new.size());
  layout.facet_of_merged.resize(old_of_new.size() - simplicial);
  for (std::uint32_t row = 0; row < simplicial; ++row) layout.simplices[row] = SimplexId{row};
  for (std::uint32_t row = simplicial; row < old_of_new.size(); ++row) {
    const std::uint32_t place = places.place_of[clusters.cluster_of[old_of_new[row]]];
    layout.simplices[next[place]++] = SimplexId{row};
    layout.facet_of_merged[row - simplicial] = FacetId{simplicial + place};
  }
}

/// Sums over the simplices of each merged facet: determinants, those times the planes, and areas.
struct MergedSums {
  std::vector<double> determinants, area_vectors, surface;
};

/// As the rows stand in memory.
template <std::size_t D>
void sum_rows(const SimplicialComplex& complex, std::span<const double> determinants,
              const FacetClusters& clusters, const ClusterPlaces& places, std::span<const double> factor,
              MergedSums& sums) {
  const GradientLength<D> length_of(factor);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    if (clusters.cluster_of[row] == kNone) continue;
    const std::size_t m = places.place_of[clusters.cluster_of[row]];
    const double* plane = complex.plane(SimplexId{row}).data();
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

}  // namespace

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
  layout.regular = layout.simplicial = layout.facets = complex.row_count;
  layout.merged_begin.push_back(static_cast<std::uint32_t>(complex.row_count));
  layout.simplices.resize(complex.row_count);
  for (std::uint32_t row = 0; row < complex.row_count; ++row) layout.simplices[row] = SimplexId{row};
  return layout;
}

FacetLayout lay_out(SimplicialComplex& complex, std::span<double> determinants, const FacetClusters& clusters,
                    std::span<const double> gradient_factor) {
  if (clusters.count == 0) return simplicial_layout(complex);
  const std::size_t rank = complex.rank;
  const RowKinds kinds = find_kinds(complex, clusters);
  const ClusterPlaces places = find_places(clusters);
  FacetLayout layout;
  layout.regular = kinds.count[kRegular];
  layout.simplicial = layout.regular + kinds.count[kBeside];
  layout.facets = layout.simplicial + clusters.count;
  const std::vector<std::uint32_t> old_of_new = row_order(kinds);
  list_simplices(clusters, places, old_of_new, layout);
  const ScaledFactor scaled = scale_factor(gradient_factor);
  layout.surface_exponent = scaled.exponent;
  MergedSums sums = sum_merged(complex, determinants, clusters, places, scaled.factor);
  layout.area_vectors = std::move(sums.area_vectors);
  layout.merged_surface = std::accumulate(sums.surface.begin(), sums.surface.end(), 0.0);
  const std::span<const std::uint32_t> alone = std::span(old_of_new).first(layout.simplicial);
  take_rows({complex.planes.data(), complex.row_count * rank}, rank, alone);
  take_rows(determinants, 1, alone);
  // Merged facets are no more than their simplices: there is room.
  for (std::size_t m = 0; m < clusters.count; ++m) {
    const std::size_t row = layout.simplicial + m;
    determinants[row] = sums.determinants[m];
    std::copy_n(clusters.planes.data() + std::size_t{places.cluster_at[m]} * rank, rank,
                complex.planes.data() + row * rank);
  }
  permute_topology(complex, old_of_new, layout.facets);
  return layout;
}

}  // namespace ndhull
