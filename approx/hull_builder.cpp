#include "approx/hull_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "approx/exact_instead.h"
#include "approx/facets/coplanar_merge.h"
#include "approx/facets/described_hull.h"
#include "approx/facets/exact_facets.h"
#include "approx/facets/facet_layout.h"
#include "approx/facets/facet_table.h"
#include "approx/facets/pulled_simplices.h"
#include "approx/facets/regrown_simplices.h"
#include "approx/geometry/frame_planes.h"
#include "approx/growth/certified_growth.h"
#include "approx/selection/volume_cover.h"
#include "approx/trade/approximation.h"
#include "core/error.h"
#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/machine/stopwatch.h"

namespace ndhull {

/// One run: the tables that its steps hand on.
class HullBuilder {
 public:
  HullBuilder(const PointView& points, const HullOptions& options, Clock::time_point start,
              double input_bytes, bool has_run_out_before = false)
      : points_(points),
        options_(options),
        start_(start),
        input_bytes_(input_bytes),
        has_run_out_before_(has_run_out_before) {}

  /// The hull of some of the points in terms of all of them: point i of it is ids[i].
  static void rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count) {
    hull.point_count = point_count;
    for (PointId& vertex : hull.vertices) vertex.value = ids[vertex.value];
    if (hull.later_) {
      hull.later_->rename_points(ids);
      for (std::uint32_t& id : hull.lists_->lists.vertices.values) id = ids[id];
      return;
    }
    hull.lists_ = std::make_unique<Hull::Lists>();  // of the points as they are called now
    const std::size_t rank = hull.simplices_.rank;
    for (std::size_t row = 0; row < hull.simplices_.row_count; ++row) {
      std::uint32_t* vertices = hull.simplices_.topology.data() + row * 2 * rank;
      for (std::size_t k = 0; k < rank; ++k) vertices[k] = ids[vertices[k]];
    }
  }

  Hull run(BegunHull* begun = nullptr) {
    frame_ = begun != nullptr ? std::move(begun->frame) : fit_frame(points_);
    check_extents(frame_);
    if (frame_.rank > kMaxRank) {
      throw Error(ErrorCode::kDimensionTooHigh, "points span " + std::to_string(frame_.rank) +
                                                    " dimensions, expected at most " +
                                                    std::to_string(kMaxRank) + "; project them to fewer");
    }
    describe_input();
    if (frame_.rank == 0) return std::move(hull_);
    const Accuracy& accuracy = options_.accuracy;
    check_facet_target(accuracy, frame_.rank);
    const ResolvedAccuracy lengths = resolve(accuracy, frame_, hull_.length_unit_);
    hull_.chosen.width_asked = lengths.width_asked();
    const Accuracy kept = above_rounding(accuracy, lengths, options_.shift);
    if (kept.width.is_set() != accuracy.width.is_set() ||
        kept.outside_width.is_set() != accuracy.outside_width.is_set())
      return with(kept, lengths, options_.limits.max_facets);
    const bool is_exact = accuracy.is_exact() || accuracy.is_for_volume() || frame_.rank == 1;
    std::vector<double> factor;
    if (!is_exact) factor = gradient_factor(frame_, hull_.length_unit_);
    growth_.emplace(points_, frame_, factor, options_, start_, hull_);
    if (begun != nullptr) growth_->go_on_from(std::move(*begun));
    if (frame_.rank == 1) {
      complex() = make_segment(growth_->coordinates(), points_.rows);  // without growth
      growth_->want_all();
    } else if (is_exact) {
      if (grow_or_describe()) return std::move(hull_);
      if (growth_->is_too_rough()) return with_larger_shift();
      if (hull_.status != HullStatus::kComplete && !options_.wants_partial) return std::move(hull_);
    } else {
      const bool has_room = approximate(factor);
      if (growth_->is_too_rough()) return with_larger_shift();
      if (!has_room) return again(options_, true);  // may end as before
      if (star_hull_) {
        adopt(std::move(*star_hull_));
        return std::move(hull_);
      }
    }
    const Clock::time_point merge_start = Clock::now();
    KnownHighest known = growth_->take_known_highest();
    const std::vector<RowMove> moves = compact(complex());
    clusters_.move_rows(moves, complex().row_count);
    for (const RowMove& move : moves) {
      if (determinants_.data() != nullptr) determinants_[move.to] = determinants_[move.from];
      if (known.highest.empty()) continue;
      known.highest[move.to] = known.highest[move.from];
      std::copy_n(known.normals.data() + move.from * frame_.dimension, frame_.dimension,
                  known.normals.data() + move.to * frame_.dimension);
    }
    merge();
    if (!is_bounded_) return for_width_instead();
    if (hull_.layout_.simplicial < hull_.layout_.facets) known = {};  // facets are no longer the rows
    make_facets(known);
    seconds(Phase::kMerge) += seconds_since(merge_start);
    if (const auto most = simplices_of_exact(hull_, growth_->work(), options_, lengths)) {
      Hull exact = with(Accuracy(), lengths, *most);
      if (is_exact_better(exact, hull_, accuracy, lengths)) return exact;
    }
    return std::move(hull_);
  }

