#include "tools/verify_command.h"

#include <fmt/format.h>

#include <memory>

#include "tools/command_line/command_options.h"
#include "tools/io/output_file.h"
#include "tools/io/planes_and_points.h"

namespace ndhull {

PlaneCheck verify_files(const std::string& points_path, const std::string& planes_path, unsigned threads,
                        const ColumnChoice& columns) {
  const auto [planes, points] = read_planes_and_points(
      planes_path, points_path, columns,
      {.command = "verify", .points = "points", .remedy = "give the planes of these points"});
  PlaneCheck check = check_planes(points.view(), planes.rows, threads);
  if (check.pairs > 0) check.worst_plane = planes.row_of(check.worst_plane);
  return check;
}

std::string describe(const PlaneCheck& check) {
  if (check.pairs == 0) return "nothing to check: no planes\n";
  return fmt::format(
      "worst: point {} plane {} distance {:.17g}\n{}: {} of {} pairs of point and plane above\n",
      check.worst_point.value, check.worst_plane, check.worst_distance, check.above == 0 ? "pass" : "fail",
      check.above, check.pairs);
}

void add_verify_command(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::string points, planes;
    ColumnChoice columns;
    unsigned threads = 0;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      app.add_subcommand("verify", "Is every point below every plane? Exit code 2 if not.");
  add_points_argument(*command, arguments->points)->required();
  add_path_argument(*command, "PLANES", arguments->planes, "halfspaces a.x + b <= 0: a file, or -")
      ->required();
  add_columns_option(*command, arguments->columns);
  add_threads_option(*command, arguments->threads);
  command->footer(
      "Numbers are taken as the doubles they are read to; a point on a plane is not above it.\n"
      "Points and planes count from 0.\n" +
      example("ndhull hull points.npy --planes outer.npy && ndhull verify points.npy outer.npy"));
  command->callback([arguments, &exit_code] {
    const PlaneCheck check =
        verify_files(arguments->points, arguments->planes, arguments->threads, arguments->columns);
    write_text("-", describe(check));
    exit_code = check.above == 0 ? 0 : 2;
  });
}

}  // namespace ndhull
