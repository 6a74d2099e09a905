#include "bench/scaling_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "bench/expected_facets.h"
#include "bench/run_csv.h"
#include "bench/sample.h"

namespace ndhull {
namespace {

// Below, seconds and bytes are those of starting, not of facets.
constexpr double kManyFacetsForTime = 2000.0, kManyFacetsForBytes = 50000.0;
// A line through two points fits always.
constexpr std::size_t kFewestSamples = 3;

std::optional<double> expected_of(const std::string& family, std::size_t dimension, std::size_t points) {
  const PointFamily kind = point_family(family);
  if (!has_expected_facet_count(kind) || points <= dimension) return std::nullopt;
  return expected_facet_count(kind, dimension, points);
}

using Figure = std::function<std::optional<double>(const GrowthSample&)>;

const std::vector<std::pair<const char*, Figure>>& figures() {
  static const std::vector<std::pair<const char*, Figure>> all{
      {"facets", [](const GrowthSample& sample) { return std::optional(sample.facets); }},
      {"expected", [](const GrowthSample& sample) { return sample.expected_facets; }},
      {"seconds", [](const GrowthSample& sample) { return std::optional(sample.seconds); }},
      {"bytes", [](const GrowthSample& sample) {
         return sample.facets >= kManyFacetsForBytes ? std::optional(sample.bytes) : std::nullopt;
       }}};
  return all;
}

// The slope of log(figure) against x over samples with many facets, as text; "-" where there are fewer than
// two.
std::string fitted(const std::vector<GrowthSample>& samples, const Figure& figure,
                   const std::function<double(const GrowthSample&)>& x,
                   const std::function<std::string(double)>& text) {
  std::vector<double> xs, logs;
  for (const GrowthSample& sample : samples) {
    const std::optional<double> value = figure(sample);
    if (!value || *value <= 0.0) continue;
    xs.push_back(x(sample));
    logs.push_back(std::log(*value));
  }
  const std::optional<double> found = slope(xs, logs);
  return found && xs.size() >= kFewestSamples ? text(*found) : "-";
}

template <class Key>
std::map<Key, std::vector<GrowthSample>> grouped(const std::vector<GrowthSample>& samples,
                                                 const std::function<Key(const GrowthSample&)>& key) {
  std::map<Key, std::vector<GrowthSample>> groups;
  for (const GrowthSample& sample : samples) {
    if (sample.facets >= kManyFacetsForTime) groups[key(sample)].push_back(sample);
  }
  std::erase_if(groups, [](const auto& group) { return group.second.size() < kFewestSamples; });
  return groups;
}

Table counts_table(const std::vector<RunRecord>& records) {
  Table table{.title = "Measured and expected numbers of facets",
              .note =
                  "Means of ndhull over many seeds with their standard error; expected: the integral of "
                  "bench/expected_facets.h.",
              .columns = {"family", "d", "points", "seeds", "facets", "expected", "measured / expected"},
              .rows = {}};
  for (const RunRecord& record : records) {
    if (record.task != kCountsTask || !record.is_done()) continue;
    const nlohmann::json& detail = record.run.detail;
    const auto mean = detail.at("mean_facets").get<double>();
    const auto expected = detail.at("expected_facets").get<double>();
    table.rows.push_back({record.points.at("family").get<std::string>(), record.points.at("dimension").dump(),
                          grouped_number(record.points.at("points").get<std::uint64_t>()),
                          detail.at("seeds").dump(), fmt::format("{:.1f}", mean),
                          fmt::format("{:.1f}", expected),
                          fmt::format("{:.4f} +- {:.4f}", mean / expected,
                                      detail.at("standard_error").get<double>() / expected)});
  }
  return table;
}

Table points_table(const std::vector<GrowthSample>& samples) {
  Table table{
      .title = "Growth with the number of points",
      .note = "Exponents e of n^e, fitted to three or more hulls with 2,000 facets or more (bytes: 50,000).",
      .columns = {"engine, family", "d", "points"},
      .rows = {}};
  for (const auto& [name, figure] : figures()) table.columns.push_back(name);
  using Key = std::tuple<std::string, std::string, std::size_t>;
  for (const auto& [key, group] : grouped<Key>(samples, [](const GrowthSample& sample) {
         return Key{sample.engine, sample.family, sample.dimension};
       })) {
    std::vector<std::string> row{std::get<0>(key) + ", " + std::get<1>(key),
                                 fmt::format("{}", std::get<2>(key)),
                                 fmt::format("{} .. {}", group.front().points, group.back().points)};
    for (const auto& [name, figure] : figures()) {
      row.push_back(fitted(
          group, figure,
          [](const GrowthSample& sample) { return std::log(static_cast<double>(sample.points)); },
          [](double exponent) { return fmt::format("{:.2f}", exponent); }));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table dimension_table(const std::vector<GrowthSample>& samples) {
  Table table{.title = "Growth with the dimension",
              .note =
                  "Factors for one dimension more, fitted to three or more hulls with 2,000 facets or more "
                  "(bytes: 50,000).",
              .columns = {"engine, family", "points", "d"},
              .rows = {}};
  for (const auto& [name, figure] : figures()) table.columns.push_back(name);
  using Key = std::tuple<std::string, std::string, std::size_t>;
  for (const auto& [key, group] : grouped<Key>(samples, [](const GrowthSample& sample) {
         return Key{sample.engine, sample.family, sample.points};
       })) {
    std::vector<std::string> row{std::get<0>(key) + ", " + std::get<1>(key), grouped_number(std::get<2>(key)),
                                 fmt::format("{} .. {}", group.front().dimension, group.back().dimension)};
    for (const auto& [name, figure] : figures()) {
      row.push_back(fitted(
          group, figure, [](const GrowthSample& sample) { return static_cast<double>(sample.dimension); },
          [](double log_factor) { return fmt::format("{:.2f}", std::exp(log_factor)); }));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table facets_table(const std::vector<GrowthSample>& samples) {
  Table table{
      .title = "Growth with the number of facets",
      .note =
          "Exponents e of facets^e at one dimension, all families and numbers of points, fitted to hulls "
          "with 2,000 facets or more; 1 is proportional.",
      .columns = {"engine", "d", "facets", "seconds", "bytes"},
      .rows = {}};
  using Key = std::tuple<std::string, std::size_t>;
  for (const auto& [key, group] : grouped<Key>(samples, [](const GrowthSample& sample) {
         return Key{sample.engine, sample.dimension};
       })) {
    const auto [low, high] =
        std::minmax_element(group.begin(), group.end(),
                            [](const GrowthSample& a, const GrowthSample& b) { return a.facets < b.facets; });
    std::vector<std::string> row{std::get<0>(key), fmt::format("{}", std::get<1>(key)),
                                 fmt::format("{:.0f} .. {:.0f}", low->facets, high->facets)};
    for (const std::size_t figure : {2U, 3U}) {
      row.push_back(fitted(
          group, figures()[figure].second, [](const GrowthSample& sample) { return std::log(sample.facets); },
          [](double exponent) { return fmt::format("{:.2f}", exponent); }));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table threads_table(const std::vector<RunRecord>& records) {
  Table table{.title = "Threads",
              .note = "ndhull, exact hulls: seconds, and those of one thread over them.",
              .columns = {"input", "threads", "facets", "seconds", "times faster"},
              .rows = {}};
  std::map<std::string, std::map<unsigned, Repeats>> inputs;
  for (const auto& [record, repeats] : measurements_of(records)) {
    const bool is_exact = record.key.engine == "ndhull" && record.key.options == "exact";
    if (is_exact && !repeats.is_empty()) inputs[record.key.input][record.key.threads] = repeats;
  }
  for (const auto& [name, runs] : inputs) {
    if (runs.size() < 2 || !runs.contains(1)) continue;
    for (const auto& [threads, repeats] : runs) {
      table.rows.push_back({name, fmt::format("{}", threads), grouped_number(repeats.last().facets),
                            short_number(repeats.median_seconds()),
                            fmt::format("{:.2f}", runs.at(1).median_seconds() / repeats.median_seconds())});
    }
  }
  return table;
}

}  // namespace

std::vector<GrowthSample> growth_samples(const std::vector<RunRecord>& records) {
  using Key = std::tuple<std::string, std::string, std::size_t, std::size_t>;
  std::map<Key, GrowthSample> sums;
  for (const auto& [record, repeats] : measurements_of(records)) {
    const bool is_exact = record.key.options == "exact" && record.key.threads == 1;
    if (record.task == kCountsTask || !is_exact || repeats.is_empty() || !record.points.contains("family"))
      continue;
    if (!repeats.done.back().is_complete()) continue;
    const auto dimension = record.points.at("dimension").get<std::size_t>();
    const auto points = record.points.at("points").get<std::size_t>();
    const auto family = record.points.at("family").get<std::string>();
    GrowthSample& sum = sums[{record.key.engine, family, dimension, points}];
    sum.family = family;
    sum.engine = record.key.engine;
    sum.dimension = dimension;
    sum.points = points;
    ++sum.seeds;
    sum.facets += static_cast<double>(repeats.last().facets);
    sum.seconds += repeats.median_seconds();
    sum.bytes +=
        static_cast<double>(repeats.peak_bytes()) - static_cast<double>(repeats.last().resident_bytes);
  }
  std::vector<GrowthSample> samples;
  for (auto& [key, sample] : sums) {
    const auto count = static_cast<double>(sample.seeds);
    sample.facets /= count;
    sample.seconds /= count;
    sample.bytes /= count;
    sample.expected_facets = expected_of(sample.family, sample.dimension, sample.points);
    samples.push_back(std::move(sample));
  }
  return samples;
}

std::vector<Table> scaling_tables(const std::vector<RunRecord>& records) {
  const std::vector<GrowthSample> samples = growth_samples(records);
  std::vector<Table> tables{counts_table(records), points_table(samples), dimension_table(samples),
                            facets_table(samples), threads_table(records)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace ndhull
