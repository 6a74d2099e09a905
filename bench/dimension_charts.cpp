#include "bench/dimension_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "bench/run_csv.h"

namespace ndhull {
namespace {

// "ndhull, width 5%".
std::string line_name(const RunKey& key) {
  return (key.engine == "qhull" ? "Qhull" : key.engine) + ", " + key.options;
}

std::string family_title(const std::vector<DimensionRun>& runs) {
  std::size_t low = runs.front().points, high = low;
  for (const DimensionRun& run : runs) {
    low = std::min(low, run.points);
    high = std::max(high, run.points);
  }
  return low == high ? fmt::format("{}, {} points", runs.front().family, low)
                     : fmt::format("{}, {} .. {} points", runs.front().family, low, high);
}

// In all charts the option set gives a line's colour, the engine whether it is dashed.
std::vector<std::string> options_of(const std::vector<std::vector<DimensionRun>>& families) {
  std::vector<std::string> options;
  for (const std::vector<DimensionRun>& runs : families) {
    for (const DimensionRun& run : runs) {
      if (std::find(options.begin(), options.end(), run.key.options) == options.end())
        options.push_back(run.key.options);
    }
  }
  return options;
}

const DimensionRun* find_run(const std::vector<DimensionRun>& runs, std::size_t dimension,
                             const std::string& engine, const std::string& options) {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const DimensionRun& run) {
    return run.dimension == dimension && run.key.engine == engine && run.key.options == options;
  });
  return found == runs.end() ? nullptr : &*found;
}

// "5.21 (4.9 .. 5.5)": of rounds that both engines have.
std::string ratio_cell(const DimensionRun& ndhull, const DimensionRun& qhull) {
  const std::string ratio = short_number(qhull.repeats.median_seconds() / ndhull.repeats.median_seconds());
  const std::string spread = ratio_spread(ndhull.repeats, qhull.repeats);
  return spread.empty() ? ratio : fmt::format("{} ({})", ratio, spread);
}

}  // namespace

std::vector<std::vector<DimensionRun>> runs_by_family(const std::vector<RunRecord>& records) {
  // A finite family has another number of points in each dimension: its name stands for the number.
  std::map<std::string, std::map<std::size_t, std::vector<DimensionRun>>> runs;
  for (const auto& [record, repeats] : measurements_of(records)) {
    const nlohmann::json& points = record.points;
    if (!points.contains("family") || !points.contains("seed") || record.key.threads != 1) continue;
    if (repeats.is_empty() || !repeats.done.back().is_complete()) continue;
    const auto family = points.at("family").get<std::string>();
    const bool is_whole = family == "lattice" || family == "cube-corners" || family == "cross-polytope";
    const auto count = points.at("points").get<std::size_t>();
    std::vector<DimensionRun>& same = runs[family][is_whole ? 0 : count];
    const auto dimension = points.at("dimension").get<std::size_t>();
    if (find_run(same, dimension, record.key.engine, record.key.options) != nullptr)
      continue;  // another seed
    same.push_back({family, dimension, count, record.key, repeats});
  }
  std::vector<std::vector<DimensionRun>> families;
  for (auto& [family, by_count] : runs) {
    std::vector<DimensionRun>* best = nullptr;
    for (auto& [count, candidates] : by_count) {
      std::set<std::size_t> dimensions;
      for (const DimensionRun& run : candidates) dimensions.insert(run.dimension);
      if (dimensions.size() >= 2 && (best == nullptr || candidates.size() >= best->size()))
        best = &candidates;
    }
    if (best == nullptr) continue;
    std::stable_sort(best->begin(), best->end(),
                     [](const DimensionRun& a, const DimensionRun& b) { return a.dimension < b.dimension; });
    families.push_back(std::move(*best));
  }
  return families;
}

