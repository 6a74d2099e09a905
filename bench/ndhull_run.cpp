#include "approx/polytope/outer_volume.h"
#include "bench/hull_run.h"

namespace ndhull {

void to_json(nlohmann::json& json, const HullRun& run) {
  json = {{"wall_seconds", run.wall_seconds},
          {"cpu_seconds", run.cpu_seconds},
          {"facets", run.facets},
          {"vertices", run.vertices},
          {"max_facet_width", run.max_facet_width},
          {"max_outer_offset", run.max_outer_offset},
          {"min_inner_offset", run.min_inner_offset},
          {"resident_bytes", run.resident_bytes},
          {"peak_bytes", run.peak_bytes},
          {"detail", run.detail}};
}

void from_json(const nlohmann::json& json, HullRun& run) {
  json.at("wall_seconds").get_to(run.wall_seconds);
  json.at("cpu_seconds").get_to(run.cpu_seconds);
  json.at("facets").get_to(run.facets);
  run.vertices = json.value("vertices", run.vertices);
  json.at("max_facet_width").get_to(run.max_facet_width);
  run.max_outer_offset = json.value("max_outer_offset", run.max_outer_offset);
  run.min_inner_offset = json.value("min_inner_offset", run.min_inner_offset);
  json.at("resident_bytes").get_to(run.resident_bytes);
  run.peak_bytes = json.value("peak_bytes", run.peak_bytes);
  run.detail = json.at("detail");
}

HullRun run_ndhull(const BenchInput& input, const HullOptions& options, bool with_outer_volume) {
  HullRun run;
  run.resident_bytes = resident_bytes();
  const Stopwatch watch;
  const Hull hull = convex_hull(input.points.view(), options);
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();
  run.peak_bytes = peak_resident_bytes();

  run.facets = hull.facet_count();
  run.vertices = hull.vertices.size();
  run.max_facet_width = hull.max_facet_width;
  run.max_outer_offset = hull.max_outer_offset;
  run.min_inner_offset = hull.min_inner_offset;
  nlohmann::json phases = nlohmann::json::array();
  for (std::size_t phase = 0; phase < hull.statistics.seconds.size(); ++phase) {
    phases.push_back({to_string(static_cast<Phase>(phase)), hull.statistics.seconds[phase]});
  }
  nlohmann::json details = nlohmann::json::array();
  for (const auto& [name, seconds] : hull.statistics.detail_seconds) details.push_back({name, seconds});
  const double asked = hull.chosen.width_asked > 0.0 ? hull.chosen.width_asked : hull.roundoff;
  run.detail = {{"status", to_string(hull.status)},
                {"points_outside", hull.points_outside},
                {"simplices", hull.simplex_count()},
                {"created_simplices", hull.statistics.created_simplices},
                {"insertions", hull.statistics.insertions},
                {"merges", hull.chosen.merges},
                {"outside_width", hull.chosen.outside_width},
                {"roundoff", hull.roundoff},
                {"width_ratio", asked > 0.0 ? nlohmann::json(hull.max_facet_width / asked) : nullptr},
                {"area", hull.area},
                {"volume", hull.volume},
                {"outer_volume", nullptr},
                {"phase_seconds", std::move(phases)},
                {"detail_seconds", std::move(details)}};
  if (with_outer_volume) {
    const OuterVolume outer =
        outer_volume(hull, {}, {.max_facets = affordable_simplices(hull)}, options.threads);
    if (outer.volume) run.detail["outer_volume"] = *outer.volume;
  }
  return run;
}

}  // namespace ndhull
