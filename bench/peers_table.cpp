#include "bench/peers_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/sample.h"

namespace ndhull {
namespace {

/// One input, all engines.
struct Peers {
  std::string input;
  nlohmann::json points;
  std::map<std::string, Repeats> engines;

  const Repeats& runs_of(const std::string& engine) const {
    static const Repeats kNothing;
    const auto found = engines.find(engine);
    return found == engines.end() ? kNothing : found->second;
  }
  bool has_both(const std::string& engine) const {
    return !runs_of("ndhull").is_empty() && !runs_of(engine).is_empty();
  }
  double time_ratio(const std::string& engine) const {
    return runs_of(engine).median_seconds() / runs_of("ndhull").median_seconds();
  }
  double memory_ratio(const std::string& engine) const {
    return static_cast<double>(runs_of(engine).peak_bytes()) /
           static_cast<double>(runs_of("ndhull").peak_bytes());
  }
};

std::vector<Peers> peers_of(const std::vector<RunRecord>& records) {
  std::vector<Peers> all;
  for (const RunRecord& record : records) {
    if (record.command != "peers") continue;
    auto peers = std::find_if(all.begin(), all.end(),
                              [&](const Peers& candidate) { return candidate.input == record.key.input; });
    if (peers == all.end()) {
      all.push_back({record.key.input, record.points, {}});
      peers = all.end() - 1;
    }
    add_repeat(record, peers->engines[record.key.engine]);
  }
  return all;
}

std::vector<std::string> engine_cells(const Repeats& repeats) {
  if (repeats.is_empty()) return {"-", repeats.failure.empty() ? "-" : repeats.failure, "-", "-"};
  const HullRun& run = repeats.last();
  return {grouped_number(run.facets), fmt::format("{:.1e}", run.max_facet_width),
          short_number(repeats.median_seconds()),
          fmt::format("{:.0f}", static_cast<double>(repeats.peak_bytes()) / (1024.0 * 1024.0))};
}

Table table_for(const std::vector<Peers>& all, const std::string& engine) {
  const std::string name = engine == "qhull" ? "Qhull" : engine;
  Table table{
      .title = "ndhull and " + name,
      .note =
          "Exact hulls, one thread, medians; width: the widest facet, outer minus inner plane; MiB: peak of "
          "the process with the points. Ratios are " +
          name + " over ndhull.",
      .columns = {"input", "n", "d", "facets", "width", "ndhull s", "MiB", name + " facets", "width",
                  name + " s", "MiB", "times faster", "of one round", "memory"},
      .rows = {}};
  std::vector<double> time_ratios, memory_ratios;
  for (const Peers& peers : all) {
    const Repeats &ndhull = peers.runs_of("ndhull"), &other = peers.runs_of(engine);
    std::vector<std::string> row{peers.input, peers.points.value("points", nlohmann::json()).dump(),
                                 peers.points.value("dimension", nlohmann::json()).dump()};
    for (const Repeats* repeats : {&ndhull, &other}) {
      for (std::string& cell : engine_cells(*repeats)) row.push_back(std::move(cell));
    }
    if (peers.has_both(engine)) {
      row.insert(row.end(), {short_number(peers.time_ratio(engine)), ratio_spread(ndhull, other),
                             short_number(peers.memory_ratio(engine))});
    } else {
      row.insert(row.end(), {"-", "", "-"});
    }
    table.rows.push_back(std::move(row));
    if (peers.points.value("is_sphere_set", false) && peers.has_both(engine)) {
      time_ratios.push_back(peers.time_ratio(engine));
      memory_ratios.push_back(peers.memory_ratio(engine));
    }
  }
  if (!time_ratios.empty()) {
    std::vector<std::string> mean(table.columns.size());
    mean[0] = fmt::format("geometric mean of {} sphere sets", time_ratios.size());
    mean[11] = short_number(geometric_mean(time_ratios));
    mean[13] = short_number(geometric_mean(memory_ratios));
    table.rows.push_back(std::move(mean));
  }
  return table;
}

}  // namespace

std::vector<Table> peers_tables(const std::vector<RunRecord>& records) {
  const std::vector<Peers> all = peers_of(records);
  std::vector<std::string> engines;
  for (const Peers& peers : all) {
    for (const auto& [engine, repeats] : peers.engines) {
      if (engine != "ndhull" && std::find(engines.begin(), engines.end(), engine) == engines.end()) {
        engines.push_back(engine);
      }
    }
  }
  std::vector<Table> tables;
  for (const std::string& engine : engines) tables.push_back(table_for(all, engine));
  return tables;
}

}  // namespace ndhull
