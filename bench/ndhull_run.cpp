#include "approx/hull.h"
#include "bench/hull_run.h"

namespace ndhull {

void to_json(nlohmann::json& json, const HullRun& run) {
  json = {{"wall_seconds", run.wall_seconds},
          {"cpu_seconds", run.cpu_seconds},
          {"facets", run.facets},
          {"max_facet_width", run.max_facet_width},
          {"resident_bytes", run.resident_bytes},
          {"detail", run.detail}};
}

void from_json(const nlohmann::json& json, HullRun& run) {
  json.at("wall_seconds").get_to(run.wall_seconds);
  json.at("cpu_seconds").get_to(run.cpu_seconds);
  json.at("facets").get_to(run.facets);
  json.at("max_facet_width").get_to(run.max_facet_width);
  json.at("resident_bytes").get_to(run.resident_bytes);
  run.detail = json.at("detail");
}

HullRun run_ndhull(const BenchInput& input, bool unit_cube, unsigned threads) {
  HullOptions options;
  options.unit_cube = unit_cube;
  options.threads = threads;
  HullRun run;
  run.resident_bytes = resident_bytes();
  const Stopwatch watch;
  const Hull hull = convex_hull(input.points.view(), options);
  run.wall_seconds = watch.wall_seconds();
  run.cpu_seconds = watch.cpu_seconds();

  run.facets = hull.facet_count();
  run.max_facet_width = hull.max_facet_width;
  nlohmann::json phases = nlohmann::json::array();
  for (std::size_t phase = 0; phase < hull.statistics.seconds.size(); ++phase) {
    phases.push_back({to_string(static_cast<Phase>(phase)), hull.statistics.seconds[phase]});
  }
  nlohmann::json details = nlohmann::json::array();
  for (const auto& [name, seconds] : hull.statistics.detail_seconds) details.push_back({name, seconds});
  run.detail = {{"status", to_string(hull.status)},
                {"points_outside", hull.points_outside},
                {"created_simplices", hull.statistics.created_simplices},
                {"phase_seconds", std::move(phases)},
                {"detail_seconds", std::move(details)}};
  return run;
}

}  // namespace ndhull
