// `ndhull-bench selections`: what the outer planes of 20 facets enclose, chosen by area and chosen for
// volume.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "approx/facet_selection.h"
#include "approx/outer_volume.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "tools/rbox.h"

namespace ndhull {
namespace {

constexpr const char* kInputs[] = {"200 s D4 t1", "300 s D4 t2", "500 D4 t3", "150 s D5 t1", "200 W0.1 D5 t2",
                                   "400 D5 t1",   "100 s D6 t1", "200 D6 t2", "60 s D7 t1",  "100 D7 t2"};
constexpr std::size_t kFacets = 20;

/// Outer volume over hull volume of kFacets facets, completed to a bounded region.
double excess_of(const Hull& hull, SelectionMeasure measure) {
  const FacetSelection chosen =
      select_facets(hull, {.largest = kFacets, .measure = measure, .bounded = true});
  const OuterVolume outer = outer_volume(hull, chosen.facets, 0);
  if (!outer.volume) throw EngineFailed();
  return *outer.volume / hull.volume;
}

void run_selections() {
  fmt::print("{}\nouter volume over hull volume, {} facets\n\n", machine_line(describe_machine()), kFacets);
  fmt::print("| input | facets | largest, bounded | chosen for volume |\n| --- | --- | --- | --- |\n");
  for (const std::string input : kInputs) {
    const PointSet points = rbox(input);
    const Hull hull = convex_hull(points.view(), {});
    fmt::print("| `{}` | {} | {:.4g} | {:.4g} |\n", input, hull.facet_count(),
               excess_of(hull, SelectionMeasure::kArea), excess_of(hull, SelectionMeasure::kVolume));
  }
}

}  // namespace

void add_selections_command(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "selections", "What 20 outer planes enclose, by area and chosen for volume; a minute.");
  command->callback([] { run_selections(); });
}

}  // namespace ndhull
