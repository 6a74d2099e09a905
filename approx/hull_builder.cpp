#include "approx/hull_builder.h"

#include <algorithm>

#include "approx/exact_instead.h"
#include "approx/facets/coplanar_merge.h"
#include "approx/facets/exact_facets.h"
#include "approx/facets/facet_layout.h"
#include "approx/facets/facet_table.h"
#include "approx/facets/shifted_vertices.h"
#include "approx/geometry/frame_planes.h"
#include "approx/hull_run.h"
#include "approx/selection/volume_cover.h"
#include "approx/trade/approximate_facets.h"
#include "approx/trade/described_join.h"
#include "core/error.h"
#include "core/frame.h"
#include "core/growth/growth.h"
#include "core/machine/stopwatch.h"

namespace ndhull {

Hull HullBuilder::run(BegunHull* begun) {
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
  find_whole_facets();
  if (std::optional<Hull> found = frame_.rank == 1 ? grow_segment()
                                  : is_exact       ? grow_exactly()
                                                   : grow_for(lengths, factor))
    return std::move(*found);
  return merged_hull(is_exact, lengths);
}

/// In one dimension there is nothing to grow.
std::optional<Hull> HullBuilder::grow_segment() {
  complex() = make_segment(growth_->coordinates(), points_.rows);
  growth_->want_all();
  return std::nullopt;
}

/// Something, here and below: the hull was found otherwise, or is what there is at a limit.
std::optional<Hull> HullBuilder::grow_exactly() {
  if (growth_->grow_exactly() || finds_whole_facets_late()) {
    if (take_described()) return std::move(hull_);
    if (earlier_.facets == 0) return again(options_, {.has_tried_exact = true});
    hull_.status = HullStatus::kFacetLimit;  // an attempt in vain
    return std::move(hull_);
  }
  if (growth_->is_too_rough()) return with_larger_shift();
  if (hull_.status != HullStatus::kComplete && !options_.wants_partial) return std::move(hull_);
  return std::nullopt;
}

/// And chooses which simplices to merge. `factor`: gradient_factor.
std::optional<Hull> HullBuilder::grow_for(const ResolvedAccuracy& lengths,
                                          const std::vector<double>& factor) {
  const bool has_room = approximate(factor);
  if (growth_->is_found_otherwise()) {
    if (take_described()) return std::move(hull_);
    return again(options_, {.has_run_out = earlier_.has_run_out, .has_tried_exact = true});
  }
  if (wants_exact_first_) return exact_first(lengths);
  if (growth_->is_too_rough()) return with_larger_shift();
  if (!has_room) return again(options_, {.has_run_out = true, .has_tried_exact = earlier_.has_tried_exact});
  if (!star_hull_) return std::nullopt;
  adopt(std::move(*star_hull_));
  return std::move(hull_);
}

/// Makes facets of what was grown; or takes the exact hull where that is as good.
Hull HullBuilder::merged_hull(bool is_exact, const ResolvedAccuracy& lengths) {
  const Accuracy& accuracy = options_.accuracy;
  // While coordinates and planes are those of growth.
  const double height = is_exact ? 0.0 : growth_->furthest_height();
  const std::size_t simplices = complex().row_count - growth_->work().free_count;
  const std::uint64_t most_exact = most_exact_facets(lengths, accuracy, clusters_.facets_of(simplices));
  const bool may_be_few =
      most_exact > 0 && may_be_few_facets(growth_->work(), growth_->coordinates(), most_exact);
  const Clock::time_point merge_start = Clock::now();
  KnownHighest known = growth_->take_known_highest();
  compact_rows(known);
  merge();
  if (!is_bounded_) return for_width_instead();
  if (hull_.layout_.simplicial < hull_.layout_.facets) known = {};  // facets are no longer the rows
  make_facets(known);
  seconds(Phase::kMerge) += seconds_since(merge_start);
  if (is_wide_for(height, lengths)) return narrow_instead(lengths);
  if (earlier_.has_tried_exact) return std::move(hull_);
  if (const auto most = simplices_of_exact(hull_, may_be_few, options_, lengths)) {
    Hull exact = with(Accuracy(), lengths, *most);
    if (is_exact_better(exact, hull_, accuracy, lengths)) return exact;
  }
  return std::move(hull_);
}

/// Moves the last rows of all tables into free ones.
void HullBuilder::compact_rows(KnownHighest& known) {
  const std::vector<RowMove> moves = compact(complex());
  clusters_.move_rows(moves, complex().row_count);
  for (const RowMove& move : moves) {
    if (determinants_.data() != nullptr) determinants_[move.to] = determinants_[move.from];
    if (known.highest.empty()) continue;
    known.highest[move.to] = known.highest[move.from];
    std::copy_n(known.normals.data() + move.from * frame_.dimension, frame_.dimension,
                known.normals.data() + move.to * frame_.dimension);
  }
}

void HullBuilder::describe_input() {
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
bool HullBuilder::approximate(const std::vector<double>& factor) {
  const Clock::time_point begin = Clock::now();
  const ResolvedAccuracy lengths = resolve(options_.accuracy, frame_, hull_.length_unit_);
  check_depths(options_.accuracy, lengths);
  check_squares(lengths.largest_extent);
  ApproximateFacets found = approximate_facets(
      {frame_, options_.accuracy, lengths, factor, *growth_, hull_, input_bytes_, earlier_});
  clusters_ = std::move(found.clusters);
  wants_exact_first_ = found.wants_exact_first;
  star_hull_ = std::move(found.star_hull);
  determinants_ = std::move(found.determinants);
  seconds(Phase::kMerge) += seconds_since(begin) - seconds(Phase::kGrowth) - seconds(Phase::kCertify);
  return hull_.status != HullStatus::kMemoryLimit || earlier_.has_run_out || !found.may_do_without_complex;
}

void HullBuilder::merge() {
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

void HullBuilder::find_determinants(std::span<const std::uint8_t> is_shifted) {
  const Clock::time_point start = Clock::now();
  determinants_ = HugeArray<double>::to_write(complex().row_count);
  const std::span<double> found(determinants_.data(), complex().row_count);
  const bool keeps_planes = hull_.is_approximate && is_shifted.empty();
  if (keeps_planes) find_outwards(complex(), growth_->coordinates(), found);
  if (!keeps_planes) solve_outwards(complex(), growth_->coordinates(), is_shifted, found);
  detail("volumes", start);
}

/// Fewer facets than the exact ones, if fewer were asked for.
void HullBuilder::choose_for_volume(std::span<const double> determinants) {
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

/// Whole facets are looked for while growth goes on, for an exact hull or a target that few of them may meet.
void HullBuilder::find_whole_facets() {
  const Accuracy& accuracy = options_.accuracy;
  const bool is_target = !accuracy.merges_neighbours() && !accuracy.outside_width.is_set() &&
                         !accuracy.is_for_volume() && accuracy.effort == Effort::kQuick &&
                         !earlier_.has_run_out;
  if (earlier_.has_tried_exact || (!accuracy.is_exact() && !is_target) || options_.triangulate ||
      (accuracy.is_exact() && options_.wants_simplices && !earlier_.limits_work) ||
      options_.shift < HullOptions().shift || points_.rows > HullDescription::kMostPoints || frame_.rank <= 2)
    return;
  growth_->ask_otherwise([this](std::uint64_t simplices) {
    // About as long as growth has taken so far; a second at most, for those who wait for an end.
    constexpr std::uint64_t kWorkPerSimplex = 125, kMostWork = std::uint64_t{1} << 28;
    const double limit = options_.limits.max_seconds;
    if (limit > 0.0 && 4.0 * seconds_since(start_) > limit) return false;
    return look_for_whole_facets(std::min(kMostWork, kWorkPerSimplex * simplices));
  });
}

/// Goes on with the search. Returns true once, when all are found and allowed.
bool HullBuilder::look_for_whole_facets(std::uint64_t work) {
  // At most 8 bytes for each step, a 64th of what is allowed; the same for the facets.
  constexpr std::uint64_t kMostWords = std::uint64_t{1} << 28;
  const Limits& limits = options_.limits;
  const std::uint64_t most_words = limits.max_memory_bytes == 0 ? kMostWords : limits.max_memory_bytes / 512;
  if (!whole_facets_)
    whole_facets_ =
        std::make_unique<WholeFacetSearch>(growth_->coordinates(), points_.rows, frame_, most_words);
  HullDescription& description = whole_facets_->description;
  if (limits.max_memory_bytes > 0) work = std::min(work, most_words);
  return description.advance(work) &&
         (limits.max_facets == 0 || earlier_.limits_work || description.simplex_count() <= limits.max_facets);
}

/// Growth that was worth so many simplices has ended: the search for whole facets, if it has begun, may be near
/// its end.
bool HullBuilder::finds_whole_facets_late() {
  constexpr std::uint64_t kLastWork = std::uint64_t{1} << 30;
  return earlier_.limits_work && hull_.status == HullStatus::kFacetLimit && whole_facets_ &&
         look_for_whole_facets(kLastWork);
}

/// Whole facets were found: are they what is wanted, or can they be joined to that?
bool HullBuilder::take_described() {
  constexpr std::uint64_t kMostListed = std::uint64_t{1} << 24;  // where simplices are wanted
  const Clock::time_point start = Clock::now();
  HullDescription& description = whole_facets_->description;
  if (options_.wants_simplices && description.simplex_count() > kMostListed) return false;
  hull_.statistics.created_facets = description.created_facets();
  DescribedHull found = description.take();
  const std::uint64_t most = std::max(options_.accuracy.facets, earlier_.facets);
  const double width = resolve(options_.accuracy, frame_, hull_.length_unit_).width;
  const bool is_count = most > 0 && found.facets > most;
  if (is_count || width > 0.0) {
    if (found.facets > kMostDescribedJoined) return false;
    const ScaledFactor area = scale_factor(gradient_factor(frame_, LengthUnit()));
    hull_.layout_.merged_surface = surface_of(found, area.factor);
    hull_.layout_.surface_exponent = area.exponent;
    const WidthSpace space(frame_.rank, gradient_factor(frame_, hull_.length_unit_), growth_->coordinates(),
                           points_.rows, found.vertices, {}, found.facets);
    if (is_count && !join_described_to(found, space, most)) return false;
    if (!is_count) join_described(found, space, width * (1.0 - 1e-9));
  }
  adopt(std::move(found));
  if (hull_.is_approximate) hull_.chosen.slab_width = width > 0.0 ? width : hull_.max_facet_width;
  seconds(Phase::kMerge) += seconds_since(start);
  return true;
}

void HullBuilder::make_facets(const KnownHighest& known) {
  const Clock::time_point start = Clock::now();
  if (!hull_.is_approximate) {
    is_vertex_ = find_vertices(complex(), hull_.layout_, points_.rows);
  } else if (growth_->work().shifted_points.empty()) {  // of the inner hull, that of all simplices
    is_vertex_ = corners();
  } else {
    is_vertex_ = find_vertices_of_shifted(growth_->work());
    if (is_vertex_ != corners()) keep_enough_vertices(complex(), hull_.layout_, is_vertex_);
  }
  for (std::uint32_t id = 0; id < points_.rows; ++id)
    if (is_vertex_[id]) hull_.vertices.push_back(PointId{id});
  growth_->choose_certificate_points(hull_.layout_.facets);
  const bool proves_nothing = is_roughly_flat(points_, frame_);
  if (proves_nothing) growth_->want_all();
  detail("vertices", start);
  // Where it is known how far all points reach, each of them was asked for.
  if (proves_nothing || known.highest.empty()) hull_.points_outside = growth_->points_without_proof();
  certify_facets(proves_nothing ? KnownHighest() : known, nullptr);
  hull_.simplex_count_ = complex().row_count;
  hull_.simplices_ = std::move(complex());
}

void HullBuilder::certify_facets(const KnownHighest& known, const IdRows* merged_vertices) {
  const Clock::time_point start = Clock::now();
  const bool is_known = !known.highest.empty();
  const CertificatePoints certificate = gather_certificate_points(
      points_, frame_, is_known ? corners() : growth_->certificate_wanted(), is_known);
  hull_.reference = certificate.reference;
  growth_->release_coordinates();
  FacetTable table = make_facet_table(complex(), hull_.layout_, frame_, certificate, std::move(determinants_),
                                      hull_.length_unit_, growth_->covered_points(), known,
                                      options_.certifies_planes, merged_vertices);
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

Hull build_hull(const PointView& points, const HullOptions& options, Clock::time_point start,
                double input_bytes, BegunHull* begun) {
  return HullBuilder(points, options, start, input_bytes).run(begun);
}

}  // namespace ndhull
