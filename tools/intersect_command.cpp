#include "tools/intersect_command.h"

#include <fmt/format.h>

#include <memory>

#include "core/error.h"
#include "tools/command_line/byte_count.h"
#include "tools/command_line/command_options.h"
#include "tools/intersect_run.h"
#include "tools/io/intersection_writer.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

/// The options as they are written; `request` has the others.
struct IntersectArguments {
  IntersectRequest request;
  std::string interior_point, max_memory, format;
};

/// Numbers parted by blanks or commas.
std::vector<double> parse_point(const std::string& text) {
  std::vector<double> point;
  const char* place = text.data();
  const char* const end = place + text.size();
  const auto is_separator = [](char letter) { return letter == ' ' || letter == ',' || letter == '\t'; };
  while (true) {
    while (place != end && is_separator(*place)) ++place;
    if (place == end) return point;
    double value = 0.0;
    const char* const next = parse_number(place, end, value);
    if (next == nullptr || (next != end && !is_separator(*next))) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("--interior-point: found \"{}\", expected finite numbers parted by blanks",
                              printable(text)));
    }
    point.push_back(value);
    place = next;
  }
}

void add_options(CLI::App& command, IntersectArguments& arguments) {
  IntersectRequest& request = arguments.request;
  IntersectionOptions& options = request.options;
  command
      .add_option("--interior-point", arguments.interior_point,
                  "a point strictly inside, \"x y ..\"; by default the centre of a largest ball")
      ->type_name("POINT");
  add_file_option(command, "--vertices", request.vertices_path,
                  "write the vertices: .npy, .csv, .tsv, .ext or Qhull text");
  CLI::Option* const report =
      add_report_option(command, request.report_path, "write the report, JSON, with volume and area");
  command.add_flag("--vertex-list", request.vertex_list, "put every vertex into the report")->needs(report);
  command
      .add_option("--format", arguments.format,
                  "print as qhalf does, any of " + describe_intersection_formats())
      ->type_name("LIST");
  command.add_option("--max-facets", options.limits.max_facets, "limit: vertices, coincident ones apart")
      ->type_name("N")
      ->check(whole_number(1));
  command
      .add_option("--max-seconds", options.limits.max_seconds,
                  "limit: seconds of finding vertices, volume and area")
      ->type_name("S")
      ->check(positive_number());
  command
      .add_option("--max-memory", arguments.max_memory, "limit: memory of the tables, like 4G, 512M or 65536")
      ->type_name("B")
      ->check(some_text());
  add_threads_option(command, options.threads);
  add_seed_option(command, options.seed, kOfShifts);
  add_progress_options(command, request.progress, request.quiet);
}

IntersectRequest complete_request(const CLI::App& command, const IntersectArguments& arguments) {
  IntersectRequest request = arguments.request;
  if (command.count("--interior-point") > 0)
    request.options.interior_point = parse_point(arguments.interior_point);
  if (!arguments.max_memory.empty()) {
    request.options.limits.max_memory_bytes = parse_byte_count(arguments.max_memory, "--max-memory");
  }
  if (command.count("--format") > 0)
    request.formats = split_formats(arguments.format, intersection_formats());
  return request;
}

}  // namespace

void add_intersect_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<IntersectArguments>();
  CLI::App* const command = app.add_subcommand(
      "intersect", "What halfspaces a.x + b <= 0 have in common: vertices, volume, or why there are none.");
  add_path_argument(*command, "HALFSPACES", arguments->request.halfspaces_path,
                    "halfspaces: a file, or - for standard input")
      ->required();
  add_options(*command, *arguments);
  command->footer(
      "HALFSPACES: .ine (cdd, lrs), .npy (rows normal, offset), Qhull text or columns. Rows of .ine that "
      "the\n"
      "option linearity names are equations: their weight in a proof may be negative. A point \"d 1\" in "
      "front\n"
      "is taken for --interior-point. Halfspaces and vertices count from 0. FILE may be - for standard "
      "output.\n"
      "The intersection is bounded, unbounded (with a direction), empty (with a combination of halfspaces\n"
      "that proves it) or lower-dimensional (with equations): `status` in the report, and the summary, say "
      "which.\n"
      "Exit code: 0 written, 1 usage or input, or vertices were asked for and there are none, 3 internal\n"
      "error, 130 interrupted and written.\n" +
      example("ndhull hull points.npy --planes - | ndhull intersect - --vertices corners.npy"));
  command->callback([arguments, command, &exit_code] {
    exit_code = run_intersect(complete_request(*command, *arguments));
  });
}

}  // namespace ndhull
