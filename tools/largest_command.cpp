#include "tools/largest_command.h"

#include <memory>
#include <string>

#include "tools/command_line/command_options.h"
#include "tools/largest_formats.h"
#include "tools/largest_run.h"

namespace ndhull {
namespace {

/// The options as they are written; `request` has the others.
struct LargestArguments {
  LargestRequest request;
  std::string format;
};

void add_search_options(CLI::App& command, LargestArguments& arguments) {
  LargestOptions& options = arguments.request.options;
  command.add_option("-n", options.count, "facets wanted, the largest first; default 100")
      ->type_name("N")
      ->check(whole_number(1));
  command.add_option("--min-area", options.min_area, "of these only facets at least so large")
      ->type_name("A")
      ->check(positive_number());
  add_word_option(
      command, "--method", options.method, {LargestMethod::kAuto, LargestMethod::kHull, LargestMethod::kRays},
      "hull (build it), rays (sample and climb), or auto (default): the hull when it can be built")
      ->type_name("METHOD");
  command
      .add_option("--rays", options.rays,
                  "shoot exactly so many rays; default: 2048 to 16384, until the largest are stable")
      ->type_name("R")
      ->check(whole_number(1, 0xFFFF'FFF0u));
  command.add_option("--max-seconds", options.max_seconds, "limit: seconds of the search")
      ->type_name("S")
      ->check(positive_number());
  command
      .add_option("--max-facets", options.max_facets,
                  "limit: simplices of a hull that is built; default with auto: 2500000")
      ->type_name("N")
      ->check(whole_number(1));
  command.add_flag("--bounded", options.bounded, "add facets until the outer planes bound a region");
  add_threads_option(command, options.threads);
  add_seed_option(command, options.seed, "of the rays");
}

void add_output_options(CLI::App& command, LargestArguments& arguments) {
  LargestRequest& request = arguments.request;
  add_plane_options(command, request.planes_path, request.plane_kind, request.equations);
  add_file_option(
      command, "--vertices", request.vertices_path,
      "write the indices of the facets' vertices, from 0: .npy, .csv, or text after their number");
  CLI::Option* const report = add_report_option(command, request.report_path);
  command.add_flag("--facet-list", request.facet_list, "put planes and vertices into the report")
      ->needs(report);
  command
      .add_option(
          "--format", arguments.format,
          "print Qhull's text formats of the facets, the largest first: any of " + largest_formats().joined())
      ->type_name("LIST");
  command.add_flag("--verify", request.verify,
                   "check, exactly, that no point is above an outer plane before anything is written");
  add_progress_options(command, request.progress, request.quiet);
}

LargestRequest complete_request(const CLI::App& command, const LargestArguments& arguments) {
  LargestRequest request = arguments.request;
  if (command.count("--format") > 0) request.formats = split_formats(arguments.format, largest_formats());
  return request;
}

}  // namespace

void add_largest_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<LargestArguments>();
  CLI::App* const command = app.add_subcommand(
      "largest",
      "The largest facets, also of a hull too big to build; prints a summary where standard output is free.");
  add_points_argument(*command, arguments->request.points_path)->required();
  add_columns_option(*command, arguments->request.columns);
  add_search_options(*command, *arguments);
  add_output_options(*command, *arguments);
  command->footer(
      "Every facet given is a facet of the hull, its outer plane certified; with --method hull and a limit "
      "that\n"
      "ended it, of the hull so far. Rays may miss larger ones: the report says how large a share of the\n"
      "directions an unseen facet may have, and estimates the recall.\n"
      "Exit code: 0 written, 1 usage or input, 2 --verify failed, 3 internal error, 130 interrupted and "
      "written.\n" +
      example("ndhull largest points.npy -n 100 --planes outer.npy --report report.json"));
  command->callback(
      [arguments, command, &exit_code] { exit_code = run_largest(complete_request(*command, *arguments)); });
}

}  // namespace ndhull