 private:
  SimplicialComplex& complex() { return growth_->work().complex; }
  double& seconds(Phase phase) { return hull_.statistics.seconds[static_cast<std::size_t>(phase)]; }
  void detail(std::string_view name, Clock::time_point since) {
    hull_.statistics.detail_seconds.emplace_back(name, seconds_since(since));
  }

  void describe_input() {
    hull_.dimension = frame_.dimension;
    hull_.rank = frame_.rank;
    hull_.point_count = points_.rows;
    hull_.interior_point = frame_.centre;
    hull_.reference = frame_.centre;
    hull_.length_unit_ = LengthUnit(frame_, options_.unit_cube);
    hull_.chosen.objective = options_.accuracy.objective;
    if (frame_.rank == 0) hull_.vertices.push_back(PointId{0});
    hull_.subspace_equations = find_subspace_equations(frame_);
  }

  /// Grows as far as the accuracy asks for and finds the facets. False: memory has ended growth, and without
  /// the complex there is room for rows of vertices.
  bool approximate(const std::vector<double>& factor) {
    const Clock::time_point begin = Clock::now();
    const ResolvedAccuracy lengths = resolve(options_.accuracy, frame_, hull_.length_unit_);
    check_depths(options_.accuracy, lengths);
    check_squares(lengths.largest_extent);
    Approximation approximation(frame_, options_.accuracy, lengths, factor, *growth_, hull_, input_bytes_,
                                has_run_out_before_);
    clusters_ = approximation.run();
    star_hull_ = std::move(approximation.star_hull());
    determinants_ = approximation.take_determinants();
    seconds(Phase::kMerge) += seconds_since(begin) - seconds(Phase::kGrowth) - seconds(Phase::kCertify);
    return hull_.status != HullStatus::kMemoryLimit || has_run_out_before_ ||
           !approximation.may_do_without_complex();
  }

  void merge() {
    const std::vector<std::uint8_t> is_shifted = find_shifted(growth_->work());
    hull_.is_approximate = clusters_.count > 0;
    // Those that merging has asked for have fewer digits than exact hulls promise.
    if (determinants_.data() == nullptr || !hull_.is_approximate) find_determinants(is_shifted);
    const std::span<double> determinants(determinants_.data(), complex().row_count);
    const Clock::time_point merge_start = Clock::now();
    // Without a shifted point every decision was clearer than the shift: all ridges are convex. Who asks for
    // a number of facets gets no simplices instead.
    const bool may_merge = !options_.triangulate || options_.accuracy.facets > 0;
    if (!hull_.is_approximate && !is_shifted.empty() && may_merge) {
      clusters_ = merge_coplanar(complex(), growth_->coordinates(), is_shifted, determinants,
                                 kShiftsInPlane * growth_->work().options.shift, growth_->end_of_merging());
      growth_->note_end(clusters_.is_cut_short);
    }
    if (options_.accuracy.is_for_volume() && frame_.rank >= 2) choose_for_volume(determinants);
    hull_.layout_ =
        lay_out(complex(), determinants, std::move(clusters_), gradient_factor(frame_, LengthUnit()));
    detail("coplanar merging", merge_start);
  }

