// Steps in order: read, find the vertices, choose (the library), verify, write. Nothing is opened for writing
// before the input is known to be good, and every file appears whole or not at all.
#include "tools/extreme_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "approx/planes/plane_check.h"
#include "approx/reduction/kept_points.h"
#include "approx/report.h"
#include "approx/report_json.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "core/machine/stopwatch.h"
#include "core/plane_value.h"
#include "tools/command_line/byte_count.h"
#include "tools/command_line/exit_code.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/summary_text.h"
#include "tools/io/file_bytes.h"
#include "tools/io/index_writer.h"
#include "tools/io/npy_header.h"
#include "tools/io/output_file.h"
#include "tools/io/plane_writer.h"
#include "tools/io/point_reader.h"

namespace ndhull {
namespace {

std::vector<NamedOutput> outputs_of(const ExtremeRequest& request) {
  std::vector<NamedOutput> outputs;
  add_output(outputs, "--vertices", request.vertices_path, OutputKind::kNumbers);
  add_output(outputs, "--planes", request.planes_path, OutputKind::kPlanes);
  add_output(outputs, "--distances", request.distances_path, OutputKind::kNumbers);
  add_output(outputs, "--report", request.report_path);
  return outputs;
}

/// What the steps hand on to what is written.
struct Outcome {
  ExtremePoints found;
  std::optional<KeptPoints> kept;
  /// [distance] of all points from the hull of those kept. Nothing: it is not known, since what was searched
  /// for vertices was not all, and points outside may be none of those found.
  std::optional<double> max_distance;
  std::vector<double> distances;
  double read_seconds = 0.0, keep_seconds = 0.0, verify_seconds = 0.0, total_seconds = 0.0;
  bool is_verified = false;
};

/// Each vertex is above its own plane, and as many points are above planes as there are vertices and copies
/// of them: so nothing else is. Returns the first failure, or nothing.
std::string check_partings(const PointView& points, const ExtremePoints& found, unsigned threads) {
  const std::size_t columns = found.dimension + 1;
  std::vector<double> point(found.dimension);
  std::uint64_t expected = 0;
  for (std::size_t row = 0; row * columns < found.planes.size(); ++row) {
    const std::span<const double> plane(found.planes.data() + row * columns, columns);
    points.copy_row(found.vertices[row].value, point.data());
    const CentredPlane halfspace{plane.first(found.dimension), {}, plane[found.dimension], 0.0, 1.0};
    if (!(plane_sign(halfspace, point, DoubtfulSign::kExtendedThenExact) > 0.0)) {
      return fmt::format("vertex {} is not above its plane", found.vertices[row].value);
    }
    expected += found.copies[row];
  }
  if (found.planes.empty()) return {};
  const PlaneCheck check = check_planes(points, found.planes, threads);
  if (check.above == expected) return {};
  return fmt::format("{} points are above planes of vertices, expected {}", check.above, expected);
}

void write_numbers(const std::string& path, const std::vector<double>& numbers) {
  OutputFile file(path);
  if (extension_of(path) == "npy") {
    file.write(make_npy_header("<f8", {numbers.size()}));
    file.write({reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)});
  } else {
    for (const double number : numbers) file.print("{:.17g}\n", number);
  }
  file.commit();
}

void write_results(const ExtremeRequest& request, const Outcome& outcome) {
  const ExtremePoints& found = outcome.found;
  if (!request.vertices_path.empty()) {
    write_indices(request.vertices_path, outcome.kept.has_value() ? outcome.kept->points : found.vertices);
  }
  if (!request.planes_path.empty()) {
    const std::size_t columns = found.dimension + 1;
    write_planes(request.planes_path, found.planes.size() / columns, found.dimension,
                 [&found, columns](std::size_t index, double* row) {
                   std::copy_n(found.planes.data() + index * columns, columns, row);
                 });
  }
  if (!request.distances_path.empty()) write_numbers(request.distances_path, outcome.distances);
}

bool knows_all_vertices(const ExtremePoints& found) {
  return found.status == ExtremeStatus::kComplete && found.open_points == 0;
}

/// Chooses among the vertices found.
void keep(const PointView& points, const ExtremeRequest& request, Outcome& outcome) {
  const ExtremePoints& found = outcome.found;
  if (!request.distances_path.empty()) outcome.distances.assign(points.rows, HUGE_VAL);
  if (found.vertices.empty()) return;  // a limit may leave none
  outcome.kept = keep_points(
      points, found.vertices, found.interior_point,
      {.count = request.keep, .stop = request.options.stop, .progress = request.options.progress});
  if (knows_all_vertices(found)) outcome.max_distance = outcome.kept->distances.back();
  if (request.distances_path.empty()) return;
  outcome.distances = distances_from_hull(points, outcome.kept->points, found.interior_point);
  if (!outcome.max_distance) outcome.max_distance = *std::ranges::max_element(outcome.distances);
}

std::string report_json(const ExtremeRequest& request, const Outcome& outcome) {
  const ExtremePoints& found = outcome.found;
  Json json;
  json["ndhull"] = version();
  json["input"] = {{"path", request.points_path},
                   {"points", found.point_count},
                   {"dimension", found.dimension},
                   {"rank", found.rank}};
  json["status"] = to_string(found.status);
  json["options"] = {{"columns", std::visit(OptionToJson(), text_or_null(request.columns.list()))},
                     {"keep", limit(request.keep)},
                     {"max_seconds", limit(request.options.max_seconds)},
                     {"threads", request.options.threads},
                     {"vertices", std::visit(OptionToJson(), text_or_null(request.vertices_path))},
                     {"planes", std::visit(OptionToJson(), text_or_null(request.planes_path))},
                     {"distances", std::visit(OptionToJson(), text_or_null(request.distances_path))},
                     {"report", std::visit(OptionToJson(), text_or_null(request.report_path))},
                     {"verify", request.verify},
                     {"progress", request.progress},
                     {"quiet", request.quiet}};
  json["vertices"] = found.vertices.size();
  json["points_inside"] = found.points_inside;
  json["open_points"] = found.open_points;
  json["interior_point"] = found.interior_point;
  json["kept"] = nullptr;
  if (outcome.kept.has_value()) {
    Json ids = Json::array();
    for (const PointId id : outcome.kept->points) ids.push_back(id.value);
    json["kept"] = {{"count", outcome.kept->points.size()},
                    {"max_distance", outcome.max_distance ? Json(*outcome.max_distance) : Json(nullptr)},
                    {"max_distance_at_least", outcome.kept->lower},
                    {"points", std::move(ids)},
                    {"distances", knows_all_vertices(found) ? Json(outcome.kept->distances) : Json(nullptr)}};
  }
  json["verified"] = outcome.is_verified;
  json["seconds"] = {{"read", outcome.read_seconds},
                     {"search", found.seconds},
                     {"keep", outcome.keep_seconds},
                     {"verify", outcome.verify_seconds},
                     {"total", outcome.total_seconds}};
  json["peak_memory_bytes"] = peak_memory_bytes();
  return report_text(json) + '\n';
}

std::string summary(const ExtremeRequest& request, const Outcome& outcome) {
  const ExtremePoints& found = outcome.found;
  std::string text = fmt::format("extreme   {}: {} points in {}-d, {}\n", request.points_path,
                                 grouped(found.point_count), found.dimension, to_string(found.status));
  if (found.rank < found.dimension) {
    text += fmt::format("rank      {}: the points lie in a {}-d subspace\n", found.rank, found.rank);
  }
  text += fmt::format("vertices  {}; {} other distinct points are inside\n", grouped(found.vertices.size()),
                      grouped(found.points_inside));
  if (found.open_points > 0) text += fmt::format("open      {} points\n", grouped(found.open_points));
  if (outcome.kept.has_value()) {
    text += fmt::format("kept      {}: ", grouped(outcome.kept->points.size()));
    text += outcome.max_distance
                ? fmt::format("every point is within {:.6g} [input] of their hull", *outcome.max_distance)
                : "how far points are from their hull is known with --distances only, since some are open";
    text += fmt::format(", one not within {:.6g}\n", outcome.kept->lower);
  }
  text += fmt::format("time      {:.2f} s: read {:.2f}, search {:.2f}, keep {:.2f}\n", outcome.total_seconds,
                      outcome.read_seconds, found.seconds, outcome.keep_seconds);
  text += fmt::format("memory    {}\n", format_byte_count(peak_memory_bytes()));
  if (outcome.is_verified) text += "verified  a plane parts each vertex from all other points\n";
  return text;
}

}  // namespace

