#include "bench/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "bench/commands.h"
#include "bench/machine.h"

namespace ndhull {

int run_bench(int argc, const char* const* argv) {
  CLI::App app{"ndhull-bench: what ndhull takes, and what others take for the same points"};
  app.set_version_flag("--version", machine_line(describe_machine()));
  app.require_subcommand(1);
  // One line a command; the order is that of --help.
  add_joggle_command(app);
  add_peers_command(app);
  add_approximate_command(app);
  add_halfspaces_command(app);
  add_phases_command(app);
  add_micro_command(app);
  add_rays_command(app);
  add_selections_command(app);
  add_scaling_command(app);
  add_sweep_command(app);
  add_threads_command(app);
  add_report_command(app);
  add_readme_command(app);
  add_all_command(app);
  add_compare_command(app);
  add_counts_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  } catch (const HasRegressed&) {
    return 2;
  } catch (const EngineFailed&) {
    return 3;  // said already, in the table
  } catch (const std::exception& error) {
    fmt::print(stderr, "ndhull-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace ndhull
