// `ndhull-bench rays`: the largest facets by rays beside the whole hull; extreme points; sets whose hulls
// nobody builds. Times are of the calls of the library, all cores.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "approx/extreme_points.h"
#include "approx/hull.h"
#include "approx/largest_facets.h"
#include "approx/report.h"
#include "bench/bench_cases.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "tools/byte_count.h"
#include "tools/generate.h"

namespace ndhull {
namespace {

struct RaysOptions {
  CaseSelection selection;
  unsigned seeds = 10;
  std::size_t count = 20;
  bool skip_big = false;
};

/// Facets from which a hull of the list is worth sampling. Fewer are all found.
constexpr std::size_t kManyFacets = 10000;

double seconds_of(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[(values.size() - 1) / 2];
}

/// The whole hull and rays take turns; the recall is counted by areas.
void compare(const BenchCase& bench_case, const RaysOptions& options) {
  const BenchInput input = bench_case.load(options.selection.data_folder);
  const PointView points = input.points.view();
  std::vector<double> hull_seconds, ray_seconds, areas;
  double recall = 0.0, estimate = 0.0;
  for (unsigned seed = 1; seed <= options.seeds; ++seed) {
    hull_seconds.push_back(seconds_of([&] {
      const Hull hull = convex_hull(points);
      areas.resize(hull.facet_count());
      for (std::uint32_t id = 0; id < areas.size(); ++id) areas[id] = hull.area_of(FacetId{id});
    }));
    if (areas.size() < kManyFacets) return;
    std::sort(areas.begin(), areas.end(), std::greater<>());
    LargestFacets found;
    ray_seconds.push_back(seconds_of([&] {
      found = largest_facets(points, {.count = options.count, .method = LargestMethod::kRays, .seed = seed});
    }));
    // Areas of the two methods differ by rounding.
    const double least = areas[options.count - 1] * (1.0 - 1e-9);
    const auto right = std::count_if(found.facets.begin(), found.facets.end(),
                                     [least](const LargestFacet& facet) { return facet.area >= least; });
    recall += static_cast<double>(right) / static_cast<double>(options.count * options.seeds);
    estimate += found.sample.recall.value_or(0.0) / static_cast<double>(options.seeds);
  }
  fmt::print("{:<20} {:>10} {:>9.3f} {:>9.3f} {:>7.2f} {:>9.3f}\n", bench_case.name, areas.size(),
             median(hull_seconds), median(ray_seconds), recall, estimate);
}

/// A set that is too big to build, and how many of its largest facets are looked for.
void search(PointFamily family, std::size_t count, std::size_t dimension) {
  const PointSet set = generate_points({.family = family, .dimension = dimension, .count = count});
  LargestFacets found;
  const double seconds = seconds_of([&] { found = largest_facets(set.view(), {.count = 100}); });
  fmt::print("{:<10} {:>8} x {:<4} largest 100 {:>8.2f} s  areas {:.4g} to {:.4g}  rays {}  {}  memory {}\n",
             to_string(family), count, dimension, seconds, found.facets.front().area,
             found.facets.back().area, found.sample.rays, to_string(found.status),
             format_byte_count(peak_memory_bytes()));
}

void find_vertices_of(PointFamily family, std::size_t count, std::size_t dimension) {
  const PointSet set = generate_points({.family = family, .dimension = dimension, .count = count});
  ExtremePoints found;
  const double seconds = seconds_of([&] { found = extreme_points(set.view()); });
  fmt::print("{:<10} {:>8} x {:<4} extreme {:>12.2f} s  vertices {}\n", to_string(family), count, dimension,
             seconds, found.vertices.size());
}

void run(const RaysOptions& options) {
  fmt::print("{}\n", machine_line(describe_machine()));
  fmt::print("{:<20} {:>10} {:>9} {:>9} {:>7} {:>9}\n", "input", "facets", "hull s", "rays s", "recall",
             "estimate");
  for (const BenchCase& bench_case : options.selection.cases()) compare(bench_case, options);
  if (options.skip_big) return;
  search(PointFamily::kGaussian, 100'000, 12);
  search(PointFamily::kGaussian, 100'000, 20);
  search(PointFamily::kGaussian, 1'000'000, 16);
  find_vertices_of(PointFamily::kGaussian, 100'000, 10);
  find_vertices_of(PointFamily::kGaussian, 10'000, 100);
}

}  // namespace

void add_rays_command(CLI::App& app) {
  const auto options = std::make_shared<RaysOptions>();
  CLI::App* const command =
      app.add_subcommand("rays", "the largest facets without the hull: time and recall; extreme points");
  options->selection.add_options(*command);
  command->add_option("--seeds", options->seeds, "runs of each input; default 10")
      ->check(CLI::Range(1, 1000));
  command->add_option("--count", options->count, "facets looked for; default 20")
      ->check(CLI::Range(1, 10000));
  command->add_flag("--skip-big", options->skip_big, "without the sets whose hull is not built");
  command->callback([options] {
    if (!options->selection.print_list()) run(*options);
  });
}

}  // namespace ndhull
