// `ndhull-bench joggle`: the two tables of Qhull's manual, how often joggled input has a precision problem.
//
// What is counted as a problem. Qhull: a point that is added lies within its roundoff of a facet's plane, a
// pivot of a plane's elimination is near zero, two facets of the result are not clearly convex. ndhull: a
// decision whether a facet is visible from a point that is added lies within roundoff (approx/joggle.h).
// Planes are not eliminated, so they have no pivots; and facets are convex when the decisions were clear.
#include "bench/joggle.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "approx/joggle.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "core/error.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

constexpr const char* kJoggleCommand = "joggle";

/// A size of the joggle and the share of runs with a problem that the manual gives for it.
struct ManualRow {
  double size, share;
};

constexpr ManualRow kCube[] = {{1e-15, .983},   {2e-15, .830},   {4e-15, .561},   {8e-15, .325},
                               {1.6e-14, .185}, {3.2e-14, .099}, {6.4e-14, .051}, {1.3e-13, .025},
                               {2.6e-13, .010}, {5.1e-13, .004}, {1e-12, .002},   {2e-12, .001}};
constexpr ManualRow kCubeSurface[] = {{1e-12, .870},   {2e-12, .700},   {4e-12, .450},   {8e-12, .250},
                                      {1.6e-11, .110}, {3.2e-11, .065}, {6.4e-11, .030}, {1.3e-10, .010},
                                      {2.6e-10, .008}, {5.1e-09, .003}};

struct ManualTable {
  const char* input;  ///< arguments of rbox
  const char* title;
  std::span<const ManualRow> rows;
};
const ManualTable kTables[] = {{"c D3", "Joggled unit cube", kCube},
                               {"1000 W0 D3", "1000 points on the unit cube, joggled", kCubeSurface}};

std::string option_of(const ManualRow& row) { return fmt::format("QJ{:.2g}", row.size); }

/// The share that Qhull's own program finds.
double share_of_qhull(const std::string& input, const ManualRow& row, std::uint64_t runs) {
  const std::string command = fmt::format("rbox {} | qhull {} TR{} s 2>&1", input, option_of(row), runs);
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::optional<double> share;
  char line[512];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr) {
    double percentage = 0.0;
    if (std::sscanf(line, " Percentage of runs with precision errors: %lf", &percentage) == 1)
      share = 0.01 * percentage;
  }
  if (pipe != nullptr) pclose(pipe);
  if (!share)
    throw std::runtime_error("the programs rbox and qhull (Debian package qhull-bin) gave no share");
  return *share;
}

double share_of_ndhull(const PointView& points, const ManualRow& row, std::uint64_t runs) {
  const std::uint64_t problems = count_precision_problems(points, {.threads = 1}, {.size = row.size}, runs);
  return static_cast<double>(problems) / static_cast<double>(runs);
}

HullRun count_problems(const BenchInput& input, const std::string& qhull_input, const ManualRow& row,
                       std::uint64_t runs) {
  const Stopwatch watch;
  const PointView points = input.points.view();
  const double share =
      qhull_input.empty() ? share_of_ndhull(points, row, runs) : share_of_qhull(qhull_input, row, runs);
  HullRun run;
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.detail = {{"size", row.size},
                {"share", share},
                {"manual_share", row.share},
                {"runs", runs},
                {"roundoff", joggle_roundoff(points)}};
  return run;
}

/// The records of one size.
struct Shares {
  std::optional<double> ndhull, qhull;
  std::uint64_t runs = 0;
  double roundoff = 0.0;
};

Shares shares_of(const std::vector<RunRecord>& records, const ManualTable& manual, const ManualRow& row) {
  Shares shares;
  for (const RunRecord& record : records) {
    const bool is_of_row = record.command == kJoggleCommand && record.key.input == manual.input &&
                           record.key.options == option_of(row) && record.is_done();
    if (!is_of_row) continue;
    const auto share = record.run.detail.at("share").get<double>();
    (record.key.engine == "qhull" ? shares.qhull : shares.ndhull) = share;
    record.run.detail.at("runs").get_to(shares.runs);
    record.run.detail.at("roundoff").get_to(shares.roundoff);
  }
  return shares;
}

