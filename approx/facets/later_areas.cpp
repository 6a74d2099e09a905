#include "approx/facets/later_areas.h"

#include <algorithm>
#include <array>
#include <vector>

#include "approx/geometry/gradient_length.h"
#include "approx/geometry/measure_scale.h"
#include "core/dimension_switch.h"
#include "core/machine/arena.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {

LaterAreas::Totals LaterAreas::totals(const FacetLayout& layout) const {
  constexpr std::size_t kSimplicesInBlock = 4096;
  const std::size_t count = layout.simplices.size();
  std::vector<Totals> parts((count + kSimplicesInBlock - 1) / kSimplicesInBlock);
  call_with_dimension<1, kMaxRank>(scale_->rank(), [&]<class Rank>(Rank d) {
    const GradientLength<Rank::value> length_of(layout.gradient_factor);
    for_each_block(count, kSimplicesInBlock, [&](std::size_t begin, std::size_t end) {
      Totals part;
      for (std::size_t row = begin; row < end; ++row) {
        part.volume += determinants_[row];
        part.surface += determinants_[row] * length_of(planes_.data() + row * d);
      }
      parts[begin / kSimplicesInBlock] = part;
    });
  });
  Totals all;
  for (const Totals& part : parts) {  // in the order of the blocks
    all.volume += part.volume;
    all.surface += part.surface;
  }
  return {all.volume * scale_->volume_per_determinant(),
          scale_->surface(all.surface, layout.surface_exponent)};
}

std::span<const double> LaterAreas::of_facets(const FacetLayout& layout, const double* normals) const {
  call_once_isolated(is_made_, [&] { make(layout, normals); });
  return {areas_.data(), layout.facets};
}

void LaterAreas::make(const FacetLayout& layout, const double* normals) const {
  constexpr std::size_t kFacetsInBlock = 64, kAhead = 24;  // simplices whose way from memory has begun
  const std::size_t rank = scale_->rank(), dimension = scale_->dimension();
  for_each_block(layout.facets, kFacetsInBlock, [&](std::size_t begin, std::size_t end) {
    std::array<double, kFacetsInBlock * kMaxRank> area_vectors{};
    double* sum = area_vectors.data();
    for (std::size_t facet = begin; facet < end; ++facet, sum += rank) {
      const std::span<const SimplexId> simplices =
          layout.simplices_of(FacetId{static_cast<std::uint32_t>(facet)});
      const auto first = static_cast<std::size_t>(simplices.data() - layout.simplices.data());
      for (std::size_t i = 0; i < simplices.size(); ++i) {
        const SimplexId later = layout.simplices[std::min(first + i + kAhead, layout.simplices.size() - 1)];
        prefetch(planes_.data() + later.value * rank, rank);
        prefetch(determinants_.data() + later.value);
        const double determinant = determinants_[simplices[i].value];
        const double* const plane = planes_.data() + simplices[i].value * rank;
        for (std::size_t k = 0; k < rank; ++k) sum[k] += determinant * plane[k];
      }
    }
    scale_->project_areas({area_vectors.data(), sum}, normals + begin * dimension, areas_.data() + begin);
  });
  planes_ = HugeArray<double>();
  determinants_ = HugeArray<double>();
}

}  // namespace ndhull
