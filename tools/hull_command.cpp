#include "tools/hull_command.h"

#include <fmt/format.h>

#include <memory>

#include "core/error.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/hull_options.h"
#include "tools/command_line/selection_options.h"
#include "tools/io/qhull_formats.h"

namespace ndhull {
namespace {

/// The options as they are written; `request` has the others.
struct HullArguments {
  HullRequest request;
  HullOptionSet hull;
  std::string format, verify;
};

void add_output_options(CLI::App& command, HullArguments& arguments) {
  HullRequest& request = arguments.request;
  add_plane_options(command, request.planes_path, request.plane_kind, request.equations);
  add_file_option(command, "--vertices", request.vertices_path,
                  "write the indices of the vertices, from 0: .npy, .csv, or text after their number");
  CLI::Option* const report = add_report_option(command, request.report_path);
  command.add_flag("--facet-list", request.facet_list, "put every facet into the report")->needs(report);
  add_file_option(
      command, "--curve", request.curve_path,
      "write facets against certified width, from this hull to coarser ones: FILE.csv and FILE.svg");
  command.add_flag(
      "--outer-volume", request.outer_volume,
      "volume below the outer planes, whatever it takes within --max-seconds; default: when it costs "
      "little");
  command
      .add_option("--format", arguments.format,
                  "print Qhull's text formats, any of " + hull_formats().joined())
      ->type_name("LIST");
  command
      .add_option(
          "--verify", arguments.verify,
          "check the hull independently before it is written; `--verify exact`: signs in exact arithmetic. "
          "What takes long is checked by samples; the summary and the report say so. No limit on time holds "
          "for it")
      ->type_name("[exact]")
      ->check(one_of({"floating", "exact"}));
  add_progress_options(command, request.progress, request.quiet);
}

/// Reads what CLI11 left as text.
HullRequest complete_request(const CLI::App& command, const HullArguments& arguments) {
  HullRequest request = arguments.request;
  if (request.points_path.empty() == request.shards_pattern.empty()) {
    throw Error(ErrorCode::kUsage, fmt::format("found {}, expected POINTS or --points-sharded PATTERN",
                                               request.points_path.empty() ? "no points" : "both"));
  }
  request.options = arguments.hull.complete();
  check_selection(request.selection);
  if (command.count("--format") > 0) request.formats = split_qhull_formats(arguments.format);
  if (!arguments.verify.empty()) {
    request.verify = arguments.verify == "exact" ? VerifyMode::kExact : VerifyMode::kFloating;
  }
  return request;
}

}  // namespace

void add_hull_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<HullArguments>();
  CLI::App* const command = app.add_subcommand(
      "hull",
      "The convex hull of points, with certified planes; prints a summary where standard output is free.");
  add_points_argument(*command, arguments->request.points_path);
  CLI::Option* const columns = add_columns_option(*command, arguments->request.columns);
  command
      ->add_option(
          "--points-sharded", arguments->request.shards_pattern,
          "instead of POINTS: the points of all files of this pattern, in the order of their names; with "
          "mpirun each process reads a share of them")
      ->type_name("PATTERN")
      ->check(some_text())
      ->excludes(columns);
  arguments->hull.add_to(*command);
  add_selection_options(*command, arguments->request.selection);
  add_output_options(*command, *arguments);
  command->footer(
      "POINTS: .npy, .csv, .tsv, .ext (cdd, lrs), Qhull text or columns. FILE may be - for standard output.\n"
      "A selection (--largest, --min-area, --most-merged; several: their intersection) says which facets "
      "are\n"
      "written to --planes, --facet-list and --format. --vertices and all else are those of the whole hull.\n"
      "With several processes the planes are those of one with all points, bit for bit; --format and --curve "
      "want "
      "one.\n"
      "A limit that is hit ends growth; what there is is certified, written, and `status` in the report says "
      "so.\n"
      "Of flat data planes are those within the subspace of the points; --equations writes planes that bound "
      "it too, behind those of the facets.\n"
      "Exit code: 0 written, 1 usage or input, 2 --verify failed, 3 internal error, 130 interrupted and "
      "written.\n" +
      example("ndhull hull points.npy --planes outer.ine --report report.json") + "\n" +
      example("ndhull hull points.npy --largest 20 --bounded --planes outer.ine") + "\n" +
      example("mpirun -n 4 ndhull hull --points-sharded 'part-*.npy' --width 5% --planes outer.npy"));
  command->callback(
      [arguments, command, &exit_code] { exit_code = run_hull(complete_request(*command, *arguments)); });
}

std::vector<std::string> join_verify_mode(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front() != "hull") return arguments;
  std::vector<std::string> joined;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] != "--verify") {
      joined.push_back(arguments[k]);
    } else if (k + 1 < arguments.size() && arguments[k + 1] == "exact") {
      joined.emplace_back("--verify=exact");
      ++k;
    } else {
      joined.emplace_back("--verify=floating");
    }
  }
  return joined;
}

}  // namespace ndhull