std::string share_cell(const std::optional<double>& share) {
  return share ? fmt::format("{:.3f}", *share) : "-";
}

void run_joggle(const JoggleBenchOptions& options) {
  const std::vector<RunRecord> records = measure_with(joggle_plan(options), options.measuring);
  fmt::print("{}\n", machine_line(describe_machine()));
  for (const Table& table : joggle_tables(records)) fmt::print("\n{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

RunPlan joggle_plan(const JoggleBenchOptions& options) {
  RunPlan plan;
  for (const ManualTable& manual : kTables) {
    const std::string input = manual.input;
    if (input.find(options.only) == std::string::npos) continue;
    const PointSet points = rbox(input);
    plan.inputs.push_back({.name = input,
                           .points = {{"points", points.rows()}, {"dimension", points.dimension}},
                           .load = [input] {
                             return BenchInput{rbox(input), {}};
                           }});
    for (const ManualRow& row : manual.rows) {
      for (const char* engine : {"ndhull", "qhull"}) {
        const bool is_qhull = std::string(engine) == "qhull";
        if (is_qhull && options.without_qhull) continue;
        plan.runs.push_back({.input = plan.inputs.size() - 1,
                             .command = kJoggleCommand,
                             .task = kJoggleCommand,
                             .engine = engine,
                             .options = {.text = option_of(row), .accuracy = {}},
                             .work = [row, qhull_input = is_qhull ? input : "",
                                      runs = options.runs](const BenchInput& points_of_input) {
                               return count_problems(points_of_input, qhull_input, row, runs);
                             }});
      }
    }
  }
  if (plan.runs.empty())
    throw Error(ErrorCode::kUsage, fmt::format("no input has \"{}\" in its name", options.only));
  return plan;
}

std::vector<Table> joggle_tables(const std::vector<RunRecord>& records) {
  std::vector<Table> tables;
  for (const ManualTable& manual : kTables) {
    Table table{.title = fmt::format("{} (rbox {})", manual.title, manual.input),
                .note = {},
                .columns = {"joggle", "manual", "Qhull", "ndhull"},
                .rows = {}};
    for (const ManualRow& row : manual.rows) {
      const Shares shares = shares_of(records, manual, row);
      if (!shares.ndhull && !shares.qhull) continue;
      table.note = fmt::format("Share of {} joggles that had a precision problem; roundoff {:.2g}.",
                               shares.runs, shares.roundoff);
      table.rows.push_back({fmt::format("{:.2g}", row.size), share_cell(row.share), share_cell(shares.qhull),
                            share_cell(shares.ndhull)});
    }
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<Chart> joggle_charts(const std::vector<RunRecord>& records) {
  std::vector<Chart> charts;
  for (const ManualTable& manual : kTables) {
    Chart chart{.title = manual.title,
                .x_label = "joggle [input units]",
                .y_label = "share of joggles with a precision problem",
                .series = {{.name = "ndhull", .points = {}, .colour = 0},
                           {.name = "Qhull", .points = {}, .is_dashed = true, .colour = 1},
                           {.name = "Qhull's manual", .points = {}, .is_dashed = true, .colour = 7}},
                .log_x = true,
                .log_y = true};
    for (const ManualRow& row : manual.rows) {
      const Shares shares = shares_of(records, manual, row);
      const auto add = [&](std::size_t series, const std::optional<double>& share) {
        if (share && *share > 0.0) chart.series[series].points.emplace_back(row.size, *share);
      };
      add(0, shares.ndhull);
      add(1, shares.qhull);
      add(2, row.share);
    }
    if (!chart.series[0].points.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

void add_joggle_command(CLI::App& app) {
  const auto options = std::make_shared<JoggleBenchOptions>();
  options->measuring.warm_ups = 0;
  CLI::App* command = app.add_subcommand("joggle", "how often joggled input has a precision problem");
  command->add_option("--only", options->only, "only the inputs whose name contains this, like \"c D3\"");
  command->add_option("--runs", options->runs, "joggles for each size")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}))
      ->capture_default_str();
  command->add_flag("--without-qhull", options->without_qhull, "do not run Qhull's program beside");
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench joggle --runs 200");
  command->callback([options] { run_joggle(*options); });
}

}  // namespace ndhull
