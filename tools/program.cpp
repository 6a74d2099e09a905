#include "tools/program.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <new>
#include <sstream>
#include <string>

#include "approx/report.h"
#include "core/error.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/exit_code.h"
#include "tools/contains_command.h"
#include "tools/extreme_command.h"
#include "tools/hull_command.h"
#include "tools/intersect_command.h"
#include "tools/io/output_file.h"
#include "tools/largest_command.h"
#include "tools/points/point_set_commands.h"
#include "tools/qhull/qhull_command.h"
#include "tools/verify_command.h"
#include "tools/view/view_command.h"

namespace ndhull {
namespace {

int fail(int exit_code, std::string_view code, std::string message) {
  // A message is one line, whatever a file name or an argument holds.
  std::replace(message.begin(), message.end(), '\n', ' ');
  fmt::print(stderr, "ndhull: {}: {}\n", code, message);
  return exit_code;
}

/// CLI11 says of an unknown command only that there is none.
void check_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front().starts_with("-")) return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!arguments.empty() && command->get_name() == arguments.front()) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  const std::string found = arguments.empty() ? "no command" : "\"" + arguments.front() + "\"";
  throw Error(ErrorCode::kUsage,
              fmt::format("found {}, expected one of {}; see ndhull --help", found, names));
}

std::string help_of(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return chosen.empty() ? "ndhull --help" : "ndhull " + chosen.front()->get_name() + " --help";
}

std::string describe(const CLI::ParseError& error, const CLI::App& app) {
  const auto* const extra = dynamic_cast<const CLI::ExtrasError*>(&error);
  const std::vector<std::string> left = app.remaining(true);
  if (extra == nullptr || left.empty()) return error.what();
  return fmt::format("found \"{}\", expected an option or argument of this command", left.front());
}

/// Runs the command that the words name. What --help and --version print is a result like any other.
void parse(CLI::App& app, std::vector<std::string> words) {
  std::ostringstream text;
  try {
    app.parse(std::move(words));
  } catch (const CLI::Success& asked) {
    app.exit(asked, text, text);
    write_text("-", text.str());
  }
}

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  // Of more threads than cores TBB would start but as many as there are cores, and say so on standard error.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, kMostThreads);
  int exit_code = 0;
  CLI::App app{"Convex hulls in five and more dimensions, with a proven error bound on every facet.",
               "ndhull"};
  app.set_version_flag("--version", "ndhull " + std::string(version()));
  app.require_subcommand(1);
  app.footer("Each command has its own --help with an example.");
  // One line a command; the order is that of --help.
  add_hull_command(app, exit_code);
  add_intersect_command(app, exit_code);
  add_contains_command(app);
  add_largest_command(app, exit_code);
  add_extreme_command(app, exit_code);
  add_generate_command(app);
  add_rbox_command(app);
  add_qhull_command(app, exit_code);
  add_qhalf_command(app, exit_code);
  add_verify_command(app, exit_code);
  add_view_command(app, exit_code);
  try {
    check_command(app, arguments);
    std::vector<std::string> words = join_verify_mode(arguments);
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    parse(app, std::move(words));
  } catch (const CLI::ParseError& error) {
    return fail(kBadInputExitCode, "usage", fmt::format("{}; see {}", describe(error, app), help_of(app)));
  } catch (const Error& error) {
    return fail(kBadInputExitCode, to_string(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return fail(kInternalErrorExitCode, "internal",
                "out of memory; set --max-memory, or take a machine with more");
  } catch (const std::exception& error) {
    return fail(kInternalErrorExitCode, "internal", error.what());
  }
  return exit_code;
}

}  // namespace ndhull
