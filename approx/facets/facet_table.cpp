#include "approx/facets/facet_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "approx/facets/highest_points.h"
#include "approx/facets/listed_facets.h"
#include "approx/geometry/measure_scale.h"
#include "core/dimension_switch.h"
#include "core/id_rows.h"
#include "core/machine/blocks.h"
#include "core/search/highest_dots.h"
#include "core/search/plane_kernels.h"

namespace ndhull {
namespace {

/// Sets entries of a merged facet's plane to 0 that are rounding of its fit. In the frame all axes are
/// alike; on long ones such entries would look like a tilt, and six sides of a box would seem to bound a
/// region in 4-d.
void drop_rounding(std::span<double> plane) {
  constexpr double kRounding = 8.0 * 0x1p-52;
  double largest = 0.0;
  for (const double entry : plane) largest = std::max(largest, std::abs(entry));
  for (double& entry : plane)
    if (std::abs(entry) < kRounding * largest) entry = 0.0;
}

/// How far from the frame's centre a ball of the frame around it reaches along a normal: no covered point
/// reaches further. Where the frame's map has cancellation, or nothing is covered: infinitely far.
double support_of_ball(const Frame& frame, std::span<const double> normal, const CoveredPoints& covered) {
  if (covered.gauge == 0.0 || !frame.is_diagonal || frame.rank != frame.dimension) return HUGE_VAL;
  double length_sq = 0.0;
  for (std::size_t k = 0; k < normal.size(); ++k) {
    const double part = normal[k] / frame.map[k * frame.dimension + k];
    length_sq += part * part;
  }
  return covered.reach * std::sqrt(length_sq) * (1.0 + 1e-13);  // rounding of some dimension + 4 operations
}

/// What is summed up over the facets of one block.
struct FacetSums {
  double max_outer = 0.0, min_inner = 0.0, max_width = 0.0, roundoff = 0.0, volume = 0.0, area = 0.0;
};

/// All facets of one hull: the loops that need each row once share it while it is in cache.
class TableMaker {
 public:
  TableMaker(SimplicialComplex& complex, FacetLayout& layout, const Frame& frame,
             const CertificatePoints& points, HugeArray<double> determinants, const LengthUnit& unit,
             const CoveredPoints& covered, const KnownHighest& known, bool certifies,
             const IdRows* merged_vertices)
      : complex_(complex),
        layout_(layout),
        frame_(frame),
        points_(points),
        unit_(unit),
        covered_(covered),
        known_(known),
        certifies_(certifies),
        merged_vertices_(merged_vertices),
        dimension_(frame.dimension),
        count_(layout.facets),
        scale_(std::make_shared<const MeasureScale>(frame)) {
    if (layout.planes.data() != nullptr) {
      planes_ = std::move(layout.planes);
      simplex_planes_ = std::move(complex.planes);
      simplex_determinants_ = std::move(determinants);
      table_.offsets = HugeArray<double>::to_write(count_);
    } else {
      planes_ = std::move(complex.planes);
      determinants.discard_from(count_);
      table_.offsets = std::move(determinants);
    }
  }

  FacetTable run() {
    allocate();
    const bool has_listed = layout_.in_place < count_;
    close_.resize(count_ - layout_.in_place);
    if (has_listed || searches_many_points()) {
      for_each_block(count_, kFacetsInBlock,
                     [&](std::size_t begin, std::size_t end) { begin_block(begin, end); });
      find_own_dots(complex_, layout_, merged_vertices_, points_, table_.normals.data(),
                    {low(0, count_), high(0, count_), close_});
      if (searches_many_points())
        find_highest_of_many(
            complex_, layout_, points_,
            {normals(0, count_), low(0, count_), high(0, count_), close_, highest(0, count_)});
      for_each_block(count_, kFacetsInBlock,
                     [&](std::size_t begin, std::size_t end) { end_block(begin, end); });
    } else {
      for_each_block(count_, kFacetsInBlock, [&](std::size_t begin, std::size_t end) {
        begin_block(begin, end);
        end_block(begin, end);
      });
    }
    planes_ = HugeArray<double>();
    complex_.planes = HugeArray<double>();
    sum_up();
    return std::move(table_);
  }

 private:
  static constexpr std::size_t kFacetsInBlock = 4096;
  static constexpr std::size_t kFewFacets = 256;  // grouping the points costs more than it saves