int run_extreme(const ExtremeRequest& asked) {
  const Clock::time_point start = Clock::now();
  ExtremeRequest request = asked;
  const std::vector<NamedOutput> outputs = outputs_of(request);
  check_outputs_differ(outputs);
  Interrupt interrupt;
  ProgressLine progress(request.progress, request.quiet);
  tbb::task_arena arena = arena_of(request.options.threads);
  progress.show_phase("read");
  const PointFile points = arena.execute([&] { return read_points(request.points_path, request.columns); });
  check_outputs_are_writable(outputs, {request.points_path});
  request.options.threads = static_cast<unsigned>(arena.max_concurrency());
  request.options.stop = interrupt.token();
  if (progress.is_shown()) {
    request.options.progress = [&progress](std::string_view words) { progress.show_phase(words); };
  }
  Outcome outcome;
  outcome.read_seconds = seconds_since(start);

  interrupt.arm();
  outcome.found = extreme_points(points.view(), request.options);
  const ExtremePoints& found = outcome.found;
  if (request.keep > 0) {
    const Clock::time_point keep_start = Clock::now();
    arena.execute([&] { keep(points.view(), request, outcome); });
    outcome.keep_seconds = seconds_since(keep_start);
  }
  if (request.verify) {
    progress.show_phase("verify");
    const Clock::time_point verify_start = Clock::now();
    const std::string failure = check_partings(points.view(), found, request.options.threads);
    outcome.verify_seconds = seconds_since(verify_start);
    outcome.is_verified = failure.empty();
    if (!failure.empty()) {
      progress.clear();
      fmt::print(stderr, "ndhull: verify: {}\n", failure);
      return kVerificationFailedExitCode;
    }
  }
  progress.show_phase("write");
  write_results(request, outcome);
  outcome.total_seconds = seconds_since(start);
  progress.clear();
  if (!request.report_path.empty()) write_text(request.report_path, report_json(request, outcome));
  if (!use_standard_output(outputs) && !request.quiet) write_text("-", summary(request, outcome));
  return interrupt.requested() ? kInterruptedExitCode : 0;
}

}  // namespace ndhull