  void find_determinants(std::span<const std::uint8_t> is_shifted) {
    const Clock::time_point start = Clock::now();
    determinants_ = HugeArray<double>::to_write(complex().row_count);
    const std::span<double> found(determinants_.data(), complex().row_count);
    const bool keeps_planes = hull_.is_approximate && is_shifted.empty();
    if (keeps_planes) find_outwards(complex(), growth_->coordinates(), found);
    if (!keeps_planes) solve_outwards(complex(), growth_->coordinates(), is_shifted, found);
    detail("volumes", start);
  }

  /// Fewer facets than the exact ones, if fewer were asked for.
  void choose_for_volume(std::span<const double> determinants) {
    constexpr double kShare = 0.75;  // of the limit; simplices and the facet table come after it
    check_squares(resolve(options_.accuracy, frame_, hull_.length_unit_).largest_extent);
    const WorkEnd end(kShare * options_.limits.max_seconds, options_.stop, start_);
    std::optional<VolumeCover> few =
        cover_for_volume(complex(), growth_->coordinates(), determinants, clusters_, options_.accuracy.facets,
                         gradient_factor(frame_, hull_.length_unit_), end);
    if (!few) return;
    growth_->note_end(few->is_cut_short);
    is_bounded_ = few->is_bounded;
    clusters_ = std::move(few->clusters);
    hull_.is_approximate = true;
  }

  /// From the beginning.
  Hull again(const HullOptions& options, bool has_run_out = false) {
    growth_.reset();
    return HullBuilder(points_, options, start_, input_bytes_, has_run_out).run();
  }

  /// Less than what was asked for, which is what the report compares widths with.
  Hull with(const Accuracy& accuracy, const ResolvedAccuracy& lengths, std::uint64_t max_facets) {
    HullOptions options = options_;
    options.accuracy = accuracy;
    options.limits.max_facets = max_facets;
    Hull hull = again(options);
    hull.chosen.width_asked = lengths.width_asked();
    return hull;
  }

  /// So few of the exact hull's planes bound no region; others do.
  Hull for_width_instead() {
    HullOptions options = options_;
    options.accuracy.objective = FacetObjective::kWidth;
    return again(options);
  }

  Hull with_larger_shift() {
    HullOptions options = options_;
    options.shift *= 10.0;
    return again(options);
  }

  std::vector<bool> corners() { return find_corners(growth_->work()); }

  /// The exact hull by simplices, or by whole facets where that is less work: then the hull is complete, and
  /// true is returned.
  bool grow_or_describe() {
    const bool may_describe = options_.accuracy.is_exact() && !options_.triangulate &&
                              !options_.wants_simplices && options_.shift >= HullOptions().shift &&
                              points_.rows <= HullDescription::kMostPoints && frame_.rank > 2;
    if (!may_describe) return growth_->grow_exactly({});
    std::optional<HullDescription> description;
    // About as long as growth has taken so far; a second at most, for those who wait for an end.
    constexpr std::uint64_t kWorkPerSimplex = 250, kMostWork = std::uint64_t{1} << 28;
    const Limits& limits = options_.limits;
    // At most 8 bytes for each step, a 64th of what is allowed; the same for the facets.
    const std::uint64_t most_words = limits.max_memory_bytes == 0 ? kMostWork : limits.max_memory_bytes / 512;
    const auto find = [&](std::uint64_t simplices) {
      if (limits.max_seconds > 0.0 && 4.0 * seconds_since(start_) > limits.max_seconds) return false;
      if (!description) description.emplace(growth_->coordinates(), points_.rows, frame_, most_words);
      return description->advance(std::min({kMostWork, most_words, kWorkPerSimplex * simplices})) &&
             (limits.max_facets == 0 || description->simplex_count() <= limits.max_facets);
    };
    if (!growth_->grow_exactly(find)) return false;
    const Clock::time_point start = Clock::now();
    hull_.statistics.created_facets = description->created_facets();
    adopt(description->take());
    seconds(Phase::kMerge) += seconds_since(start);
    return true;
  }