  // Until a block is finished its rows hold what the offsets are made of: the smallest and the largest
  // product with the facet's own vertices, the largest with any point, and the determinants.
  std::span<double> low(std::size_t begin, std::size_t end) {
    return {table_.inner.data() + begin, end - begin};
  }
  std::span<double> high(std::size_t begin, std::size_t end) {
    return {table_.areas.data() + begin, end - begin};
  }
  std::span<double> highest(std::size_t begin, std::size_t end) {
    return {table_.outer.data() + begin, end - begin};
  }
  std::span<const double> normals(std::size_t begin, std::size_t end) const {
    return {table_.normals.data() + begin * dimension_, (end - begin) * dimension_};
  }

  void allocate() {
    if (frame_.rank == dimension_) {
      table_.normals = std::move(planes_);
      table_.normals.discard_from(count_ * dimension_);
    } else {
      table_.normals = HugeArray<double>::to_write(count_ * dimension_);
    }
    table_.outer = HugeArray<double>::to_write(count_);
    table_.inner = HugeArray<double>::to_write(count_);
    table_.areas = HugeArray<double>::to_write(count_);
    parts_.resize((count_ + kFacetsInBlock - 1) / kFacetsInBlock);
    if (certifies_ && known_.highest.empty() && !searches_many_points())
      groups_.emplace(dimension_, points_.rows, count_ < kFewFacets);
  }

  bool searches_many_points() const {
    return certifies_ && known_.highest.empty() && count_ >= kFewFacets &&
           are_many_points(dimension_, points_.rows.size() / dimension_, count_);
  }

  void begin_block(std::size_t begin, std::size_t end) {
    double* const planes =
        (frame_.rank == dimension_ ? table_.normals : planes_).data() + begin * frame_.rank;
    for (std::size_t facet = std::max(begin, layout_.simplicial); facet < end; ++facet)
      drop_rounding({planes + (facet - begin) * frame_.rank, frame_.rank});
    scale_->to_input().map(planes, end - begin, table_.normals.data() + begin * dimension_);
    end = std::min(end, layout_.in_place);
    if (begin >= end) return;
    own_dots(complex_, begin, dimension_, normals(begin, end), points_.rows, points_.row_of_point,
             low(begin, end), high(begin, end));
  }

  void end_block(std::size_t begin, std::size_t end) {
    if (!certifies_) {
      std::fill_n(table_.outer.data() + begin, end - begin, HUGE_VAL);
    } else if (!known_.highest.empty()) {
      take_known(begin, end);
    } else if (groups_) {
      const std::size_t in_place = std::clamp(layout_.in_place, begin, end);
      search_groups(begin, in_place, frame_.rank, {});
      search_groups(in_place, end, 0,
                    in_place == end ? std::span<const std::uint32_t>()
                                    : std::span<const std::uint32_t>(close_).subspan(
                                          in_place - layout_.in_place, end - in_place));
    }
    finish(begin, end, parts_[begin / kFacetsInBlock]);
  }

  /// `own_count`: vertices of each facet; 0: they differ.
  void search_groups(std::size_t begin, std::size_t end, std::size_t own_count,
                     std::span<const std::uint32_t> close) {
    if (begin == end) return;
    highest_dots(*groups_, normals(begin, end), {low(begin, end), high(begin, end), own_count, close},
                 highest(begin, end));
  }

  /// What is known, raised by what a normal that differs from the one it is known for can change.
  void take_known(std::size_t begin, std::size_t end) {
    constexpr double kRoundedUp = 1.0 + 1e-14;
    for (std::size_t facet = begin; facet < end; ++facet) {
      double change = 0.0;
      for (std::size_t k = 0; k < dimension_; ++k) {
        const std::size_t at = facet * dimension_ + k;
        change += std::abs(table_.normals[at] - known_.normals[at]) * points_.largest[k];
      }
      table_.outer[facet] = std::max(table_.areas[facet], known_.highest[facet] + change * kRoundedUp);
    }
  }

