// `ndhull-bench counts`: a small fixed set whose work is counted, so that a change for the worse is seen on a
// machine whose clock nobody trusts. bench/data/counts.jsonl is what it was when the engine last changed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <regex>

#include "bench/commands.h"
#include "bench/machine.h"
#include "bench/measure_options.h"
#include "bench/run_csv.h"
#include "bench/run_plan.h"
#include "core/error.h"

namespace ndhull {
namespace {

/// Text of a name: the input and its options.
struct CountedCase {
  const char* input;
  const char* options;
  std::string name() const { return fmt::format("{}, {}", input, options); }
};
constexpr CountedCase kCountedCases[] = {
    {"500 s D4 t1", "exact"},      {"500 s D5 t1", "exact"},
    {"200 s D7 t1", "exact"},      {"c D7", "exact"},
    {"1000 W1e-13 D5", "exact"},   {"diamonds, unit cube", "exact"},
    {"500 s D5 t1", "W0.1 C0.01"}, {"500 s D5 t1", "width 10%"},
    {"500 s D5 t1", "facets 200"}, {"300 s D6 t1", "width 20%"},
};

struct CountsOptions {
  CaseSelection selection;
  std::string json_path;
  std::string run_here;
  bool instructions = false;
};

HullOptions hull_options(const CountedCase& counted, const BenchCase& bench_case) {
  HullOptions options;
  options.accuracy = parse_option_set(counted.options).accuracy;
  options.unit_cube = bench_case.unit_cube;
  options.threads = 1;
  return options;
}

// In this process, without a word: what valgrind watches.
void run_here(const CountsOptions& options) {
  for (const CountedCase& counted : kCountedCases) {
    if (counted.name() != options.run_here) continue;
    const BenchCase bench_case = named_bench_input(counted.input);
    const BenchInput input = bench_case.load(options.selection.data_folder);
    convex_hull(input.points.view(), hull_options(counted, bench_case));
  }
}

/// Instructions of a process that makes this hull and nothing else, loading the points included. None without
/// valgrind.
std::optional<std::uint64_t> count_instructions(const CountedCase& counted, const CountsOptions& options) {
  std::array<char, 4096> program{};
  const std::string command = fmt::format(
      "valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null '{}' counts --data '{}' "
      "--run-here '{}' 2>&1",
      realpath("/proc/self/exe", program.data()), options.selection.data_folder, counted.name());
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string output;
  std::array<char, 4096> block;
  for (std::size_t count = 0; (count = fread(block.data(), 1, block.size(), pipe)) > 0;) {
    output.append(block.data(), count);
  }
  if (pclose(pipe) != 0) return std::nullopt;
  std::smatch match;
  if (!std::regex_search(output, match, std::regex("I\\s+refs:\\s+([0-9,]+)"))) return std::nullopt;
  std::uint64_t instructions = 0;
  for (const char digit : match[1].str()) {
    if (digit != ',') instructions = 10 * instructions + static_cast<std::uint64_t>(digit - '0');
  }
  return instructions;
}

RunPlan counts_plan(const CountsOptions& options) {
  RunPlan plan;
  for (const CountedCase& counted : kCountedCases) {
    if (!options.selection.is_chosen(counted.name())) continue;
    const BenchCase bench_case = named_bench_input(counted.input);
    plan.inputs.push_back(
        {.name = bench_case.name,
         .points = nlohmann::json::object(),
         .unit_cube = bench_case.unit_cube,
         .load = [&options, bench_case] { return bench_case.load(options.selection.data_folder); }});
    PlannedRun run{.input = plan.inputs.size() - 1,
                   .command = "counts",
                   .task = {},
                   .engine = "ndhull",
                   .options = parse_option_set(counted.options)};
    run.work = [&options, counted, bench_case](const BenchInput& input) {
      HullRun hull = run_ndhull(input, hull_options(counted, bench_case));
      if (options.instructions) {
        const std::optional<std::uint64_t> instructions = count_instructions(counted, options);
        if (!instructions) throw Error(ErrorCode::kUsage, "valgrind, which counts instructions, did not run");
        hull.detail["instructions"] = *instructions;
      }
      return hull;
    };
    plan.runs.push_back(std::move(run));
  }
  if (plan.runs.empty()) options.selection.refuse();
  return plan;
}

void run_counts(const CountsOptions& options) {
  if (!options.run_here.empty()) return run_here(options);
  if (options.selection.list) {
    for (const CountedCase& counted : kCountedCases) fmt::print("{}\n", counted.name());
    return;
  }
  MeasureOptions measuring;
  measuring.json_path = options.json_path;
  measuring.warm_ups = 0;
  measuring.max_seconds = 300.0;
  measuring.quiet = true;
  const std::vector<RunRecord> records = measure_with(counts_plan(options), measuring);
  Table table{
      .title = "Counted work",
      .note = {},
      .columns = {"input", "options", "facets", "width", "created simplices", "insertions", "instructions"},
      .rows = {},
      .left_columns = 2};
  for (const RunRecord& record : records) {
    const nlohmann::json& detail = record.run.detail;
    const auto count = [&](const char* name) {
      return record.is_done() && detail.contains(name) ? grouped_number(detail.at(name).get<std::uint64_t>())
                                                       : "-";
    };
    table.rows.push_back({record.key.input, record.key.options,
                          record.is_done() ? grouped_number(record.run.facets) : record.reason,
                          short_number(record.run.max_facet_width), count("created_simplices"),
                          count("insertions"), count("instructions")});
  }
  fmt::print("{}", table.as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

void add_counts_command(CLI::App& app) {
  const auto options = std::make_shared<CountsOptions>();
  CLI::App* command = app.add_subcommand("counts", "a small fixed set, its work counted instead of timed");
  options->selection.add_options(*command);
  command->add_flag("--instructions", options->instructions, "count instructions too, with valgrind");
  command->add_option("--json", options->json_path, "one line of JSON for each");
  command->add_option("--run-here", options->run_here, "make this hull in this process and end")->group("");
  command->footer(
      "Example: ndhull-bench counts --json now.jsonl && ndhull-bench compare --counts-only "
      "bench/data/counts.jsonl "
      "now.jsonl\nAfter a change that is meant: ndhull-bench counts --json bench/data/counts.jsonl");
  command->callback([options] { run_counts(*options); });
}

}  // namespace ndhull
