// The head is one object of the JSON library; the list of facets, which may be a million lines long, is put
// in before its last brace, facet by facet.
#include "approx/report.h"

#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "approx/polytope/outer_volume.h"
#include "approx/report_json.h"
#include "approx/selection/facet_selection.h"
#include "approx/selection/outer_distance.h"
#include "approx/verify/verify.h"

namespace ndhull {
namespace {

/// [bytes] Text that is gathered before the sink gets it.
constexpr std::size_t kPieceSize = std::size_t{1} << 16;

Json length(const Length& asked) {
  if (!asked.is_set()) return nullptr;
  if (!asked.is_percent) return asked.value;
  std::array<char, 32> digits{};
  return std::string(digits.data(),
                     std::to_chars(digits.data(), digits.data() + digits.size(), asked.value).ptr) +
         "%";
}

const char* name_of(FacetObjective objective) {
  return objective == FacetObjective::kVolume ? "volume" : "width";
}

const char* name_of(Effort effort) { return effort == Effort::kThorough ? "thorough" : "quick"; }

/// What was chosen for the accuracy asked for; lengths resolved.
Json chosen_of(const AccuracyChosen& chosen) {
  return {{"objective", name_of(chosen.objective)},
          {"outside_width", chosen.outside_width},
          {"slab_width", limit(chosen.slab_width)},
          {"width_cap", limit(chosen.width_cap)},
          {"merges", chosen.merges},
          {"refused_merges", chosen.refused_merges}};
}

/// The largest width over the one that was asked for; when none was, over roundoff.
Json width_ratio_of(const Hull& hull) {
  const double asked = hull.chosen.width_asked > 0.0 ? hull.chosen.width_asked : hull.roundoff;
  return asked > 0.0 ? Json(hull.max_facet_width / asked) : Json(nullptr);
}

Json options_of(const ReportContext& context) {
  const HullOptions& options = context.options;
  const Accuracy& accuracy = options.accuracy;
  Json json{{"width", length(accuracy.width)},
            {"facets", limit(accuracy.facets)},
            {"objective", name_of(accuracy.objective)},
            {"effort", name_of(accuracy.effort)},
            {"outside_width", length(accuracy.outside_width)},
            {"centrum_radius", length(accuracy.centrum_radius)},
            {"max_cosine", accuracy.max_cosine <= 1.0 ? Json(accuracy.max_cosine) : Json(nullptr)},
            {"width_cap", length(accuracy.width_cap)},
            {"max_facets", limit(options.limits.max_facets)},
            {"max_seconds", limit(options.limits.max_seconds)},
            {"max_memory", limit(options.limits.max_memory_bytes)},
            {"unit_cube", options.unit_cube},
            {"triangulate", options.triangulate},
            {"threads", options.threads},
            {"seed", options.seed}};
  for (const auto& [name, value] : context.program_options) json[name] = std::visit(OptionToJson{}, value);
  return json;
}

Json seconds_of(const Hull& hull, const ReportContext& context) {
  Json json{{"read", context.read_seconds}};
  for (std::size_t phase = 0; phase < hull.statistics.seconds.size(); ++phase) {
    json[std::string(to_string(static_cast<Phase>(phase)))] = hull.statistics.seconds[phase];
  }
  json["select"] = context.select_seconds;
  json["outer_volume"] = context.outer_volume_seconds;
  json["verify"] = context.verify_seconds;
  json["write"] = context.write_seconds;
  json["total"] = context.total_seconds;
  return json;
}

Json statistics_of(const HullStatistics& statistics) {
  Json detail = Json::object();
  for (const auto& [name, seconds] : statistics.detail_seconds) detail[std::string(name)] = seconds;
  Json curve = Json::array();
  for (const GrowthRecord& record : statistics.growth_curve) {
    curve.push_back({{"seconds", record.seconds},
                     {"simplices", record.simplices},
                     {"points_left", record.points_left},
                     {"furthest", record.furthest}});
  }
  return {
      {"dropped_points", statistics.dropped_points}, {"created_simplices", statistics.created_simplices},
      {"created_facets", statistics.created_facets}, {"insertions", statistics.insertions},
      {"shifted_points", statistics.shifted_points}, {"rejected_insertions", statistics.rejected_insertions},
      {"repair_rounds", statistics.repair_rounds},   {"growth_curve", std::move(curve)},
      {"detail_seconds", std::move(detail)}};
}

Json verification_of(const Verification& verification) {
  Json claims = Json::object();
  for (std::size_t row = 0; row < verification.claims.size(); ++row) {
    const ClaimRecord& record = verification.claims[row];
    claims[std::string(to_string(static_cast<Claim>(row)))] = {
        {"checks", record.checks}, {"failures", record.failures}, {"complete", record.complete}};
  }
  return {{"mode", verification.mode == VerifyMode::kExact ? "exact" : "floating"},
          {"passed", verification.passed()},
          {"complete", verification.complete()},
          {"claims", std::move(claims)}};
}

/// dimension - rank objects {normal, offset}: normal.x + offset = 0 for every input point, up to roundoff.
Json subspace_of(const Hull& hull) {
  Json equations = Json::array();
  const std::vector<double>& rows = hull.subspace_equations;
  const auto columns = static_cast<std::ptrdiff_t>(hull.dimension);
  for (auto row = rows.begin(); row != rows.end(); row += columns + 1) {
    equations.push_back({{"normal", std::vector<double>(row, row + columns)}, {"offset", row[columns]}});
  }
  return equations;
}

Json selected_of(const FacetSelection& selection, const OuterDistance* outer) {
  const bool is_known = outer != nullptr && outer->distance.has_value();
  return {{"facets", selection.facets.size()},
          {"added", selection.added},
          {"cut_short", selection.is_cut_short},
          {"bounded", selection.bounded},
          {"open_direction", selection.bounded ? Json(nullptr) : Json(selection.open_direction)},
          {"outer_distance", is_known ? Json(*outer->distance) : Json(nullptr)}};
}

void add_outer_volume(const OuterVolume* outer, Json& json) {
  const bool is_known = outer != nullptr && outer->volume.has_value();
  json["outer_volume"] = is_known ? Json(*outer->volume) : Json(nullptr);
  if (!is_known) json["outer_volume_reason"] = outer != nullptr ? outer->reason : "not computed";
}

constexpr const char* kBeyondDoubles = "beyond the range of doubles";

Json head_of(const Hull& hull, const ReportContext& context) {
  Json json;
  json["ndhull"] = version();
  json["input"] = {{"path", context.input_path},
                   {"points", hull.point_count},
                   {"dimension", hull.dimension},
                   {"rank", hull.rank}};
  json["status"] = to_string(hull.status);
  json["options"] = options_of(context);
  if (!context.options.accuracy.is_exact()) json["chosen"] = chosen_of(hull.chosen);
  json["length_unit"] = context.options.unit_cube ? "unit-cube" : "input";
  json["vertices"] = hull.vertices.size();
  json["facets"] = hull.facet_count();
  json["simplicial_facets"] = hull.simplicial_facet_count();
  json["merged_facets"] = hull.facet_count() - hull.simplicial_facet_count();
  json["simplices"] = hull.simplex_count();
  if (context.selection != nullptr)
    json["selected"] = selected_of(*context.selection, context.outer_distance);
  const bool has_area = hull.rank < 2 || is_in_range(hull.area);
  const bool has_volume = hull.rank < 1 || is_in_range(hull.volume);
  json["area"] = has_area ? Json(hull.area) : Json(nullptr);
  if (!has_area) json["area_reason"] = kBeyondDoubles;
  json["volume"] = has_volume ? Json(hull.volume) : Json(nullptr);
  if (!has_volume) json["volume_reason"] = kBeyondDoubles;
  add_outer_volume(context.outer_volume, json);
  json["roundoff"] = hull.roundoff;
  json["max_outer_offset"] = hull.max_outer_offset;
  json["min_inner_offset"] = hull.min_inner_offset;
  json["max_facet_width"] = hull.max_facet_width;
  json["width_ratio"] = width_ratio_of(hull);
  json["max_outside_gauge"] = hull.max_outside_gauge;
  json["interior_point"] = hull.interior_point;
  json["points_outside"] = hull.points_outside;
  json["reference"] = hull.reference;
  if (hull.rank < hull.dimension) json["subspace_equations"] = subspace_of(hull);
  if (context.options.unit_cube) json["unit_cube_extents"] = hull.unit_cube_extents();
  if (context.verification != nullptr) json["verification"] = verification_of(*context.verification);
  json["statistics"] = statistics_of(hull.statistics);
  json["seconds"] = seconds_of(hull, context);
  json["peak_memory_bytes"] = context.peak_memory_bytes;
  return json;
}

/// JSON made by hand: the JSON library would build a tree for every facet.
class FacetLines {
 public:
  explicit FacetLines(const Hull& hull) : hull_(hull) {}

