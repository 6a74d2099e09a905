// `ndhull-bench compare`.
#include "bench/compare.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "bench/commands.h"
#include "bench/run_csv.h"

namespace ndhull {
namespace {

// Counted work may differ between processors with and without some vector instructions: the last bit of a
// gauge decides which of two equally far points comes first.
constexpr double kCountTolerance = 0.01;

std::string name_of(const RunKey& key) {
  return fmt::format("{}, {}, {}{}", key.input, key.engine, key.options,
                     key.threads == 1 ? "" : fmt::format(", {} threads", key.threads));
}

double spread_of(const Repeats& repeats) {
  double low = repeats.done.front().run.wall_seconds, high = low;
  for (const RunRecord& record : repeats.done) {
    low = std::min(low, record.run.wall_seconds);
    high = std::max(high, record.run.wall_seconds);
  }
  return (high - low) / repeats.median_seconds();
}

double memory_of(const Repeats& repeats) {
  const auto points = static_cast<double>(repeats.last().resident_bytes);
  return std::max(0.0, static_cast<double>(repeats.peak_bytes()) - points);
}

double count_of(const Repeats& repeats, const char* name) {
  const nlohmann::json& detail = repeats.last().detail;
  return detail.is_object() && detail.contains(name) ? detail.at(name).get<double>() : 0.0;
}

/// Collects the changes of one measurement.
class Differences {
 public:
  Differences(const RunKey& key, const Repeats& before, const Repeats& after, const CompareOptions& options,
              Comparison& comparison)
      : key_(key), before_(before), after_(after), options_(options), comparison_(comparison) {}

  void collect() {
    if (before_.is_empty()) return;
    if (after_.is_empty() || (before_.done.back().is_complete() && !after_.done.back().is_complete())) {
      comparison_.regressions.push_back({key_, "done", 1.0, 0.0, 1.0});
      return;
    }
    const HullRun &old_run = before_.last(), &new_run = after_.last();
    const auto old_facets = static_cast<double>(old_run.facets),
               new_facets = static_cast<double>(new_run.facets);
    if (key_.options == "exact") {
      if (old_run.facets != new_run.facets) {
        comparison_.regressions.push_back({key_, "facets", old_facets, new_facets, 1.0});
      }
    } else {
      add("facets", old_facets, new_facets, options_.width_tolerance);
      add("max_facet_width", old_run.max_facet_width, new_run.max_facet_width, options_.width_tolerance);
    }
    for (const char* count : {"created_simplices", "insertions", "instructions"}) {
      add(count, count_of(before_, count), count_of(after_, count), kCountTolerance);
    }
    if (options_.counts_only) return;
    add("bytes", memory_of(before_), memory_of(after_), options_.memory_tolerance);
    const double old_seconds = before_.median_seconds(), new_seconds = after_.median_seconds();
    if (std::max(old_seconds, new_seconds) < options_.least_seconds) return;
    add("seconds", old_seconds, new_seconds,
        std::max({options_.time_tolerance, spread_of(before_), spread_of(after_)}));
  }

 private:
  void add(const char* figure, double before, double after, double tolerance) {
    if (before <= 0.0 || after <= 0.0) return;
    const Change change{key_, figure, before, after, 1.0 + tolerance};
    if (change.is_regression()) comparison_.regressions.push_back(change);
    if (before > after * change.allowed_ratio) comparison_.improvements.push_back(change);
  }

  const RunKey& key_;
  const Repeats &before_, &after_;
  const CompareOptions& options_;
  Comparison& comparison_;
};

Table table_of(const char* title, std::vector<Change> changes) {
  std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
    return std::abs(std::log(std::max(a.after, 1e-300) / a.before)) >
           std::abs(std::log(std::max(b.after, 1e-300) / b.before));
  });
  Table table{.title = title,
              .note = {},
              .columns = {"measurement", "figure", "before", "after", "ratio", "noise"},
              .rows = {},
              .left_columns = 2};
  for (const Change& change : changes) {
    table.rows.push_back({name_of(change.key), change.figure, short_number(change.before),
                          short_number(change.after), fmt::format("{:.3f}", change.after / change.before),
                          fmt::format("{:.3f}", change.allowed_ratio)});
  }
  return table;
}

struct CompareRequest {
  std::string before, after;
  CompareOptions options;
  double time_percent = 10.0, memory_percent = 10.0;
};

void run_compare(CompareRequest request) {
  request.options.time_tolerance = 0.01 * request.time_percent;
  request.options.memory_tolerance = 0.01 * request.memory_percent;
  const Comparison comparison =
      compare_records(read_records(request.before), read_records(request.after), request.options);
  fmt::print("{} measurements compared, {} only before, {} only after\n", comparison.measurements,
             comparison.missing.size(), comparison.added.size());
  for (const Table& table : comparison_tables(comparison)) fmt::print("\n{}", table.as_text());
  if (comparison.has_regressed()) throw HasRegressed();
}

}  // namespace

Comparison compare_records(const std::vector<RunRecord>& before, const std::vector<RunRecord>& after,
                           const CompareOptions& options) {
  Comparison comparison;
  std::map<RunKey, Repeats> new_repeats;
  for (auto& [record, repeats] : measurements_of(after)) new_repeats[record.key] = std::move(repeats);
  for (const auto& [record, repeats] : measurements_of(before)) {
    const auto found = new_repeats.find(record.key);
    if (found == new_repeats.end()) {
      comparison.missing.push_back(record.key);
      continue;
    }
    ++comparison.measurements;
    Differences(record.key, repeats, found->second, options, comparison).collect();
    new_repeats.erase(found);
  }
  for (const auto& [key, repeats] : new_repeats) comparison.added.push_back(key);
  return comparison;
}

std::vector<Table> comparison_tables(const Comparison& comparison) {
  std::vector<Table> tables{table_of("Regressions", comparison.regressions),
                            table_of("Improvements", comparison.improvements)};
  Table missing{.title = "Only before", .note = {}, .columns = {"measurement"}, .rows = {}};
  for (const RunKey& key : comparison.missing) missing.rows.push_back({name_of(key)});
  tables.push_back(std::move(missing));
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

void add_compare_command(CLI::App& app) {
  const auto request = std::make_shared<CompareRequest>();
  CLI::App* command = app.add_subcommand(
      "compare", "two sets of results: exit code 2 when something became worse beyond noise");
  command->add_option("old", request->before, "JSON lines of approximate, scaling, sweep or counts")
      ->required();
  command->add_option("new", request->after, "the same measurements, later")->required();
  command
      ->add_option("--time-tolerance", request->time_percent,
                   "[%] seconds may rise by this; by the spread of the rounds where that is more")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--memory-tolerance", request->memory_percent, "[%] of peak memory beyond the points")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--counts-only", request->options.counts_only,
                    "facets, widths and counted work alone, which hold on a noisy machine");
  command->footer("Example: ndhull-bench compare before.jsonl after.jsonl");
  command->callback([request] { run_compare(*request); });
}

}  // namespace ndhull
