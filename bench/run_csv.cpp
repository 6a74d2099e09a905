#include "bench/run_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/io/output_file.h"

namespace ndhull {
namespace {

using Field = std::pair<const char*, std::string>;

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char letter : text) field += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return field + "\"";
}

std::string text_of(const nlohmann::json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || object.at(key).is_null()) return {};
  const nlohmann::json& value = object.at(key);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::vector<Field> identity_of(const RunRecord& record) {
  return {{"command", record.command},
          {"input", record.key.input},
          {"family", text_of(record.points, "family")},
          {"dimension", text_of(record.points, "dimension")},
          {"points", text_of(record.points, "points")},
          {"seed", text_of(record.points, "seed")},
          {"engine", record.key.engine},
          {"options", record.key.options},
          {"threads", fmt::format("{}", record.key.threads)},
          {"end", record.end},
          {"reason", record.reason}};
}

std::vector<Field> figures_of(const Repeats& repeats) {
  std::vector<double> seconds;
  for (const RunRecord& record : repeats.done) seconds.push_back(record.run.wall_seconds);
  const auto [low, high] = std::minmax_element(seconds.begin(), seconds.end());
  const RunRecord record = repeats.is_empty() ? RunRecord{} : repeats.done.back();
  const HullRun& run = record.run;
  const auto number = [&](auto value) {
    return repeats.is_empty() ? std::string() : fmt::format("{}", value);
  };
  const auto detail = [&](const char* key) { return text_of(run.detail, key); };
  const auto phase = [&](const char* name) {
    return run.detail.contains("phase_seconds") ? number(phase_seconds(run, name)) : std::string();
  };
  return {{"runs", fmt::format("{}", repeats.done.size())},
          {"seconds_median", number(repeats.median_seconds())},
          {"seconds_min", repeats.is_empty() ? "" : number(*low)},
          {"seconds_max", repeats.is_empty() ? "" : number(*high)},
          {"growth_seconds", phase("growth")},
          {"certify_seconds", phase("certify")},
          {"merge_seconds", phase("merge")},
          {"status", detail("status")},
          {"facets", number(run.facets)},
          {"vertices", number(run.vertices)},
          {"simplices", detail("simplices")},
          {"created_simplices", detail("created_simplices")},
          {"max_outer_offset", number(run.max_outer_offset)},
          {"min_inner_offset", number(run.min_inner_offset)},
          {"max_facet_width", number(run.max_facet_width)},
          {"width_ratio", detail("width_ratio")},
          {"area", detail("area")},
          {"volume", detail("volume")},
          {"outer_volume", detail("outer_volume")},
          {"peak_bytes", number(repeats.peak_bytes())},
          {"bytes_per_facet", number(bytes_per_facet(record))}};
}

std::string joined(const std::vector<Field>& fields, bool header) {
  std::string line;
  for (const auto& [name, value] : fields)
    line += (line.empty() ? "" : ",") + (header ? name : csv_field(value));
  return line + "\n";
}

}  // namespace

std::vector<std::pair<RunRecord, Repeats>> measurements_of(const std::vector<RunRecord>& records) {
  std::vector<std::pair<RunRecord, Repeats>> measurements;
  std::map<RunKey, std::size_t> place_of;
  for (const RunRecord& record : records) {
    const auto [place, is_new] = place_of.emplace(record.key, measurements.size());
    if (is_new) measurements.emplace_back(record, Repeats{});
    add_repeat(record, measurements[place->second].second);
  }
  return measurements;
}

double bytes_per_facet(const RunRecord& record) {
  double facets = static_cast<double>(record.run.facets);
  if (record.run.detail.is_object()) facets = record.run.detail.value("simplices", facets);
  const double bytes =
      static_cast<double>(record.peak_bytes) - static_cast<double>(record.run.resident_bytes);
  return facets > 0.0 && bytes > 0.0 ? bytes / facets : 0.0;
}

double phase_seconds(const HullRun& run, const std::string& name) {
  if (!run.detail.is_object() || !run.detail.contains("phase_seconds")) return 0.0;
  for (const nlohmann::json& phase : run.detail.at("phase_seconds")) {
    if (phase.at(0) == name) return phase.at(1).get<double>();
  }
  return 0.0;
}

void write_csv(const std::vector<RunRecord>& records, const std::string& path) {
  OutputFile file(path);
  bool is_first = true;
  for (const auto& [record, repeats] : measurements_of(records)) {
    std::vector<Field> fields = identity_of(record);
    for (Field& field : figures_of(repeats)) fields.push_back(std::move(field));
    if (is_first) file.write(joined(fields, true));
    file.write(joined(fields, false));
    is_first = false;
  }
  file.commit();
}

}  // namespace ndhull
