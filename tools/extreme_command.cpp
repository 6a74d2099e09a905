#include "tools/extreme_command.h"

#include <memory>

#include "tools/command_line/command_options.h"
#include "tools/extreme_run.h"

namespace ndhull {

void add_extreme_command(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<ExtremeRequest>();
  CLI::App* const command = app.add_subcommand(
      "extreme",
      "The vertices of the hull alone, in any dimension; prints a summary where standard output is free.");
  add_points_argument(*command, request->points_path)->required();
  add_columns_option(*command, request->columns);
  CLI::Option* const keep =
      command
          ->add_option("--keep", request->keep,
                       "choose K vertices whose hull is near all points, the furthest first")
          ->type_name("K")
          ->check(whole_number(1));
  add_file_option(*command, "--vertices", request->vertices_path,
                  "write the indices of the vertices, from 0, with --keep of the chosen ones in their "
                  "order: .npy, .csv, "
                  "or text after their number");
  add_file_option(
      *command, "--planes", request->planes_path,
      "write a plane for each vertex that parts it from all other points: .ine, .npy, or Qhull text");
  add_file_option(*command, "--distances", request->distances_path,
                  "write, for each point, a bound of its distance from the hull of the chosen ones: .npy or "
                  "text")
      ->needs(keep);
  add_report_option(*command, request->report_path);
  command->add_flag("--verify", request->verify,
                    "check, exactly, that the planes part each vertex from all other points");
  command->add_option("--max-seconds", request->options.max_seconds, "limit: seconds of the search")
      ->type_name("S")
      ->check(positive_number());
  add_threads_option(*command, request->options.threads);
  add_progress_options(*command, request->progress, request->quiet);
  command->footer(
      "One linear program a point; no facets are made, so hundreds of dimensions are not too many.\n"
      "Exit code: 0 written, 1 usage or input, 2 --verify failed, 3 internal error, 130 interrupted and "
      "written.\n" +
      example("ndhull extreme points.npy --keep 100 --vertices chosen.npy --report report.json"));
  command->callback([request, &exit_code] { exit_code = run_extreme(*request); });
}

}  // namespace ndhull
