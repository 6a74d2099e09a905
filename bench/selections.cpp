// `ndhull-bench selections`: what the outer planes of 20 facets enclose, chosen by area and chosen for
// volume, and what those of a target number of facets do.
#include "bench/selections.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "approx/polytope/halfspace_intersection.h"
#include "approx/polytope/outer_volume.h"
#include "approx/selection/facet_selection.h"
#include "approx/verify/verify.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "core/error.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

constexpr const char* kSelectionsCommand = "selections";
constexpr const char* kFewTask = "few facets";
constexpr const char* kTargetTask = "target for volume";
constexpr const char* kByArea = "largest, bounded";
constexpr const char* kForVolume = "chosen for volume";

constexpr const char* kInputs[] = {"200 s D4 t1", "300 s D4 t2", "500 D4 t3", "150 s D5 t1", "200 W0.1 D5 t2",
                                   "400 D5 t1",   "100 s D6 t1", "200 D6 t2", "60 s D7 t1",  "100 D7 t2"};
constexpr std::size_t kFacets = 20;

/// A number of facets that Qhull's options give, and what ndhull's facets may leave above the hull.
struct Target {
  const char* input;
  const char* qhull_options;
  std::uint64_t facets;
  double wanted_excess;
};
constexpr Target kTargets[] = {{"200 s D5 t1", "C0.01", 555, 0.032},
                               {"200 s D5 t1", "W0.1 C0.01", 425, 0.045},
                               {"400 D5 t1", "C0.01", 503, 0.028},
                               {"400 D5 t1", "W0.1 C0.01", 375, 0.042}};

double volume_below(const Hull& hull, const std::vector<FacetId>& facets) {
  const OuterVolume outer = outer_volume(hull, facets, {}, 1);
  if (!outer.volume) throw std::runtime_error("the outer planes enclose no volume: " + outer.reason);
  return *outer.volume;
}

HullRun run_of(const Hull& hull, const Stopwatch& watch) {
  HullRun run;
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.vertices = hull.vertices.size();
  run.max_facet_width = hull.max_facet_width;
  run.max_outer_offset = hull.max_outer_offset;
  run.min_inner_offset = hull.min_inner_offset;
  return run;
}

/// kFacets facets of the exact hull, completed to a bounded region.
HullRun run_selection(const BenchInput& input, SelectionMeasure measure) {
  const Stopwatch watch;
  const Hull hull = convex_hull(input.points.view(), {.threads = 1});
  const FacetSelection chosen =
      select_facets(hull, {.largest = kFacets, .measure = measure, .bounded = true});
  HullRun run = run_of(hull, watch);
  run.facets = chosen.facets.size();
  run.detail = {{"status", to_string(hull.status)},
                {"hull_facets", hull.facet_count()},
                {"added", chosen.added},
                {"outer_ratio", volume_below(hull, chosen.facets) / hull.volume}};
  return run;
}

HullRun run_target(const BenchInput& input, std::uint64_t facets) {
  const PointView points = input.points.view();
  HullOptions options;
  options.accuracy.facets = facets;
  options.accuracy.objective = FacetObjective::kVolume;
  options.threads = 1;
  const Stopwatch watch;
  const Hull hull = convex_hull(points, options);
  HullRun run = run_of(hull, watch);
  run.facets = hull.facet_count();
  const Verification verification = verify_hull(points, hull, VerifyMode::kFloating);
  run.detail = {{"status", to_string(hull.status)},
                {"outer_ratio", volume_below(hull, {}) / hull.volume},
                {"is_certified", hull.points_outside == 0 && verification.passed()}};
  return run;
}

HullRun run_qhull_target(const BenchInput& input, const std::string& options) {
  std::vector<double> planes;
  HullRun run = run_qhull(input, options, &planes);
  const PointView points = input.points.view();
  const std::size_t columns = points.dimension + 1;
  const HalfspaceIntersection region =
      intersect_halfspaces(PointView::row_major(planes.data(), planes.size() / columns, columns));
  if (!region.volume) throw std::runtime_error("Qhull's outer planes enclose no volume");
  run.detail["outer_ratio"] = *region.volume / convex_hull(points, {.threads = 1}).volume;
  return run;
}

class SelectionsPlan {
 public:
  explicit SelectionsPlan(const SelectionsOptions& options) : options_(options) {
    for (const char* input : kInputs) {
      if (!add_input(input)) continue;
      for (const SelectionMeasure measure : {SelectionMeasure::kArea, SelectionMeasure::kVolume}) {
        add_run(kFewTask, {}, "ndhull", measure == SelectionMeasure::kArea ? kByArea : kForVolume,
                [measure](const BenchInput& points) { return run_selection(points, measure); });
      }
    }
    for (const Target& target : kTargets) {
      if (!add_input(target.input)) continue;
      const std::string group = fmt::format("{}, {} facets", target.input, target.facets);
      add_run(kTargetTask, group, "ndhull", fmt::format("facets {}, volume", target.facets),
              [target](const BenchInput& points) { return run_target(points, target.facets); });
      add_run(kTargetTask, group, "qhull", target.qhull_options,
              [target](const BenchInput& points) { return run_qhull_target(points, target.qhull_options); });
    }
    if (plan_.runs.empty())
      throw Error(ErrorCode::kUsage, fmt::format("no input has \"{}\" in its name", options.only));
  }
  RunPlan take() { return std::move(plan_); }

