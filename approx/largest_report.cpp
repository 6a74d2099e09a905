#include "approx/largest_report.h"

#include <algorithm>

#include "approx/report_json.h"

namespace ndhull {
namespace {

Json options_of(const LargestReportContext& context) {
  const LargestOptions& options = context.options;
  Json json{{"count", options.count},
            {"min_area", limit(options.min_area)},
            {"method", to_string(options.method)},
            {"rays", limit(options.rays)},
            {"max_seconds", limit(options.max_seconds)},
            {"max_facets", limit(options.max_facets)},
            {"bounded", options.bounded},
            {"confidence", options.confidence},
            {"threads", options.threads},
            {"seed", options.seed}};
  for (const auto& [name, value] : context.program_options) json[name] = std::visit(OptionToJson{}, value);
  return json;
}

Json sample_of(const RaySample& sample) {
  if (sample.rays == 0) return nullptr;
  return {{"rays", sample.rays},
          {"open_rays", sample.open_rays},
          {"directions", sample.directions},
          {"facets_hit", sample.facets_hit},
          {"facets_found", sample.facets_found},
          {"climbs", sample.climbs},
          {"core_points", sample.core_points},
          {"confidence", sample.confidence},
          {"unseen_share", sample.unseen_share},
          {"unhit_share_estimate", sample.unhit_share},
          {"facets_estimate", sample.facets_estimate},
          {"led_by_one_ray", sample.led_by_one},
          {"led_by_two_rays", sample.led_by_two},
          {"recall_estimate", sample.recall.has_value() ? Json(*sample.recall) : Json(nullptr)}};
}

/// One facet; `full` with its plane and vertices.
Json facet_json(const LargestFacet& facet, const RaySample& sample, bool full) {
  Json json;
  if (full) {
    json["normal"] = facet.normal;
    json["offset"] = facet.offset;
    json["centred_offset"] = facet.centred_offset;
    json["outer_offset"] = facet.outer_offset;
    json["inner_offset"] = facet.inner_offset;
  }
  json["area"] = facet.area;
  json["area_is_whole"] = facet.area_is_whole;
  json["origin"] = to_string(facet.origin);
  if (sample.rays > 0) {
    json["hits"] = facet.hits;
    json["share"] = static_cast<double>(facet.hits) / static_cast<double>(sample.rays);
    json["share_interval"] = {facet.share.low, facet.share.high};
    json["leads"] = facet.leads;
  }
  if (full) {
    Json vertices = Json::array();
    for (const PointId id : facet.vertices) vertices.push_back(id.value);
    json["vertices"] = std::move(vertices);
  }
  return json;
}

/// A list with one line a facet, put in place of the head's last brace.
void append_list(std::string& text, std::string_view key, const LargestFacets& found, bool full) {
  text.resize(text.size() - std::string_view("\n}").size());
  text += ",\n  \"" + std::string(key) + "\": [";
  for (std::size_t row = 0; row < found.facets.size(); ++row) {
    text += row == 0 ? "\n    " : ",\n    ";
    text += facet_json(found.facets[row], found.sample, full).dump();
  }
  text += "\n  ]\n}";
}

}  // namespace

std::string largest_report_json(const LargestFacets& found, const LargestReportContext& context) {
  double max_outer = 0.0, min_inner = 0.0, max_width = 0.0;
  for (const LargestFacet& facet : found.facets) {
    max_outer = std::max(max_outer, facet.outer_offset);
    min_inner = std::min(min_inner, facet.inner_offset);
    max_width = std::max(max_width, facet.outer_offset - facet.inner_offset);
  }
  Json json;
  json["ndhull"] = version();
  json["input"] = {{"path", context.input_path},
                   {"points", found.point_count},
                   {"dimension", found.dimension},
                   {"rank", found.rank}};
  json["status"] = to_string(found.status);
  json["method"] = to_string(found.method);
  json["options"] = options_of(context);
  json["length_unit"] = "input";
  json["facets"] = found.largest_count;
  json["selected"] = {{"facets", found.facets.size()},
                      {"bounded", found.is_bounded.has_value() ? Json(*found.is_bounded) : Json(nullptr)}};
  json["largest_area"] = found.largest_count > 0 ? Json(found.facets.front().area) : Json(nullptr);
  json["smallest_area"] =
      found.largest_count > 0 ? Json(found.facets[found.largest_count - 1].area) : Json(nullptr);
  json["roundoff"] = found.roundoff;
  json["max_outer_offset"] = max_outer;
  json["min_inner_offset"] = min_inner;
  json["max_facet_width"] = max_width;
  json["interior_point"] = found.interior_point;
  json["reference"] = found.reference;
  if (!found.subspace_equations.empty()) {
    Json equations = Json::array();
    const auto columns = static_cast<std::ptrdiff_t>(found.dimension);
    for (auto row = found.subspace_equations.begin(); row != found.subspace_equations.end();
         row += columns + 1) {
      equations.push_back({{"normal", std::vector<double>(row, row + columns)}, {"offset", row[columns]}});
    }
    json["subspace_equations"] = std::move(equations);
  }
  json["sample"] = sample_of(found.sample);
  if (context.verification != nullptr) {
    json["verification"] = {{"pairs", context.verification->pairs}, {"above", context.verification->above}};
  }
  json["seconds"] = {{"read", context.read_seconds},     {"search", found.search_seconds},
                     {"certify", found.certify_seconds}, {"verify", context.verify_seconds},
                     {"write", context.write_seconds},   {"total", context.total_seconds}};
  json["peak_memory_bytes"] = context.peak_memory_bytes;
  std::string text = report_text(json);
  append_list(text, "largest", found, false);
  if (context.facet_list) append_list(text, "facet_list", found, true);
  return text + '\n';
}

}  // namespace ndhull
