#include "approx/facet_layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ndhull {
namespace {

constexpr std::uint32_t kNone = FacetId::kNone;

void permute_values(std::span<double> values, std::span<const std::uint32_t> old_of_new) {
  const std::vector<double> old(values.begin(), values.end());
  for (std::size_t row = 0; row < old_of_new.size(); ++row) values[row] = old[old_of_new[row]];
}

/// Simplices of merged facets, facet by facet, and those that have a ridge with one.
struct MergedRows {
  std::vector<std::uint32_t> merged, beside;
  std::vector<std::uint8_t> is_regular;      // per row
  std::vector<std::uint32_t> cluster_order;  // clusters in the order of their first simplex
};

MergedRows find_merged_rows(const SimplicialComplex& complex, const FacetClusters& clusters) {
  const auto count = static_cast<std::uint32_t>(complex.row_count);
  MergedRows rows;
  rows.is_regular.assign(count, 1);
  std::vector<std::uint32_t> place_of(clusters.count, kNone);
  std::vector<std::uint32_t> begin;  // of each cluster's simplices, in that order
  std::size_t merged_count = 0;
  for (std::uint32_t simplex = 0; simplex < count; ++simplex) {
    const std::uint32_t cluster = clusters.cluster_of[simplex];
    if (cluster == kNone) continue;
    ++merged_count;
    rows.is_regular[simplex] = 0;
    if (place_of[cluster] == kNone) {
      place_of[cluster] = static_cast<std::uint32_t>(rows.cluster_order.size());
      rows.cluster_order.push_back(cluster);
      begin.push_back(0);
    }
    ++begin[place_of[cluster]];
    for (const SimplexId neighbour : complex.neighbours(SimplexId{simplex})) {
      if (clusters.cluster_of[neighbour.value] != kNone || !rows.is_regular[neighbour.value]) continue;
      rows.is_regular[neighbour.value] = 0;
      rows.beside.push_back(neighbour.value);
    }
  }
  std::sort(rows.beside.begin(), rows.beside.end());
  std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
  rows.merged.resize(merged_count);
  for (std::uint32_t simplex = 0; simplex < count; ++simplex) {
    const std::uint32_t cluster = clusters.cluster_of[simplex];
    if (cluster != kNone) rows.merged[begin[place_of[cluster]]++] = simplex;
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

double gradient_length(std::span<const double> factor, std::span<const double> plane) {
  double length_sq = 0.0;
  for (std::size_t i = 0; i < plane.size(); ++i) {
    double entry = 0.0;
    for (std::size_t k = 0; k < plane.size(); ++k) entry += factor[i * plane.size() + k] * plane[k];
    length_sq += entry * entry;
  }
  return std::sqrt(length_sq);
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
  permute_rows(complex, old_of_new);
  permute_values(determinants, old_of_new);

  layout.area_vectors.assign(clusters.count * rank, 0.0);
  std::uint32_t facet = 0;
  layout.merged_begin.push_back(static_cast<std::uint32_t>(layout.simplicial));
  for (std::size_t i = 0; i < rows.merged.size(); ++i) {
    const std::size_t row = layout.simplicial + i;
    const auto plane = complex.plane(SimplexId{static_cast<std::uint32_t>(row)});
    for (std::size_t k = 0; k < rank; ++k)
      layout.area_vectors[facet * rank + k] += determinants[row] * plane[k];
    layout.merged_surface += determinants[row] * gradient_length(gradient_factor, plane);
    layout.facet_of_merged.push_back(FacetId{static_cast<std::uint32_t>(layout.simplicial) + facet});
    const bool is_last = i + 1 == rows.merged.size() ||
                         clusters.cluster_of[rows.merged[i + 1]] != clusters.cluster_of[rows.merged[i]];
    if (!is_last) continue;
    layout.merged_begin.push_back(static_cast<std::uint32_t>(row + 1));
    ++facet;
  }
  // A merged facet's row is never behind its first simplex: planes and sums can be put in place.
  for (std::size_t m = 0; m < clusters.count; ++m) {
    const std::size_t row = layout.simplicial + m;
    double sum = 0.0;
    for (std::size_t i = layout.merged_begin[m]; i < layout.merged_begin[m + 1]; ++i) sum += determinants[i];
    determinants[row] = sum;
    std::copy_n(clusters.planes.data() + std::size_t{rows.cluster_order[m]} * rank, rank,
                complex.planes.data() + row * rank);
  }
  return layout;
}

}  // namespace ndhull
