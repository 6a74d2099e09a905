// Steps: check what is asked, read the hull or compute it, make the scene, write the page.
#include "tools/view/view_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>

#include "core/error.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/hull_options.h"
#include "tools/command_line/interrupt.h"
#include "tools/command_line/machine_memory.h"
#include "tools/command_line/named_outputs.h"
#include "tools/command_line/progress_line.h"
#include "tools/io/output_file.h"
#include "tools/view/view_html.h"
#include "tools/view/view_input.h"
#include "tools/view/view_scene.h"
#include "tools/view/view_svg.h"

namespace ndhull {
namespace {

struct ViewArguments {
  HullOptionSet hull;
  std::string source_path, output_path;
  ColumnChoice columns;
  std::optional<std::string> axes, names;
  bool principal = false, section = false, shadow = false;
  std::size_t highlight = ViewWish{}.highlight;
};

bool is_html(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == "svg") return false;
  if (extension == "html" || extension == "htm") return true;
  throw Error(
      ErrorCode::kUsage,
      fmt::format("--output: found \"{}\", expected a name that ends in .svg or .html", printable(path)));
}

/// A column of --axes: its number from 1, or its name.
std::size_t column_of(const std::string& word, const std::vector<std::string>& names) {
  std::size_t number = 0;
  const char* const end = word.data() + word.size();
  if (parse_count(word.data(), end, number) == end && number >= 1 && number <= names.size())
    return number - 1;
  const auto place = std::find(names.begin(), names.end(), word);
  if (place != names.end()) return static_cast<std::size_t>(place - names.begin());
  throw Error(ErrorCode::kUsage,
              fmt::format("--axes: found \"{}\", expected a column: its number from 1 to {}{}",
                          printable(word), names.size(), names.front() == "x1" ? "" : ", or its name"));
}

std::vector<std::size_t> columns_of(const std::string& axes, const ViewedHull& viewed) {
  const auto names = column_names_or_numbers(viewed.points.column_names, viewed.dimension());
  std::vector<std::size_t> columns;
  for (const std::string& word : CLI::detail::split(axes, ',')) columns.push_back(column_of(word, names));
  const bool differ = std::set(columns.begin(), columns.end()).size() == columns.size();
  if (differ && (columns.size() == 2 || columns.size() == 3)) return columns;
  throw Error(
      ErrorCode::kUsage,
      fmt::format("--axes: found \"{}\", expected two or three different columns; write them like 1,2,4",
                  printable(axes)));
}

/// Gives the columns the names asked for.
void rename_columns(const std::string& names, ViewedHull& viewed) {
  viewed.points.column_names = CLI::detail::split(names, ',');
  const std::size_t found = viewed.points.column_names.size();
  if (found == viewed.dimension()) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("--names: found {}, expected {}: one for each column", found, viewed.dimension()));
}

ViewWish wish_of(const ViewArguments& arguments, const ViewedHull& viewed) {
  ViewWish wish;
  wish.kind = arguments.shadow ? ViewKind::kShadow : ViewKind::kSection;
  wish.highlight = arguments.highlight;
  if (arguments.axes.has_value()) {
    wish.columns = columns_of(*arguments.axes, viewed);
  } else if (!arguments.principal && viewed.rank == viewed.dimension() && viewed.dimension() <= 3) {
    for (std::size_t column = 0; column < viewed.dimension(); ++column) wish.columns.push_back(column);
  }
  return wish;
}

