#include "tools/program.h"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "approx/report.h"
#include "core/error.h"
#include "core/machine/arena.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/exit_code.h"
#include "tools/contains_command.h"
#include "tools/extreme_command.h"
#include "tools/hull_command.h"
#include "tools/intersect_command.h"
#include "tools/io/output_file.h"
#include "tools/io/text_source.h"
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
  if (!arguments.empty() && arguments.front().size() > 1 && arguments.front().starts_with("-")) return;
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

/// `help` and `help COMMAND` are --help.
std::vector<std::string> without_help_command(std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() != "help") return arguments;
  arguments.erase(arguments.begin());
  arguments.emplace_back("--help");
  return arguments;
}

/// The words of a message of CLI11 before and behind `part`; empty ones where it is not in there.
std::pair<std::string, std::string> parted_at(const std::string& message, std::string_view part) {
  const std::size_t at = message.find(part);
  if (at == std::string::npos) return {};
  return {message.substr(0, at), message.substr(at + part.size())};
}

/// CLI11 says what is missing, or that there is too much, in words of its own: here what was found and what
/// was expected. Checks of values (command_options.h) have said that themselves.
std::string describe(const CLI::ParseError& error, const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  const auto unknown = std::find_if(left.begin(), left.end(), [](const std::string& word) {
    return word.size() > 1 && word.starts_with("-") && word != "--";
  });
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (!left.empty() &&
      (is_missing ? unknown != left.end() : dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)) {
    return fmt::format("found \"{}\", expected {}", printable(is_missing ? *unknown : left.front()),
                       app.get_subcommands().empty() ? "a command" : "an option or argument of this command");
  }
  const std::string message = error.what();
  if (const auto [name, rest] = parted_at(message, " is required"); !name.empty()) {
    if (app.get_subcommands().empty()) return "found no command, expected one";
    return fmt::format("found no {0}, expected {0} behind the command", name);
  }
  if (const auto [name, value] = parted_at(message, ": 1 required "); !name.empty())
    return fmt::format("{}: found nothing behind it, expected {}", name, parted_at(value, " missing").first);
  if (const auto [name, count] = parted_at(message, ": At Most 1 required but received "); !name.empty())
    return fmt::format("{}: found {} times, expected once; leave out all but one", name, count);
  if (const auto [name, other] = parted_at(message, " requires "); !name.empty())
    return fmt::format("{0}: found without {1}, expected with it; add {1} or leave {0} out", name, other);
  if (const auto [name, other] = parted_at(message, " excludes "); !name.empty())
    return fmt::format("{0}: found with {1}, expected one of them; leave out the other", name, other);
  if (const auto [name, value] = parted_at(parted_at(message, "Could not convert: ").second, " = ");
      !name.empty())
    return fmt::format("{}: found \"{}\", expected no value behind it; leave it out", name, printable(value));
  return message;
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

int run_program(const std::vector<std::string>& words_given) {
  const std::vector<std::string> arguments = without_help_command(words_given);
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
