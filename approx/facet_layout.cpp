#include "approx/facet_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

/// Simplices of merged facets, facet by facet, and those that have a ridge with one.
struct MergedRows {
  std::vector<std::uint32_t> merged, beside;
  std::vector<std::uint8_t> is_regular;      // per row
  std::vector<std::uint32_t> cluster_order;  // clusters in the order of their first simplex
  std::vector<std::uint32_t> end;            // of each one's simplices in `merged`
};

/// Looks at the neighbours of whatever is less, what is merged or what is not.
void find_rows_beside(const SimplicialComplex& complex, const FacetClusters& clusters,
                      std::size_t merged_count, MergedRows& rows) {
  const auto count = static_cast<std::uint32_t>(complex.row_count);
  const bool asks_merged = 2 * merged_count < count;
  for (std::uint32_t simplex = 0; simplex < count; ++simplex) {
    if ((clusters.cluster_of[simplex] != kNone) != asks_merged) continue;
    for (const SimplexId neighbour : complex.neighbours(SimplexId{simplex})) {
      if ((clusters.cluster_of[neighbour.value] != kNone) == asks_merged) continue;
      const std::uint32_t beside = asks_merged ? neighbour.value : simplex;
      if (rows.is_regular[beside]) rows.beside.push_back(beside);
      rows.is_regular[beside] = 0;
    }
  }
  std::sort(rows.beside.begin(), rows.beside.end());
}

MergedRows find_merged_rows(const SimplicialComplex& complex, const FacetClusters& clusters) {
  const auto count = static_cast<std::uint32_t>(complex.row_count);
  MergedRows rows;
  rows.is_regular.assign(count, 1);
  std::vector<std::uint32_t> place_of(clusters.count, kNone);
  std::size_t merged_count = 0;
  for (std::uint32_t simplex = 0; simplex < count; ++simplex) {
    const std::uint32_t cluster = clusters.cluster_of[simplex];
    if (cluster == kNone) continue;
    ++merged_count;
    rows.is_regular[simplex] = 0;
    if (place_of[cluster] == kNone) {
      place_of[cluster] = static_cast<std::uint32_t>(rows.cluster_order.size());
      rows.cluster_order.push_back(cluster);
      rows.end.push_back(0);
    }
    ++rows.end[place_of[cluster]];
  }
  find_rows_beside(complex, clusters, merged_count, rows);
  std::exclusive_scan(rows.end.begin(), rows.end.end(), rows.end.begin(), 0u);
  rows.merged.resize(merged_count);
  for (std::uint32_t simplex = 0; simplex < count; ++simplex) {
    const std::uint32_t cluster = clusters.cluster_of[simplex];
    if (cluster != kNone) rows.merged[rows.end[place_of[cluster]]++] = simplex;
  }
  return rows;
}

/// Regular rows behind the front part fill the places that others leave there.
std::vector<std::uint32_t> row_order(const MergedRows& rows, std::size_t regular) {
  std::vector<std::uint32_t> old_of_new(rows.is_regular.size());
  std::iota(old_of_new.begin(), old_of_new.end(), 0u);
  auto from = static_cast<std::uint32_t>(regular);
  for (std::uint32_t row = 0; row < regular; ++row) {
    if (rows.is_regular[row]) continue;
    while (!rows.is_regular[from]) ++from;
    old_of_new[row] = from++;
  }
  const auto tail = std::copy(rows.beside.begin(), rows.beside.end(),
                              old_of_new.begin() + static_cast<std::ptrdiff_t>(regular));
  std::copy(rows.merged.begin(), rows.merged.end(), tail);
  return old_of_new;
}

/// |R a|, R given by its columns: the sums of all rows side by side.
template <std::size_t D>
double gradient_length(const std::array<double, D * D>& columns, const double* plane) {
  std::array<double, D> sums{};
  for (std::size_t k = 0; k < D; ++k)
    for (std::size_t i = 0; i < D; ++i) sums[i] += columns[k * D + i] * plane[k];
  double length_sq = 0.0;
  for (const double entry : sums) length_sq += entry * entry;
  return std::sqrt(length_sq);
}

/// Sums over the simplices of each merged facet: determinants, those times the planes, and areas.
struct MergedSums {
  std::vector<double> determinants, area_vectors, surface;
};