std::vector<Chart> charts_over_dimension(
    const std::vector<std::vector<DimensionRun>>& families, const std::string& y_label,
    const std::function<std::optional<double>(const DimensionRun&)>& figure) {
  std::vector<Chart> charts;
  const std::vector<std::string> options = options_of(families);
  for (const std::vector<DimensionRun>& runs : families) {
    Chart chart{.title = family_title(runs),
                .x_label = "dimension",
                .y_label = y_label,
                .series = {},
                .whole_x = true};
    for (const DimensionRun& run : runs) {
      const std::optional<double> value = figure(run);
      if (!value || *value <= 0.0) continue;
      const std::string name = line_name(run.key);
      auto line = std::find_if(chart.series.begin(), chart.series.end(),
                               [&](const Series& series) { return series.name == name; });
      if (line == chart.series.end()) {
        const auto place = std::find(options.begin(), options.end(), run.key.options) - options.begin();
        chart.series.push_back({name, {}, run.key.engine != "ndhull", static_cast<std::size_t>(place)});
        line = chart.series.end() - 1;
      }
      line->points.emplace_back(static_cast<double>(run.dimension), *value);
    }
    std::erase_if(chart.series, [](const Series& series) { return series.points.size() < 2; });
    chart.log_y = spans_a_decade(chart);
    if (!chart.series.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

std::vector<Chart> exact_width_charts(const std::vector<std::vector<DimensionRun>>& families) {
  Chart chart{.title = "exact hulls",
              .x_label = "dimension",
              .y_label = "width of the widest facet [input units]",
              .series = {},
              .whole_x = true};
  for (std::size_t family = 0; family < families.size(); ++family) {
    for (const char* engine : {"ndhull", "qhull"}) {
      Series series{.name = line_name({{}, engine, families[family].front().family, 1}),
                    .points = {},
                    .is_dashed = std::string(engine) == "qhull",
                    .colour = family};
      for (const DimensionRun& run : families[family]) {
        const double width = run.repeats.last().max_facet_width;
        if (run.key.engine != engine || run.key.options != "exact" || width <= 0.0) continue;
        series.points.emplace_back(static_cast<double>(run.dimension), width);
      }
      if (!series.points.empty()) chart.series.push_back(std::move(series));
    }
  }
  chart.log_y = spans_a_decade(chart);
  return chart.series.empty() ? std::vector<Chart>{} : std::vector<Chart>{std::move(chart)};
}

std::vector<BarChart> phase_charts(const std::vector<std::vector<DimensionRun>>& families) {
  std::vector<BarChart> charts;
  for (const std::vector<DimensionRun>& runs : families) {
    BarChart chart{.title = family_title(runs) + ": ndhull, exact",
                   .x_label = "dimension",
                   .y_label = "share of the seconds [%]",
                   .parts = {"growth", "certify", "merge", "rest"},
                   .categories = {},
                   .values = {}};
    for (const DimensionRun& run : runs) {
      if (run.key.engine != "ndhull" || run.key.options != "exact") continue;
      const HullRun& hull = run.repeats.last();
      std::vector<double> shares;
      double rest = 100.0;
      for (const char* phase : {"growth", "certify", "merge"}) {
        shares.push_back(100.0 * phase_seconds(hull, phase) / hull.wall_seconds);
        rest -= shares.back();
      }
      shares.push_back(std::max(0.0, rest));
      chart.categories.push_back(fmt::format("{}", run.dimension));
      chart.values.push_back(std::move(shares));
    }
    if (!chart.categories.empty()) charts.push_back(std::move(chart));
  }
  return charts;
}

Table ratio_table(const std::vector<std::vector<DimensionRun>>& families) {
  Table table{
      .title = "Qhull's seconds over ndhull's",
      .note =
          "The same points and options, one thread: ratio of the medians, in brackets the smallest and the "
          "largest of one round.",
      .columns = {"points, options"},
      .rows = {}};
  std::set<std::size_t> dimensions;
  for (const std::vector<DimensionRun>& runs : families) {
    for (const DimensionRun& run : runs) {
      if (run.key.engine == "qhull") dimensions.insert(run.dimension);
    }
  }
  for (const std::size_t dimension : dimensions) table.columns.push_back(fmt::format("{}-d", dimension));
  for (const std::vector<DimensionRun>& runs : families) {
    std::vector<std::string> options;
    for (const DimensionRun& run : runs) {
      const bool is_new = std::find(options.begin(), options.end(), run.key.options) == options.end();
      if (run.key.engine == "qhull" && is_new) options.push_back(run.key.options);
    }
    for (const std::string& text : options) {
      std::vector<std::string> row{family_title(runs) + ", " + text};
      for (const std::size_t dimension : dimensions) {
        const DimensionRun* ndhull = find_run(runs, dimension, "ndhull", text);
        const DimensionRun* qhull = find_run(runs, dimension, "qhull", text);
        row.push_back(ndhull != nullptr && qhull != nullptr ? ratio_cell(*ndhull, *qhull) : "-");
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

}  // namespace ndhull
