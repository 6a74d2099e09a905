// The program ndhull-bench: measurements that anybody can repeat on a machine of their own.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>

#include "bench/commands.h"
#include "bench/machine.h"

int main(int argc, char** argv) {
  CLI::App app{"ndhull-bench: what ndhull takes, and what others take for the same points"};
  app.set_version_flag("--version", ndhull::machine_line(ndhull::describe_machine()));
  app.require_subcommand(1);
  // One line a command; the order is that of --help.
  ndhull::add_joggle_command(app);
  ndhull::add_peers_command(app);
  ndhull::add_approximate_command(app);
  ndhull::add_halfspaces_command(app);
  ndhull::add_phases_command(app);
  ndhull::add_micro_command(app);
  ndhull::add_rays_command(app);
  ndhull::add_selections_command(app);
  ndhull::add_scaling_command(app);
  ndhull::add_sweep_command(app);
  ndhull::add_report_command(app);
  ndhull::add_readme_command(app);
  ndhull::add_all_command(app);
  ndhull::add_compare_command(app);
  ndhull::add_counts_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 1;
  } catch (const ndhull::HasRegressed&) {
    return 2;
  } catch (const ndhull::EngineFailed&) {
    return 3;  // said already, in the table
  } catch (const std::exception& error) {
    fmt::print(stderr, "ndhull-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