  void adopt(DescribedHull found) {
    const std::size_t rank = frame_.rank;
    hull_.vertices = std::move(found.vertices);
    complex() = SimplicialComplex(rank, found.facets);
    complex().row_count = found.facets;
    std::copy(found.planes.begin(), found.planes.end(), complex().planes.data());
    determinants_ = HugeArray<double>::to_write(found.facets);
    std::copy(found.determinants.begin(), found.determinants.end(), determinants_.data());
    hull_.layout_.facets = found.facets;
    for (std::size_t facet = 0; facet < found.facets; ++facet)
      for (std::size_t k = 0; k < rank; ++k)
        hull_.layout_.area_vectors.push_back(found.determinants[facet] * found.planes[facet * rank + k]);
    growth_->want_all();
    certify_facets(KnownHighest(), &found.facet_vertices);
    hull_.layout_.simplicial = found.simplicial;
    hull_.lists_->lists = {std::move(found.facet_vertices), std::move(found.neighbours)};
    std::call_once(hull_.lists_->made, [] {});
    const auto& values = hull_.lists_->lists.vertices.values;
    hull_.later_ = std::make_unique<PulledSimplices>(
        std::move(found.faces),
        std::vector<std::uint32_t>(values.begin(),
                                   values.begin() + static_cast<std::ptrdiff_t>(rank * found.simplicial)));
    for (std::uint32_t facet = 0; facet < found.facets; ++facet)
      hull_.simplex_count_ += hull_.later_->count_of(FacetId{facet});
  }

  /// A hull that was found without its complex. Facets of one simplex come first.
  void adopt(StarHull found) {
    const Clock::time_point start = Clock::now();
    RowFacets& facets = found.facets;
    const std::size_t rank = frame_.rank, count = facets.count();
    std::vector<double> coordinates;
    std::vector<std::uint32_t> ids, order(count);
    for (const PointId vertex : found.vertices) {
      const double* y = growth_->coordinates() + std::size_t{vertex.value} * rank;
      coordinates.insert(coordinates.end(), y, y + rank);
      ids.push_back(vertex.value);
    }
    std::iota(order.begin(), order.end(), 0u);
    const auto merged = std::stable_partition(order.begin(), order.end(),
                                              [&](std::uint32_t facet) { return facets.sizes[facet] == 1; });
    // The plane that is nearest to the centre is where a distance is the largest part of a height.
    growth_->certify_by_search(growth_->left_out_points(true), found.distance / facets.least_distance,
                               KnownHighest());
    complex() = SimplicialComplex(rank, count);
    complex().row_count = count;
    determinants_ = HugeArray<double>::to_write(count);
    hull_.layout_.area_vectors.resize(count * rank);
    IdRows vertices, points;
    std::vector<std::uint32_t> sizes(count);
    for (std::size_t row = 0; row < count; ++row) {
      const std::size_t facet = order[row];
      std::copy_n(facets.planes.data() + facet * rank, rank, complex().planes.data() + row * rank);
      std::copy_n(facets.area_vectors.data() + facet * rank, rank,
                  hull_.layout_.area_vectors.data() + row * rank);
      determinants_[row] = facets.determinants[facet];
      sizes[row] = facets.sizes[facet];
      for (const std::uint32_t vertex : facets.vertices.row(facet)) {
        vertices.values.push_back(vertex);
        points.values.push_back(ids[vertex]);
      }
      vertices.begin.push_back(static_cast<std::uint32_t>(vertices.values.size()));
    }
    points.begin = vertices.begin;
    hull_.layout_.merged_surface = facets.surface;
    facets = RowFacets();  // before the table is made
    hull_.is_approximate = true;
    hull_.layout_.facets = count;
    hull_.layout_.surface_exponent = found.surface_exponent;
    certify_facets(KnownHighest(), &points);
    hull_.layout_.simplicial = static_cast<std::size_t>(merged - order.begin());
    hull_.vertices = std::move(found.vertices);
    std::sort(hull_.vertices.begin(), hull_.vertices.end());
    hull_.simplex_count_ = found.simplices;
    hull_.later_ =
        std::make_unique<RegrownSimplices>(rank, std::move(coordinates), std::move(ids), std::move(vertices),
                                           std::move(sizes), std::move(order));
    seconds(Phase::kMerge) += seconds_since(start);
  }

