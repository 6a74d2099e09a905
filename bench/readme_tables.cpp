#include "bench/readme_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <utility>

#include "bench/approximate_tables.h"
#include "bench/halfspaces.h"
#include "bench/joggle.h"
#include "bench/machine.h"
#include "bench/peers_table.h"
#include "bench/phases.h"
#include "bench/rays.h"
#include "bench/scaling_tables.h"
#include "bench/selections.h"
#include "bench/table.h"
#include "core/error.h"

namespace ndhull {
namespace {

// "`2000 s D5 t1`" for arguments of rbox; "diamonds, 53,940 x 7" for data in the unit cube.
std::string input_cell(const std::string& input, const nlohmann::json& points) {
  constexpr std::string_view kUnitCube = ", unit cube";
  const std::size_t end = input.find(kUnitCube);
  if (end == std::string::npos) return "`" + input + "`";
  return fmt::format("{}, {} x {}", input.substr(0, end),
                     grouped_number(points.at("points").get<std::uint64_t>()), points.at("dimension").dump());
}

std::string seconds_text(const Repeats& repeats) { return short_number(repeats.median_seconds()); }

Table approximate_table(const std::vector<RunRecord>& records) {
  Table table{.title = {},
              .note = {},
              .columns = {"input, options of both", "Qhull: facets, width (widest facet), s",
                          "ndhull, same options", "`--facets` as Qhull"},
              .rows = {},
              .left_columns = 4};
  for (const ApproximateGroup& group : approximate_groups(records)) {
    if (group.qhull.is_empty() || group.equal_options.is_empty() || group.equal_facets.is_empty()) continue;
    const RunRecord& qhull = group.qhull.done.back();
    const HullRun &ours = group.equal_options.last(), &same_facets = group.equal_facets.last();
    table.rows.push_back({input_cell(qhull.key.input, group.points) + ", " + qhull.key.options,
                          fmt::format("{}, {} ({}), {}", grouped_number(qhull.run.facets),
                                      short_number(width_of_all_facets(qhull.run)),
                                      short_number(qhull.run.max_facet_width), seconds_text(group.qhull)),
                          fmt::format("{}, {}, {}", grouped_number(ours.facets),
                                      short_number(ours.max_facet_width), seconds_text(group.equal_options)),
                          fmt::format("{}, {} s", short_number(same_facets.max_facet_width),
                                      seconds_text(group.equal_facets))});
  }
  return table;
}

Table targets_table(const std::vector<RunRecord>& records) {
  Table table{.title = {},
              .note = {},
              .columns = {"input", "exact", "`--width 1%`", "5%", "20%"},
              .rows = {},
              .left_columns = 5};
  for (const ApproximateGroup& group : approximate_groups(records)) {
    if (group.target("exact").is_empty() || !group.target("exact").done.back().is_complete()) continue;
    std::vector<std::string> row{input_cell(group.name, group.points)};
    for (const char* target : {"exact", "width 1%", "width 5%", "width 20%"}) {
      const Repeats& repeats = group.target(target);
      row.push_back(repeats.is_empty() ? "-"
                                       : fmt::format("{} in {} s", grouped_number(repeats.last().facets),
                                                     seconds_text(repeats)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table thorough_table(const std::vector<RunRecord>& records) {
  Table table{.title = {},
              .note = {},
              .columns = {"input", "`--width 1% --effort thorough`", "2%", "5%", "10%", "20%"},
              .rows = {},
              .left_columns = 6};
  for (const ApproximateGroup& group : approximate_groups(records)) {
    if (group.thorough.empty()) continue;
    std::vector<std::string> row{input_cell(group.name, group.points)};
    for (const char* width : {"width 1%", "width 2%", "width 5%", "width 10%", "width 20%"}) {
      const Repeats& quick = group.target(width);
      const auto found = std::find_if(group.thorough.begin(), group.thorough.end(), [&](const auto& runs) {
        return runs.first == std::string(width) + " thorough";
      });
      if (found == group.thorough.end() || found->second.is_empty() || quick.is_empty()) {
        row.push_back("-");
        continue;
      }
      row.push_back(fmt::format(
          "{} in {} s, {:.2f}", grouped_number(found->second.last().facets), seconds_text(found->second),
          static_cast<double>(found->second.last().facets) / static_cast<double>(quick.last().facets)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table exact_table(const std::vector<RunRecord>& records) {
  Table table{.title = {},
              .note = {},
              .columns = {"input", "facets", "width", "ndhull s", "MiB", "Qhull s", "MiB", "times faster"},
              .rows = {}};
  std::vector<std::pair<std::string, std::pair<Repeats, Repeats>>> inputs;  // ndhull, Qhull
  for (const RunRecord& record : records) {
    const bool is_peer = record.key.engine == "ndhull" || record.key.engine == "qhull";
    if (record.command != "peers" || !is_peer) continue;
    auto input = std::find_if(inputs.begin(), inputs.end(),
                              [&](const auto& candidate) { return candidate.first == record.key.input; });
    if (input == inputs.end()) {
      inputs.emplace_back(record.key.input, std::pair<Repeats, Repeats>());
      input = inputs.end() - 1;
    }
    add_repeat(record, record.key.engine == "ndhull" ? input->second.first : input->second.second);
  }
  const auto mebibytes = [](const Repeats& repeats) {
    return fmt::format("{:.0f}", static_cast<double>(repeats.peak_bytes()) / (1024.0 * 1024.0));
  };
  for (const auto& [name, runs] : inputs) {
    const auto& [ndhull, qhull] = runs;
    if (ndhull.is_empty() || (qhull.is_empty() && qhull.failure.empty())) continue;
    std::vector<std::string> row{
        input_cell(name, ndhull.done.back().points), grouped_number(ndhull.last().facets),
        fmt::format("{:.1e}", ndhull.last().max_facet_width), seconds_text(ndhull), mebibytes(ndhull)};
    if (qhull.is_empty()) {
      row.insert(row.end(), {qhull.failure, "-", "-"});
    } else {
      row.insert(row.end(), {seconds_text(qhull), mebibytes(qhull),
                             fmt::format("{:.1f}", qhull.median_seconds() / ndhull.median_seconds())});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// The table of the report with this title, or none.
Table table_titled(const std::vector<Table>& tables, const std::string& start) {
  for (const Table& table : tables) {
    if (table.title.starts_with(start)) return table;
  }
  return {};
}

using MakeTable = std::function<Table(const std::vector<RunRecord>&)>;

const std::vector<std::pair<std::string, MakeTable>>& makers() {
  using Records = std::vector<RunRecord>;
  static const std::vector<std::pair<std::string, MakeTable>> kMakers{
      {"approximate", approximate_table},
      {"targets", targets_table},
      {"thorough", thorough_table},
      {"exact", exact_table},
      {"halfspaces", halfspaces_table},
      {"few planes", [](const Records& r) { return table_titled(selections_tables(r), "What "); }},
      {"volume", [](const Records& r) { return table_titled(selections_tables(r), "A number"); }},
      {"expected", [](const Records& r) { return table_titled(scaling_tables(r), "Measured"); }},
      {"rays", [](const Records& r) { return table_titled(rays_tables(r), "The largest"); }},
      {"big sets", [](const Records& r) { return table_titled(rays_tables(r), "Sets"); }},
      {"joggled cube", [](const Records& r) { return table_titled(joggle_tables(r), "Joggled"); }},
      {"joggled surface", [](const Records& r) { return table_titled(joggle_tables(r), "1000"); }},
  };
  return kMakers;
}

std::string machine_lines(const std::vector<RunRecord>& records) {
  std::set<std::string> machines;
  for (const RunRecord& record : records) {
    if (!record.machine.is_null()) machines.insert(machine_line(record.machine));
  }
  std::string text;
  for (const std::string& machine : machines) text += machine + "\n";
  return text;
}

[[noreturn]] void refuse_marker(const std::string& path, std::size_t line) {
  throw Error(ErrorCode::kBadHeader,
              fmt::format("{}, line {}: a table begins here without an end, or ends without a beginning",
                          path, line));
}

}  // namespace

std::string readme_table(const std::string& name, const std::vector<RunRecord>& records) {
  if (name == "machine") return machine_lines(records);
  std::string names = "machine";
  for (const auto& [known, make] : makers()) {
    names += ", " + known;
    if (known != name) continue;
    const Table table = make(records);
    if (table.rows.empty())
      throw Error(ErrorCode::kUsage, fmt::format("the results have nothing for the table \"{}\"", name));
    return table.markdown_rows();
  }
  throw Error(ErrorCode::kUsage, fmt::format("no table is called \"{}\": there are {}", name, names));
}

std::string with_readme_tables(const std::string& text, const std::string& path,
                               const std::vector<RunRecord>& records) {
  constexpr std::string_view kBegin = "<!-- table: ", kClose = " -->", kEnd = "<!-- end of table -->";
  std::istringstream lines(text);
  std::string result, name;
  std::size_t number = 0, begin = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const bool is_begin = line.starts_with(kBegin) && line.ends_with(kClose);
    if (line == kEnd ? begin == 0 : is_begin && begin > 0) refuse_marker(path, number);
    if (line == kEnd) {
      result += readme_table(name, records);
      begin = 0;
    } else if (is_begin) {
      name = line.substr(kBegin.size(), line.size() - kBegin.size() - kClose.size());
      result += line + "\n";
      begin = number;
      continue;
    }
    if (begin == 0) result += line + "\n";
  }
  if (begin > 0) refuse_marker(path, begin);
  return result;
}

}  // namespace ndhull