  void finish(std::size_t begin, std::size_t end, FacetSums& part) {
    // One subtraction for each coordinate, dimension products, one sum with the offset, one spare.
    const double error_per_size = sum_error(dimension_ + 3, 1.0);
    for (std::size_t facet = begin; facet < end; ++facet) {
      const std::span<const double> normal = normals(facet, facet + 1);
      const double lowest = table_.inner[facet], own_highest = table_.areas[facet];
      const double all_highest = table_.outer[facet], determinant = table_.offsets[facet];
      double offset = -(0.5 * lowest + 0.5 * own_highest);
      double centre = 0.0, size = 0.0, size_input = 0.0;
      for (std::size_t k = 0; k < dimension_; ++k) {
        centre += normal[k] * (frame_.centre[k] - points_.reference[k]);
        size += std::abs(normal[k]) * points_.largest[k];
        size_input += std::abs(normal[k]) * points_.largest_input[k];
      }
      // The plane midway of a very wide facet may pass below the interior point; the supporting one never
      // does.
      if (-offset <= centre) offset = -(certifies_ ? std::max(own_highest, all_highest) : own_highest);
      const double height = -offset - centre;
      size += std::abs(offset);
      size_input += std::abs(offset);
      const double error = error_per_size * size;
      const double per_unit = 1.0 / unit_.input_per_unit(normal);
      const double outer_explicit = std::max(0.0, all_highest + offset + error);
      const double of_scaled_hull = (1.0 + covered_.gauge) * outer_explicit + covered_.gauge * height;
      const double of_ball =
          std::max(outer_explicit, support_of_ball(frame_, normal, covered_) - height + error);
      const double outer = std::min(of_scaled_hull, of_ball) * per_unit;
      const double inner = std::min(0.0, lowest + offset - error) * per_unit;
      table_.offsets[facet] = offset;
      table_.outer[facet] = outer;
      table_.inner[facet] = inner;
      part.max_outer = std::max(part.max_outer, outer);
      part.min_inner = std::min(part.min_inner, inner);
      part.max_width = std::max(part.max_width, outer - inner);
      part.roundoff = std::max(part.roundoff, error_per_size * (size + size_input) * per_unit);

      const double cone = determinant * scale_->volume_per_determinant();
      part.volume += cone;
      if (facet >= layout_.simplicial) continue;
      // A simplex without volume may have no height either.
      table_.areas[facet] =
          cone > 0.0 ? scale_->to_input_size(static_cast<double>(frame_.rank) * cone / height) : 0.0;
      part.area += table_.areas[facet];
    }
  }

  void sum_up() {
    // In the order of the blocks.
    for (const FacetSums& part : parts_) {
      table_.max_outer = std::max(table_.max_outer, part.max_outer);
      table_.min_inner = std::min(table_.min_inner, part.min_inner);
      table_.max_width = std::max(table_.max_width, part.max_width);
      table_.roundoff = std::max(table_.roundoff, part.roundoff);
      table_.volume += part.volume;
      table_.area += part.area;
    }
    if (simplex_planes_.data() != nullptr) {
      table_.later_areas = std::make_unique<LaterAreas>(
          scale_, std::move(simplex_planes_), std::move(simplex_determinants_), std::move(table_.areas));
      const LaterAreas::Totals totals = table_.later_areas->totals(layout_);
      table_.volume = totals.volume;
      table_.surface = totals.surface;
    } else {
      table_.surface = table_.area + scale_->surface(layout_.merged_surface, layout_.surface_exponent);
      const std::size_t first = layout_.simplicial;
      for_each_block(count_ - first, kFacetsInBlock, [&](std::size_t begin, std::size_t end) {
        scale_->project_areas(
            std::span(layout_.area_vectors).subspan(begin * frame_.rank, (end - begin) * frame_.rank),
            normals(first + begin, first + end).data(), table_.areas.data() + first + begin);
      });
      for (std::size_t facet = first; facet < count_; ++facet) table_.area += table_.areas[facet];
    }
    table_.volume = std::ldexp(table_.volume, scale_->volume_exponent());
  }

  SimplicialComplex& complex_;
  FacetLayout& layout_;
  const Frame& frame_;
  const CertificatePoints& points_;
  const LengthUnit& unit_;
  const CoveredPoints& covered_;
  const KnownHighest& known_;
  bool certifies_;
  const IdRows* merged_vertices_;
  std::size_t dimension_, count_;
  std::shared_ptr<const MeasureScale> scale_;
  std::optional<PointGroups> groups_;
  std::vector<std::uint32_t> close_;  // of facets in_place and on: own vertices about as high as the highest
  std::vector<FacetSums> parts_;
  HugeArray<double> planes_;                                 // of the facets
  HugeArray<double> simplex_planes_, simplex_determinants_;  // where areas are sums over simplices
  FacetTable table_;
};

}  // namespace

double FacetTable::area_of_facets(const FacetLayout& layout) const {
  if (!later_areas) return area;
  const std::span<const double> made = later_areas->of_facets(layout, normals.data());
  return std::accumulate(made.begin(), made.end(), 0.0);
}

FacetTable make_facet_table(SimplicialComplex& complex, FacetLayout& layout, const Frame& frame,
                            const CertificatePoints& points, HugeArray<double> determinants,
                            const LengthUnit& unit, const CoveredPoints& covered, const KnownHighest& known,
                            bool certifies, const IdRows* merged_vertices) {
  return TableMaker(complex, layout, frame, points, std::move(determinants), unit, covered, known, certifies,
                    merged_vertices)
      .run();
}

}  // namespace ndhull