  void make_facets(const KnownHighest& known) {
    const Clock::time_point start = Clock::now();
    // Of an approximate hull all vertices of the simplices are vertices of the inner hull: no plane is exact.
    is_vertex_ = hull_.is_approximate ? corners() : find_vertices(complex(), hull_.layout_, points_.rows);
    for (std::uint32_t id = 0; id < points_.rows; ++id)
      if (is_vertex_[id]) hull_.vertices.push_back(PointId{id});
    growth_->choose_certificate_points(hull_.layout_.facets);
    const bool proves_nothing = is_roughly_flat(points_, frame_);
    if (proves_nothing) growth_->want_all();
    detail("vertices", start);
    certify_facets(proves_nothing ? KnownHighest() : known, nullptr);
    hull_.simplex_count_ = complex().row_count;
    hull_.simplices_ = std::move(complex());
  }

  void certify_facets(const KnownHighest& known, const IdRows* merged_vertices) {
    const Clock::time_point start = Clock::now();
    const bool is_known = !known.highest.empty();
    const CertificatePoints certificate = gather_certificate_points(
        points_, frame_, is_known ? corners() : growth_->certificate_wanted(), is_known);
    hull_.reference = certificate.reference;
    growth_->release_coordinates();
    FacetTable table = make_facet_table(
        complex(), hull_.layout_, frame_, certificate, std::move(determinants_), hull_.length_unit_,
        growth_->covered_points(), known, options_.certifies_planes, merged_vertices);
    detail("facet table", start);
    hull_.area = hull_.is_approximate ? table.surface : table.area_of_facets(hull_.layout_);
    hull_.normals_ = std::move(table.normals);
    hull_.centred_offsets_ = std::move(table.offsets);
    hull_.outer_ = std::move(table.outer);
    hull_.inner_ = std::move(table.inner);
    hull_.areas_ = std::move(table.areas);
    hull_.later_areas_ = std::move(table.later_areas);
    hull_.max_outer_offset = table.max_outer;
    hull_.min_inner_offset = table.min_inner;
    hull_.max_facet_width = table.max_width;
    hull_.roundoff = table.roundoff;
    hull_.volume = table.volume;
  }

  const PointView& points_;
  const HullOptions& options_;
  Clock::time_point start_;
  double input_bytes_;
  bool has_run_out_before_;
  Hull hull_;
  Frame frame_;
  std::optional<CertifiedGrowth> growth_;
  bool is_bounded_ = true;  // by planes chosen for volume
  std::optional<StarHull> star_hull_;
  FacetClusters clusters_;  // of an approximate hull; none: coplanar simplices are merged
  HugeArray<double> determinants_;
  std::vector<bool> is_vertex_;
};

Hull build_hull(const PointView& points, const HullOptions& options, Clock::time_point start,
                double input_bytes, BegunHull* begun) {
  return HullBuilder(points, options, start, input_bytes).run(begun);
}

void rename_points(Hull& hull, std::span<const std::uint32_t> ids, std::size_t point_count) {
  HullBuilder::rename_points(hull, ids, point_count);
}

}  // namespace ndhull