/// The hull to draw.
ViewedHull load(const ViewArguments& arguments, Interrupt& interrupt) {
  FileBytes bytes = FileBytes::read(arguments.source_path);
  if (is_report(bytes, arguments.source_path)) {
    const auto refuse = [&](std::string_view option, std::string_view reason) {
      return Error(ErrorCode::kUsage,
                   fmt::format("{}: found a report, {}, which {}, expected points; leave the option out",
                               option, display_name(arguments.source_path), reason));
    };
    if (!arguments.columns.is_all()) throw refuse("--columns", "names its columns");
    if (!arguments.hull.complete().accuracy.is_exact())
      throw refuse("options of an approximate hull", "has the facets of its hull");
    return read_report(bytes, arguments.source_path);
  }
  ProgressLine progress(false, false);  // on a terminal only
  PointFile points = parse_points(std::move(bytes), arguments.source_path, arguments.columns);
  HullOptions options = arguments.hull.complete();
  options.stop = interrupt.token();
  options.limits.machine_memory_bytes = memory_of_machine();
  if (options.accuracy.is_exact()) {
    // What is drawn of its facets takes as much memory again, and more time than growth took for them.
    constexpr double kDrawing = 2.0;
    options.limits.max_memory_bytes -= options.limits.max_memory_bytes / 2;
    options.limits.share_afterwards = kDrawing;
  }
  if (progress.is_shown()) options.progress = [&progress](const Progress& now) { progress.show(now); };
  interrupt.arm();
  const Hull hull = convex_hull(points.view(), options);
  return viewed_hull(hull, std::move(points));
}

void write_picture(const ViewArguments& arguments, int& exit_code) {
  constexpr double kShareOfTime = 0.9;  // the rest is for drawing and writing
  const WorkEnd::Clock::time_point start = WorkEnd::Clock::now();
  Interrupt interrupt;
  const bool html = is_html(arguments.output_path);
  check_outputs_are_writable({{"--output", arguments.output_path}}, {arguments.source_path});
  // Opened first: that it cannot be written is said before the hull is computed.
  OutputFile file(arguments.output_path);
  ViewedHull viewed = load(arguments, interrupt);
  if (arguments.names.has_value()) rename_columns(*arguments.names, viewed);
  ViewWish wish = wish_of(arguments, viewed);
  wish.end = WorkEnd(kShareOfTime * arguments.hull.complete().limits.max_seconds, interrupt.token(), start);
  const Scene scene = make_scene(viewed, wish);
  file.write(html ? scene_html(scene) : scene_svg(scene));
  file.commit();
  if (interrupt.requested()) exit_code = kInterruptedExitCode;
}

void add_picture_options(CLI::App& command, ViewArguments& arguments) {
  command.add_option("-o,--output", arguments.output_path, "the picture: .svg, or .html that can be turned")
      ->type_name("FILE")
      ->required();
  CLI::Option* const axes =
      command
          .add_option(
              "--axes", arguments.axes,
              "two or three columns, by number from 1 or by name, as in 1,2,4; default in 2-d and 3-d")
          ->type_name("I,J,K");
  command
      .add_option("--names", arguments.names, "of the columns, as in carat,depth,price; default: the file's")
      ->type_name("LIST");
  command
      .add_flag("--principal", arguments.principal,
                "principal components, of the unit cube with --unit-cube; default above 3-d")
      ->excludes(axes);
  CLI::Option* const section =
      command.add_flag("--section", arguments.section,
                       "what lies in the flat through the interior point along the axes; default");
  command.add_flag("--shadow", arguments.shadow, "what projects to the axes")->excludes(section);
  command.add_option("--highlight", arguments.highlight, "mark the N facets of largest area; default 5")
      ->type_name("N")
      ->check(whole_number(0));
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* const command =
      app.add_subcommand("view", "A picture of a hull: shells and facet widths, in section or as a shadow.");
  add_path_argument(*command, "REPORT|POINTS", arguments->source_path,
                    "a report written with --facet-list, or points; - for standard input")
      ->required();
  add_columns_option(*command, arguments->columns);
  add_picture_options(*command, *arguments);
  arguments->hull.add_to(*command);
  command->footer(
      "Faces of a section are facets, coloured by width; the outer shell is drawn as glass over the inner "
      "one\n"
      "where they differ. Of POINTS the hull is computed first, with the options of `ndhull hull`.\n" +
      example("ndhull view points.npy --unit-cube -o hull.html"));
  command->callback([arguments, &exit_code] { write_picture(*arguments, exit_code); });
}

}  // namespace ndhull
