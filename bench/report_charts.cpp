#include "bench/report_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "bench/approximate_tables.h"
#include "bench/dimension_charts.h"
#include "bench/halfspaces.h"
#include "bench/joggle.h"
#include "bench/measure_options.h"
#include "bench/peers_table.h"
#include "bench/phases.h"
#include "bench/rays.h"
#include "bench/run_csv.h"
#include "bench/scaling_tables.h"
#include "bench/selections.h"

namespace ndhull {
namespace {

// Below, what every process needs hides what facets need.
constexpr double kManySimplices = 20000.0;

std::optional<double> bytes_figure(const DimensionRun& run) {
  const HullRun& hull = run.repeats.last();
  auto simplices = static_cast<double>(hull.facets);
  if (hull.detail.is_object()) simplices = hull.detail.value("simplices", simplices);
  if (run.key.options != "exact" || simplices < kManySimplices) return std::nullopt;
  return bytes_per_facet(run.repeats.done.back());
}

/// Facets and widths that were reached on one input.
struct Trade {
  std::string input;
  std::size_t dimension = 0;
  std::map<std::string, std::vector<std::pair<double, double>>> lines;  // engine and kind of option
};

constexpr const char* kQhullLine = "Qhull, W and C";
constexpr const char* kTargetLine = "ndhull, targets";

// A line joins what differs by one number: "width 5%" and "width 10%".
std::string kind_of(const RunKey& key) {
  if (key.engine == "qhull") return kQhullLine;
  const std::string word = key.options.substr(0, key.options.find(' '));
  return word == "width" || word == "facets" ? kTargetLine : "ndhull, W and C";
}

std::vector<Trade> trades_of(const std::vector<RunRecord>& records) {
  std::vector<Trade> trades;
  for (const auto& [record, repeats] : measurements_of(records)) {
    if (repeats.is_empty() || record.key.options == "exact" || !repeats.done.back().is_complete()) continue;
    auto trade = std::find_if(trades.begin(), trades.end(),
                              [&](const Trade& candidate) { return candidate.input == record.key.input; });
    if (trade == trades.end()) {
      trades.push_back({record.key.input, record.points.at("dimension").get<std::size_t>(), {}});
      trade = trades.end() - 1;
    }
    const HullRun& run = repeats.last();
    trade->lines[kind_of(record.key)].emplace_back(run.max_facet_width, static_cast<double>(run.facets));
  }
  return trades;
}

// Those with most to see: both engines, many options, high dimension.
std::vector<Chart> trade_charts(const std::vector<RunRecord>& records) {
  constexpr std::size_t kMostCharts = 12, kFewestPoints = 3;
  std::vector<Trade> trades = trades_of(records);
  const auto point_count = [](const Trade& trade) {
    std::size_t points = 0;
    for (const auto& [name, line] : trade.lines) points += line.size();
    return points;
  };
  std::erase_if(trades, [&](const Trade& trade) { return point_count(trade) < kFewestPoints; });
  std::stable_sort(trades.begin(), trades.end(), [&](const Trade& a, const Trade& b) {
    return std::tuple(a.lines.size(), point_count(a), a.dimension) >
           std::tuple(b.lines.size(), point_count(b), b.dimension);
  });
  if (trades.size() > kMostCharts) trades.resize(kMostCharts);
  std::vector<Chart> charts;
  for (Trade& trade : trades) {
    Chart& chart = charts.emplace_back();
    chart.title = trade.input;
    chart.x_label = trade.input.ends_with("unit cube") ? "width of the widest facet [unit cube]"
                                                       : "width of the widest facet [input units]";
    chart.y_label = "facets";
    chart.log_x = chart.log_y = true;
    for (auto& [name, line] : trade.lines) {
      std::sort(line.begin(), line.end());
      chart.series.push_back({name, line, name == kQhullLine,
                              name == kQhullLine    ? 1U
                              : name == kTargetLine ? 0U
                                                    : 2U});
    }
  }
  return charts;
}

template <class AnyChart>
void add_charts(std::vector<AnyChart> charts, ReportSection& section) {
  for (AnyChart& chart : charts) section.charts.emplace_back(std::move(chart));
}

// What these commands measure is no hull by an engine under options, and has tables of its own.
bool is_of_hull(const RunRecord& record) {
  static const std::set<std::string> kOthers{"halfspaces", "selections", "joggle", "rays"};
  return !kOthers.contains(record.command);
}

ReportSection tables_section(std::string title, std::vector<Table> tables) {
  ReportSection section;
  section.title = std::move(title);
  section.tables = std::move(tables);
  return section;
}

ReportSection text_section(std::string title, std::string text) {
  ReportSection section;
  section.title = std::move(title);
  section.text = std::move(text);
  return section;
}

using Families = std::vector<std::vector<DimensionRun>>;

ReportSection runtime_section(const Families& families) {
  ReportSection runtime = text_section(
      "Runtime against dimension",
      "Median seconds of one thread; ndhull's include the certificate, Qhull's its outer planes.");
  add_charts(charts_over_dimension(
                 families, "seconds",
                 [](const DimensionRun& run) { return std::optional(run.repeats.median_seconds()); }),
             runtime);
  runtime.tables.push_back(ratio_table(families));
  return runtime;
}

ReportSection width_section(const Families& families) {
  ReportSection width = text_section(
      "Facet width against dimension",
      "The widest facet, outer plane minus inner plane. Of ndhull the number is certified; exact hulls are "
      "at roundoff.");
  add_charts(charts_over_dimension(families, "width of the widest facet [input units]",
                                   [](const DimensionRun& run) {
                                     const bool is_exact = run.key.options == "exact";
                                     return is_exact ? std::nullopt
                                                     : std::optional(run.repeats.last().max_facet_width);
                                   }),
             width);
  add_charts(exact_width_charts(families), width);
  return width;
}

ReportSection trade_section(const std::vector<RunRecord>& records) {
  ReportSection trade = text_section(
      "Facets against width",
      "What each engine gives: lower and further left is better. Targets: a width, or a number of facets, "
      "was asked for.");
  add_charts(trade_charts(records), trade);
  trade.tables = approximate_tables(records);
  return trade;
}

ReportSection memory_section(const Families& families) {
  ReportSection memory = text_section(
      "Memory",
      "Peak memory beyond the points, for each simplex of exact hulls with 20,000 simplices or more.");
  add_charts(charts_over_dimension(families, "memory of a simplex [bytes]", bytes_figure), memory);
  return memory;
}

ReportSection phases_section(const Families& families, const std::vector<RunRecord>& records) {
  ReportSection phases = text_section(
      "Phases", "Where ndhull's time goes. Rest: the frame, and starting the process' first call.");
  add_charts(phase_charts(families), phases);
  phases.tables.push_back(phases_table(records));
  return phases;
}

ReportSection joggle_section(const std::vector<RunRecord>& records) {
  ReportSection joggle = text_section(
      "Joggle",
      "How often joggled input has a precision problem, beside the tables of Qhull's manual. ndhull counts "
      "decisions about a point that is added; Qhull also nearly singular planes and facets that are not "
      "clearly convex. A share of 0 is in the tables alone.");
  add_charts(joggle_charts(records), joggle);
  joggle.tables = joggle_tables(records);
  return joggle;
}

std::vector<Table> all_runs(const std::vector<RunRecord>& records) {
  if (records.empty()) return {};
  return {measurement_table("Runs", records)};
}

}  // namespace

std::vector<ReportSection> report_sections(const std::vector<RunRecord>& all_records) {
  std::vector<RunRecord> records;
  std::copy_if(all_records.begin(), all_records.end(), std::back_inserter(records), is_of_hull);
  const Families families = runs_by_family(records);
  std::vector<ReportSection> sections;
  sections.push_back(runtime_section(families));
  sections.push_back(tables_section("Side by side", peers_tables(records)));
  sections.push_back(width_section(families));
  sections.push_back(trade_section(records));
  sections.push_back(memory_section(families));
  sections.push_back(phases_section(families, records));
  sections.push_back(tables_section("Growth", scaling_tables(records)));
  sections.push_back(tables_section("Halfspaces", {halfspaces_table(all_records)}));
  sections.push_back(tables_section("Selections", selections_tables(all_records)));
  sections.push_back(tables_section("Largest facets", rays_tables(all_records)));
  sections.push_back(joggle_section(all_records));
  sections.push_back(tables_section("All measurements", all_runs(records)));
  for (ReportSection& section : sections) {
    std::erase_if(section.tables, [](const Table& table) { return table.rows.empty(); });
  }
  std::erase_if(sections, [](const ReportSection& section) {
    return section.charts.empty() && section.tables.empty();
  });
  return sections;
}

}  // namespace ndhull