/// As the rows stand in memory: within a facet that is the order of its simplices.
template <std::size_t D>
void sum_rows(const SimplicialComplex& complex, std::span<const double> determinants,
              std::span<const std::uint32_t> merged_of_row, std::span<const double> factor,
              MergedSums& sums) {
  std::array<double, D * D> columns;
  for (std::size_t k = 0; k < D; ++k)
    for (std::size_t i = 0; i < D; ++i) columns[k * D + i] = factor[i * D + k];
  for (std::uint32_t row = 0; row < complex.row_count; ++row) {
    const std::size_t m = merged_of_row[row];
    if (m == kNone) continue;
    const double* plane = complex.plane(SimplexId{row}).data();
    double* area_vector = sums.area_vectors.data() + m * D;
    for (std::size_t k = 0; k < D; ++k) area_vector[k] += determinants[row] * plane[k];
    sums.surface[m] += determinants[row] * gradient_length<D>(columns, plane);
    sums.determinants[m] += determinants[row];
  }
}

MergedSums sum_merged(const SimplicialComplex& complex, std::span<const double> determinants,
                      const FacetClusters& clusters, const MergedRows& rows, std::span<const double> factor) {
  std::vector<std::uint32_t> place_of(clusters.count), merged_of_row(complex.row_count, kNone);
  for (std::uint32_t m = 0; m < clusters.count; ++m) place_of[rows.cluster_order[m]] = m;
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    if (clusters.cluster_of[row] != kNone) merged_of_row[row] = place_of[clusters.cluster_of[row]];
  MergedSums sums;
  sums.determinants.resize(clusters.count);
  sums.surface.resize(clusters.count);
  sums.area_vectors.resize(clusters.count * complex.rank);
  call_with_dimension<1, kMaxRank>(
      complex.rank, [&](auto d) { sum_rows<d>(complex, determinants, merged_of_row, factor, sums); });
  return sums;
}

}  // namespace

FacetLayout simplicial_layout(const SimplicialComplex& complex) {
  FacetLayout layout;
  layout.regular = layout.simplicial = layout.facets = complex.row_count;
  layout.merged_begin.push_back(static_cast<std::uint32_t>(complex.row_count));
  return layout;
}

FacetLayout lay_out(SimplicialComplex& complex, std::span<double> determinants, const FacetClusters& clusters,
                    std::span<const double> gradient_factor) {
  if (clusters.count == 0) return simplicial_layout(complex);
  const std::size_t rank = complex.rank;
  const MergedRows rows = find_merged_rows(complex, clusters);
  FacetLayout layout;
  layout.simplicial = complex.row_count - rows.merged.size();
  layout.regular = layout.simplicial - rows.beside.size();
  layout.facets = layout.simplicial + clusters.count;
  const std::vector<std::uint32_t> old_of_new = row_order(rows, layout.regular);

  layout.facet_of_merged.reserve(rows.merged.size());
  layout.merged_begin.push_back(static_cast<std::uint32_t>(layout.simplicial));
  for (std::size_t m = 0, i = 0; m < clusters.count; ++m) {
    layout.facet_of_merged.insert(layout.facet_of_merged.end(), rows.end[m] - i,
                                  FacetId{static_cast<std::uint32_t>(layout.simplicial + m)});
    i = rows.end[m];
    layout.merged_begin.push_back(static_cast<std::uint32_t>(layout.simplicial + i));
  }
  MergedSums sums = sum_merged(complex, determinants, clusters, rows, gradient_factor);
  layout.area_vectors = std::move(sums.area_vectors);
  layout.merged_surface = std::accumulate(sums.surface.begin(), sums.surface.end(), 0.0);
  const std::span<const std::uint32_t> alone = std::span(old_of_new).first(layout.simplicial);
  take_rows({complex.planes.data(), complex.row_count * rank}, rank, alone);
  take_rows(determinants, 1, alone);
  // Merged facets are no more than their simplices: there is room.
  for (std::size_t m = 0; m < clusters.count; ++m) {
    const std::size_t row = layout.simplicial + m;
    determinants[row] = sums.determinants[m];
    std::copy_n(clusters.planes.data() + std::size_t{rows.cluster_order[m]} * rank, rank,
                complex.planes.data() + row * rank);
  }
  permute_topology(complex, old_of_new, layout.facets);
  return layout;
}

}  // namespace ndhull