  void append(FacetId facet, bool with_id, std::string& text) const {
    text += '{';
    if (with_id) {
      append_number("\"id\": ", facet.value, text);
      text += ", ";
    }
    text += "\"normal\": ";
    append_all(hull_.normal(facet), text, [](double value) { return value; });
    append_number(", \"offset\": ", hull_.offset(facet), text);
    append_number(", \"centred_offset\": ", hull_.centred_offset(facet), text);
    append_number(", \"outer_offset\": ", hull_.outer_offset(facet), text);
    append_number(", \"inner_offset\": ", hull_.inner_offset(facet), text);
    append_number(", \"area\": ", hull_.area_of(facet), text);
    text += ", \"vertices\": ";
    append_all(hull_.vertices_of(facet), text, [](PointId id) { return id.value; });
    text += ", \"neighbors\": ";
    append_all(hull_.neighbours_of(facet), text, [](FacetId id) { return id.value; });
    append_number(", \"simplices\": ", hull_.simplex_count_of(facet), text);
    text += '}';
  }

 private:
  template <class Value>
  static void append_number(std::string_view key, Value value, std::string& text) {
    text += key;
    if constexpr (std::is_floating_point_v<Value>) {
      if (!std::isfinite(value)) {
        text += "null";
        return;
      }
    }
    char digits[32];  // the shortest that reads back: at most 24 characters
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
  template <class T, class Number>
  static void append_all(std::span<const T> values, std::string& text, const Number& number) {
    text += '[';
    for (std::size_t k = 0; k < values.size(); ++k)
      append_number(k == 0 ? "" : ", ", number(values[k]), text);
    text += ']';
  }

  const Hull& hull_;
};

}  // namespace

std::string_view version() { return NDHULL_VERSION; }

void write_hull_report(const Hull& hull, const ReportContext& context,
                       const std::function<void(std::string_view)>& sink) {
  std::string text = report_text(head_of(hull, context));
  if (context.facet_list) {
    text.resize(text.size() - std::string_view("\n}").size());
    text += ",\n  \"facet_list\": [";
    const FacetLines lines(hull);
    const FacetSelection* const selection = context.selection;
    const std::size_t count = selection != nullptr ? selection->facets.size() : hull.facet_count();
    for (std::uint32_t row = 0; row < count; ++row) {
      text += row == 0 ? "\n    " : ",\n    ";
      lines.append(selection != nullptr ? selection->facets[row] : FacetId{row}, selection != nullptr, text);
      if (text.size() < kPieceSize) continue;
      sink(text);
      text.clear();
    }
    text += "\n  ]\n}";
  }
  text += '\n';
  sink(text);
}

std::string hull_report_json(const Hull& hull, const ReportContext& context) {
  std::string json;
  write_hull_report(hull, context, [&json](std::string_view piece) { json += piece; });
  return json;
}

// Of this program alone: what getrusage tells begins with the memory of the program that has started it.
std::uint64_t peak_memory_bytes() {
  if (std::FILE* const file = std::fopen("/proc/self/status", "r"); file != nullptr) {
    unsigned long long kilobytes = 0;
    bool is_read = false;
    for (char line[256]; !is_read && std::fgets(line, sizeof line, file) != nullptr;)
      is_read = std::sscanf(line, "VmHWM: %llu", &kilobytes) == 1;
    std::fclose(file);
    if (is_read) return kilobytes * 1024;
  }
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  constexpr std::uint64_t kUnit = 1;
#else
  constexpr std::uint64_t kUnit = 1024;
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * kUnit;
}

std::uint64_t resident_memory_bytes() {
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  unsigned long long pages = 0;
  const bool is_read = std::fscanf(file, "%*u %llu", &pages) == 1;
  std::fclose(file);
  return is_read ? pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace ndhull