 private:
  bool add_input(const std::string& name) {
    if (name.find(options_.only) == std::string::npos) return false;
    const PointSet points = rbox(name);
    plan_.inputs.push_back({.name = name,
                            .points = {{"points", points.rows()}, {"dimension", points.dimension}},
                            .load = [name] {
                              return BenchInput{rbox(name), {}};
                            }});
    return true;
  }
  void add_run(const char* task, const std::string& group, const char* engine, const std::string& text,
               std::function<HullRun(const BenchInput&)> work) {
    plan_.runs.push_back({.input = plan_.inputs.size() - 1,
                          .command = kSelectionsCommand,
                          .task = task,
                          .group = group,
                          .engine = engine,
                          .options = {.text = text, .accuracy = {}},
                          .work = std::move(work)});
  }

  const SelectionsOptions& options_;
  RunPlan plan_;
};

// The last record that was done, or null.
const RunRecord* find_record(const std::vector<RunRecord>& records, const char* task,
                             const std::string& input, const std::string& options) {
  const RunRecord* found = nullptr;
  for (const RunRecord& record : records) {
    if (record.command == kSelectionsCommand && record.task == task && record.key.input == input &&
        record.key.options == options && record.is_done()) {
      found = &record;
    }
  }
  return found;
}

double outer_ratio(const RunRecord& record) { return record.run.detail.at("outer_ratio").get<double>(); }

// "3.1": by how many percent the volume below the outer planes is more than the hull's.
std::string excess_cell(const RunRecord* record) {
  return record == nullptr ? "-" : fmt::format("{:.2f}", 100.0 * (outer_ratio(*record) - 1.0));
}

Table few_table(const std::vector<RunRecord>& records) {
  Table table{.title = fmt::format("What {} outer planes enclose", kFacets),
              .note =
                  "Volume below the outer planes over the hull's: of the facets of largest area (PAn), with "
                  "those that make the region bounded, and of facets chosen for volume (--select volume).",
              .columns = {"input", "facets of the hull", "largest", "planes", "for volume", "planes"},
              .rows = {}};
  for (const char* input : kInputs) {
    const RunRecord* const by_area = find_record(records, kFewTask, input, kByArea);
    const RunRecord* const for_volume = find_record(records, kFewTask, input, kForVolume);
    if (by_area == nullptr && for_volume == nullptr) continue;
    const RunRecord& any = by_area != nullptr ? *by_area : *for_volume;
    std::vector<std::string> row{input,
                                 grouped_number(any.run.detail.at("hull_facets").get<std::uint64_t>())};
    for (const RunRecord* record : {by_area, for_volume}) {
      row.push_back(record == nullptr ? "-" : fmt::format("{:.4g}", outer_ratio(*record)));
      row.push_back(record == nullptr ? "-" : grouped_number(record->run.facets));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table target_table(const std::vector<RunRecord>& records) {
  Table table{.title = "A number of facets, little volume above the hull",
              .note =
                  "Excess: volume below the outer planes over the hull's, minus one. ndhull: --facets N "
                  "--objective volume; certified: no point above a plane, and every claim passed --verify.",
              .columns = {"input", "Qhull's options", "Qhull facets", "excess %", "ndhull facets", "excess %",
                          "wanted %", "certified", "seconds"},
              .rows = {},
              .left_columns = 2};
  for (const Target& target : kTargets) {
    const RunRecord* const ndhull =
        find_record(records, kTargetTask, target.input, fmt::format("facets {}, volume", target.facets));
    const RunRecord* const qhull = find_record(records, kTargetTask, target.input, target.qhull_options);
    if (ndhull == nullptr && qhull == nullptr) continue;
    std::vector<std::string> row{target.input, target.qhull_options};
    for (const RunRecord* record : {qhull, ndhull}) {
      row.push_back(record == nullptr ? "-" : grouped_number(record->run.facets));
      row.push_back(excess_cell(record));
    }
    row.push_back(fmt::format("{:.1f}", 100.0 * target.wanted_excess));
    const bool is_certified = ndhull != nullptr && ndhull->run.detail.at("is_certified").get<bool>();
    row.push_back(is_certified ? "yes" : "no");
    row.push_back(ndhull == nullptr ? "-" : short_number(ndhull->run.wall_seconds));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void run_selections(const SelectionsOptions& options) {
  const std::vector<RunRecord> records = measure_with(selections_plan(options), options.measuring);
  fmt::print("{}\n", machine_line(describe_machine()));
  for (const Table& table : selections_tables(records)) fmt::print("\n{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

RunPlan selections_plan(const SelectionsOptions& options) { return SelectionsPlan(options).take(); }

std::vector<Table> selections_tables(const std::vector<RunRecord>& records) {
  std::vector<Table> tables{few_table(records), target_table(records)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

void add_selections_command(CLI::App& app) {
  const auto options = std::make_shared<SelectionsOptions>();
  options->measuring.warm_ups = 0;
  CLI::App* const command = app.add_subcommand(
      "selections", "what 20 outer planes enclose, by area and chosen for volume; a target for volume");
  command->add_option("--only", options->only, "only the inputs whose name contains this");
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench selections --json selections.jsonl   # half a minute");
  command->callback([options] { run_selections(*options); });
}

}  // namespace ndhull
