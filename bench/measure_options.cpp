#include "bench/measure_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <thread>

#include "bench/commands.h"
#include "bench/run_csv.h"
#include "core/error.h"
#include "tools/command_line/byte_count.h"

namespace ndhull {
namespace {

std::size_t parse_count(const std::string& text, std::string_view digits) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value == 0 || value > 1000) {
    throw Error(ErrorCode::kUsage,
                fmt::format("found \"{}\" in \"{}\", expected numbers like 3-8 or 3,5,8", digits, text));
  }
  return value;
}

// Below, what every process needs hides what facets need.
bool is_big(const HullRun& run) {
  constexpr std::uint64_t kManySimplices = 10000;
  const std::uint64_t facets = run.facets;
  return (run.detail.is_object() ? run.detail.value("simplices", facets) : facets) >= kManySimplices;
}

}  // namespace

void MeasureOptions::add_options(CLI::App& command) {
  command.add_option("--json", json_path, "one line of JSON for each run, as it is measured");
  command.add_option("--csv", csv_path, "one line for each measurement, at the end");
  command.add_flag("--resume", resume, "keep what --json has already, and measure the rest");
  command.add_option("--max-seconds", max_seconds, "stop a run after this wall clock; 0: never")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--max-memory", max_memory, "limit of one run, like 4G")->capture_default_str();
  command.add_option("--warm-up", warm_ups, "runs of each measurement before those that count")
      ->check(CLI::Range(0U, 100U))
      ->capture_default_str();
  command.add_flag("--quiet", quiet, "no progress on standard error");
}

std::vector<RunRecord> measure_with(const RunPlan& plan, const MeasureOptions& options) {
  if (options.resume && options.json_path.empty()) {
    throw Error(ErrorCode::kUsage, "--resume goes on with the file of --json: name it");
  }
  RunLimits limits;
  limits.max_seconds = options.max_seconds;
  limits.max_memory_bytes = parse_byte_count(options.max_memory, "--max-memory");
  limits.max_repeated_seconds = options.max_repeated_seconds;
  limits.warm_ups = options.warm_ups;
  limits.show_progress = !options.quiet;
  std::vector<RunRecord> earlier;
  if (options.resume && std::filesystem::exists(options.json_path)) earlier = read_records(options.json_path);
  RecordFile file(options.json_path, options.resume);
  std::vector<RunRecord> records = measure(plan, limits, earlier, file);
  if (!options.csv_path.empty()) write_csv(records, options.csv_path);
  return records;
}

Table measurement_table(const std::string& title, const std::vector<RunRecord>& records) {
  Table table{
      .title = title,
      .note =
          "Seconds: median (smallest .. largest). Bytes: peak memory beyond the points, for each facet "
          "of the simplicial hull, where these are 10,000 or more.",
      .columns = {"input", "engine", "options", "facets", "vertices", "width", "seconds", "MiB", "bytes",
                  "end"},
      .rows = {},
      .left_columns = 3};
  for (const auto& [record, repeats] : measurements_of(records)) {
    std::vector<std::string> row{record.key.input, record.key.engine, record.key.options};
    if (record.key.threads != 1) row[1] += fmt::format(" x{}", record.key.threads);
    if (repeats.is_empty()) {
      row.insert(row.end(), {"-", "-", "-", "-", "-", "-", repeats.failure});
    } else {
      const HullRun& run = repeats.last();
      row.insert(row.end(),
                 {grouped_number(run.facets), run.vertices == 0 ? "-" : grouped_number(run.vertices),
                  run.vertices == 0 ? "-" : short_number(run.max_facet_width), seconds_with_spread(repeats),
                  short_number(static_cast<double>(repeats.peak_bytes()) / (1024.0 * 1024.0)),
                  is_big(run) ? short_number(bytes_per_facet(repeats.done.back())) : "-",
                  repeats.done.back().is_complete() ? "" : repeats.done.back().status()});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void throw_if_ndhull_failed(const std::vector<RunRecord>& records) {
  for (const RunRecord& record : records) {
    const bool has_failed = record.end == "failed" || record.end == "crashed";
    if (record.key.engine == "ndhull" && has_failed) throw EngineFailed();
  }
}

unsigned available_threads() { return std::max(1U, std::thread::hardware_concurrency()); }

std::vector<std::size_t> parse_range(const std::string& text) {
  std::vector<std::size_t> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t dash = part.find('-');
    const std::size_t low = parse_count(text, std::string_view(part).substr(0, dash));
    const std::size_t high =
        dash == std::string::npos ? low : parse_count(text, std::string_view(part).substr(dash + 1));
    for (std::size_t number = low; number <= high; ++number) numbers.push_back(number);
  }
  if (numbers.empty()) parse_count(text, "");
  return numbers;
}

}  // namespace ndhull
