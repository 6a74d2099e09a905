// The driver. Steps in order, with the file that holds each; 1 to 5 follow each other in approx/hull_builder:
//   0 large inputs    approx/reduction/point_reduction  points well inside are dropped, each with a proof
//   1 frame           core/frame                        coordinates to work in, the first simplex, the rank
//   2 growth          core/growth/growth                insertions, furthest point first
//   3 certify         core/complex/membership           every point proven inside, or growth goes on
//   4 merge           approx/facets/coplanar_merge      simplices on one plane become one facet
//   2 to 4 otherwise  approx/slabs/star_hull            where the simplices would take too much memory
//   5 facet table     approx/facets/facet_table         planes in input units, offsets proven, areas

#include "approx/hull.h"
#include "approx/hull_builder.h"
#include "approx/option_check.h"
#include "approx/reduction/point_reduction.h"
#include "approx/reduction/reduced_points.h"
#include "approx/sharded_hull.h"
#include "core/frame.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"

namespace ndhull {
namespace {

/// Of a large set, what of this process is not proven to be well inside. Nothing when it is not large, or too
/// few would be dropped.
std::optional<PointsToKeep> points_worth_a_copy(const PointShards& shards, const HullOptions& options,
                                                Clock::time_point start) {
  if (shards.rows < kPointsToReduce) return std::nullopt;
  const auto is_late = [&] {
    constexpr double kShare = 0.2;  // of the time, for looking at points that will turn out to be inside
    const double most = options.limits.max_seconds;
    return options.stop.stop_requested() || (most > 0.0 && seconds_since(start) > kShare * most);
  };
  PointsToKeep points = find_points_to_keep(shards, options.seed, is_late);
  double kept = 0.0;
  for (const double number : shards.all_gather({static_cast<double>(points.rows.size())})) kept += number;
  constexpr double kWorthACopy = 0.7;
  if (kept > kWorthACopy * static_cast<double>(shards.rows)) return std::nullopt;
  return points;
}

double input_bytes(const PointShards& shards) {
  const std::size_t scalar = shards.type == ScalarType::kFloat32 ? sizeof(float) : sizeof(double);
  return static_cast<double>(shards.rows * shards.dimension * scalar);
}

/// With a width, or a number of facets, fewer may be wanted than were made already. A limit on facets ends
/// growth at any time: then the furthest of all points has to come first. So it has to where memory is short.
bool may_go_on(const BegunHull& begun, const HullOptions& options) {
  constexpr std::uint64_t kMemoryForIt = 8;
  const bool is_exact = options.accuracy.is_exact() || options.accuracy.is_for_volume();
  const std::uint64_t most = options.limits.max_memory_bytes;
  return is_exact && options.limits.max_facets == 0 && options.shift <= HullOptions().shift &&
         (most == 0 || most >= kMemoryForIt * begun.bytes());
}

/// The hull in terms of the rows of `reduced`.
Hull hull_of_reduced(const ReducedPoints& reduced, const PointShards& shards, HullOptions options,
                     Clock::time_point start, std::optional<BegunHull> begun) {
  const double seconds = seconds_since(start);
  for (std::uint64_t* most : {&options.limits.max_memory_bytes, &options.limits.machine_memory_bytes})
    *most = limit_left(*most, reduced.bytes());
  const PointView view = reduced.view();
  const bool goes_on = begun && may_go_on(*begun, options) && begun->rename_points(reduced.ids());
  if (!goes_on) begun.reset();  // its memory is wanted
  Hull hull = build_hull(view, options, start, input_bytes(shards), goes_on ? &*begun : nullptr);
  hull.statistics.dropped_points = shards.rows - view.rows;
  if (shards.rows == view.rows) return hull;
  hull.statistics.seconds[static_cast<std::size_t>(Phase::kCertify)] += seconds;
  hull.statistics.detail_seconds.emplace_back("dropping points", seconds);
  return hull;
}

Hull hull_of(const PointView& points, const HullOptions& options) {
  const Clock::time_point start = Clock::now();
  const PointShards whole = PointShards::whole(points);
  std::optional<PointsToKeep> kept = points_worth_a_copy(whole, options, start);
  if (!kept) return build_hull(points, options, start, input_bytes(whole));
  const ReducedPoints reduced(whole, std::move(kept->rows));
  Hull hull = hull_of_reduced(reduced, whole, options, start, std::move(kept->begun));
  rename_points(hull, reduced.ids(), points.rows);
  return hull;
}

}  // namespace

Hull convex_hull(const PointView& points, const HullOptions& options) {
  check_shape(points);
  check_options(options);
  return arena_of(options.threads).execute([&] { return hull_of(points, options); });
}

std::optional<ShardedHull> convex_hull_of_shards(const PointShards& shards, const HullOptions& options) {
  check_options(options);
  return arena_of(options.threads).execute([&]() -> std::optional<ShardedHull> {
    const Clock::time_point start = Clock::now();
    std::optional<PointsToKeep> kept = points_worth_a_copy(shards, options, start);
    ReducedPoints points(shards, kept ? std::move(kept->rows) : rows_of(shards));
    if (shards.exchange != nullptr && !shards.exchange->is_first()) return std::nullopt;
    Hull hull = hull_of_reduced(points, shards, options, start, kept ? std::move(kept->begun) : std::nullopt);
    return ShardedHull{std::move(hull), std::move(points)};
  });
}

}  // namespace ndhull
