#include "bench/approximate_tables.h"

#include <fmt/format.h>

#include <algorithm>

namespace ndhull {
namespace {

Repeats& runs_of(const std::string& options, std::vector<std::pair<std::string, Repeats>>& runs) {
  for (auto& [text, repeats] : runs) {
    if (text == options) return repeats;
  }
  return runs.emplace_back(options, Repeats{}).second;
}

std::string ratio(double numerator, double denominator) { return short_number(numerator / denominator); }

// "0.182 (0.144)": of all facets together, and the widest single one.
std::string qhull_width(const HullRun& run) {
  return fmt::format("{} ({})", short_number(width_of_all_facets(run)), short_number(run.max_facet_width));
}

// ndhull's widest facet over both of Qhull's.
std::string width_ratio(const HullRun& ndhull, const HullRun& qhull) {
  return fmt::format("{} ({})", ratio(ndhull.max_facet_width, width_of_all_facets(qhull)),
                     ratio(ndhull.max_facet_width, qhull.max_facet_width));
}

/// Facets, width and seconds of one engine, or why there are none.
std::vector<std::string> qhull_cells(const Repeats& qhull) {
  if (qhull.is_empty()) return {"-", qhull.failure.empty() ? "-" : qhull.failure, "-"};
  return {grouped_number(qhull.last().facets), qhull_width(qhull.last()),
          short_number(qhull.median_seconds())};
}

std::vector<std::string> ndhull_cells(const Repeats& ndhull) {
  if (ndhull.is_empty()) return {"-", ndhull.failure.empty() ? "-" : ndhull.failure, "-"};
  return {grouped_number(ndhull.last().facets), short_number(ndhull.last().max_facet_width),
          short_number(ndhull.median_seconds())};
}

std::string speed_ratio(const Repeats& qhull, const Repeats& ndhull) {
  return ratio(qhull.median_seconds(), ndhull.median_seconds());
}

constexpr const char* kWidthNote =
    "Width: Qhull's highest outer plane to its lowest inner plane, in brackets its widest facet; ndhull's "
    "widest "
    "facet, certified. Width ratio: ndhull's over each of the two.";

Table comparison(const std::vector<ApproximateGroup>& groups, const char* title,
                 Repeats ApproximateGroup::*ndhull) {
  Table table{.title = title,
              .note = kWidthNote,
              .columns = {"input, options", "Qhull facets", "width (widest)", "seconds", "ndhull facets",
                          "width", "seconds", "facet ratio", "width ratio", "times faster"},
              .rows = {}};
  for (const ApproximateGroup& group : groups) {
    const Repeats& runs = group.*ndhull;
    if (runs.is_empty() && runs.failure.empty()) continue;
    std::vector<std::string> row{group.name};
    for (std::string& cell : qhull_cells(group.qhull)) row.push_back(std::move(cell));
    for (std::string& cell : ndhull_cells(runs)) row.push_back(std::move(cell));
    if (group.qhull.is_empty() || runs.is_empty()) {
      row.insert(row.end(), {"-", "-", "-"});
    } else {
      row.push_back(
          ratio(static_cast<double>(runs.last().facets), static_cast<double>(group.qhull.last().facets)));
      row.push_back(width_ratio(runs.last(), group.qhull.last()));
      row.push_back(speed_ratio(group.qhull, runs));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// An exact hull that a limit ended took longer than its seconds.
std::string target_cell(const Repeats& repeats) {
  if (repeats.is_empty()) return repeats.failure.empty() ? "-" : repeats.failure;
  return (repeats.done.back().is_complete() ? "" : "> ") + short_number(repeats.median_seconds());
}

Table beside_exact(const std::vector<ApproximateGroup>& groups) {
  Table table{.title = "Approximate hulls beside the exact one",
              .note =
                  "ndhull's seconds; > where a limit on time or memory ended the hull. Slowest: the slowest "
                  "approximate hull's seconds over the exact one's.",
              .columns = {"input", "exact facets"},
              .rows = {}};
  std::vector<std::string> options;
  for (const ApproximateGroup& group : groups) {
    for (const auto& [text, repeats] : group.targets) {
      if (std::find(options.begin(), options.end(), text) == options.end()) options.push_back(text);
    }
  }
  table.columns.insert(table.columns.end(), options.begin(), options.end());
  table.columns.push_back("slowest");
  for (const ApproximateGroup& group : groups) {
    if (group.targets.empty()) continue;
    std::vector<std::string> row{group.name};
    double exact_seconds = 0.0, slowest = 0.0;
    for (const auto& [text, repeats] : group.targets) {
      if (repeats.is_empty()) continue;
      if (text == "exact") {
        exact_seconds = repeats.median_seconds();
        row.push_back((repeats.done.back().is_complete() ? "" : "> ") +
                      grouped_number(repeats.last().facets));
      } else {
        slowest = std::max(slowest, repeats.median_seconds());
      }
    }
    row.resize(2, "-");
    for (const std::string& text : options) {
      const auto found = std::find_if(group.targets.begin(), group.targets.end(),
                                      [&](const auto& target) { return target.first == text; });
      row.push_back(found == group.targets.end() ? "-" : target_cell(found->second));
    }
    row.push_back(exact_seconds > 0.0 ? short_number(slowest / exact_seconds) : "-");
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table beside_quick(const std::vector<ApproximateGroup>& groups) {
  Table table{.title = "Widths looked for longer",
              .note = "Facets and seconds of ndhull: as it is asked for a width alone, and thoroughly.",
              .columns = {"input", "width", "quick facets", "seconds", "thorough facets", "seconds",
                          "facet ratio", "times as long"},
              .rows = {}};
  for (const ApproximateGroup& group : groups) {
    for (const auto& [text, thorough] : group.thorough) {
      const Repeats& quick = group.target(text.substr(0, text.rfind(' ')));
      if (quick.is_empty() || thorough.is_empty()) continue;
      table.rows.push_back(
          {group.name, text.substr(text.find(' ') + 1, text.rfind(' ') - text.find(' ') - 1),
           grouped_number(quick.last().facets), short_number(quick.median_seconds()),
           grouped_number(thorough.last().facets), short_number(thorough.median_seconds()),
           ratio(static_cast<double>(thorough.last().facets), static_cast<double>(quick.last().facets)),
           ratio(thorough.median_seconds(), quick.median_seconds())});
    }
  }
  return table;
}

}  // namespace

std::vector<ApproximateGroup> approximate_groups(const std::vector<RunRecord>& records) {
  std::vector<ApproximateGroup> groups;
  for (const RunRecord& record : records) {
    if (record.command != "approximate") continue;
    auto group = std::find_if(groups.begin(), groups.end(), [&](const ApproximateGroup& candidate) {
      return candidate.name == record.group;
    });
    if (group == groups.end()) {
      groups.emplace_back().name = record.group;
      group = groups.end() - 1;
      group->points = record.points;
    }
    if (record.task == approximate_task::kEqualFacets) {
      add_repeat(record, group->equal_facets);
    } else if (record.task == approximate_task::kEqualWidth) {
      add_repeat(record, group->equal_width);
    } else if (record.task == approximate_task::kTargets) {
      add_repeat(record, runs_of(record.key.options, group->targets));
    } else if (record.task == approximate_task::kThorough) {
      add_repeat(record, runs_of(record.key.options, group->thorough));
    } else if (record.key.engine == "qhull") {
      add_repeat(record, group->qhull);
    } else {
      add_repeat(record, group->equal_options);
    }
  }
  return groups;
}

const Repeats& ApproximateGroup::target(const std::string& wanted) const {
  static const Repeats kNothing;
  for (const auto& [text, repeats] : targets) {
    if (text == wanted) return repeats;
  }
  return kNothing;
}

double width_of_all_facets(const HullRun& run) { return run.max_outer_offset - run.min_inner_offset; }

std::vector<Table> approximate_tables(const std::vector<RunRecord>& records) {
  const std::vector<ApproximateGroup> groups = approximate_groups(records);
  std::vector<Table> tables{comparison(groups, "The same options", &ApproximateGroup::equal_options),
                            comparison(groups, "The same number of facets", &ApproximateGroup::equal_facets),
                            comparison(groups, "The same width", &ApproximateGroup::equal_width),
                            beside_exact(groups), beside_quick(groups)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace ndhull
