// The commands of ndhull-bench, one file each. Each adds itself to the program, with its options.
#pragma once

#include <stdexcept>

namespace CLI {
class App;
}

namespace ndhull {

/// ndhull failed on an input of the list. Thrown after the table is complete; the program then ends with 3.
struct EngineFailed : std::runtime_error {
  EngineFailed() : std::runtime_error("a run of ndhull failed") {}
};

/// `all`: sweep, scaling, approximate and their report.
void add_all_command(CLI::App& app);
/// `approximate`: approximate hulls of ndhull and Qhull.
void add_approximate_command(CLI::App& app);
/// `joggle`: how often joggled input has a precision problem.
void add_joggle_command(CLI::App& app);
/// `compare` found something that became worse. Thrown after the tables; the program then ends with 2.
struct HasRegressed : std::runtime_error {
  HasRegressed() : std::runtime_error("regressions") {}
};

/// `compare`: two sets of results.
void add_compare_command(CLI::App& app);
/// `counts`: a small fixed set, its work counted.
void add_counts_command(CLI::App& app);
/// `halfspaces`: intersections of halfspaces, as whole programs.
void add_halfspaces_command(CLI::App& app);
/// `micro`: the phases of small hulls.
void add_micro_command(CLI::App& app);
/// `peers`: ndhull and Qhull side by side.
void add_peers_command(CLI::App& app);
/// `phases`: where the time of ndhull goes.
void add_phases_command(CLI::App& app);
/// `readme`: the measured tables in READMEs.
void add_readme_command(CLI::App& app);
/// `report`: results as a page.
void add_report_command(CLI::App& app);
/// `scaling`: how time and memory grow.
void add_scaling_command(CLI::App& app);
/// `selections`: what 20 outer planes enclose.
void add_selections_command(CLI::App& app);
/// `sweep`: families, dimensions, numbers of points, options.
void add_sweep_command(CLI::App& app);
/// `threads`: several threads beside one.
void add_threads_command(CLI::App& app);
/// `rays`: the largest facets without the hull.
void add_rays_command(CLI::App& app);

}  // namespace ndhull
