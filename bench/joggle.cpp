// `ndhull-bench joggle`: the two tables of Qhull's manual, how often joggled input has a precision problem.
//
// What is counted as a problem. Qhull: a point that is added lies within its roundoff of a facet's plane, a
// pivot of a plane's elimination is near zero, two facets of the result are not clearly convex. ndhull: a
// decision whether a facet is visible from a point that is added lies within roundoff (approx/joggle.h).
// Planes are not eliminated, so they have no pivots; and facets are convex when the decisions were clear.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "approx/joggle.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "tools/output_file.h"
#include "tools/rbox.h"

namespace ndhull {
namespace {

struct JoggleRunOptions {
  std::uint64_t runs = 1000;
  bool without_qhull = false;
};

/// A size of the joggle and the share of runs with a problem that the manual gives for it.
struct ManualRow {
  double size, share;
};

constexpr ManualRow kCube[] = {{1e-15, .983},   {2e-15, .830},   {4e-15, .561},   {8e-15, .325},
                               {1.6e-14, .185}, {3.2e-14, .099}, {6.4e-14, .051}, {1.3e-13, .025},
                               {2.6e-13, .010}, {5.1e-13, .004}, {1e-12, .002},   {2e-12, .001}};
constexpr ManualRow kCubeSurface[] = {{1e-12, .870},   {2e-12, .700},   {4e-12, .450},   {8e-12, .250},
                                      {1.6e-11, .110}, {3.2e-11, .065}, {6.4e-11, .030}, {1.3e-10, .010},
                                      {2.6e-10, .008}, {5.1e-09, .003}};

/// The share that Qhull's own program finds, as text; "-" without the program.
std::string share_of_qhull(const std::string& rbox_arguments, const ManualRow& row, std::uint64_t runs) {
  const std::string command =
      fmt::format("rbox {} | qhull QJ{:.2g} TR{} s 2>&1", rbox_arguments, row.size, runs);
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "-";
  std::string share = "-";
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    double percentage = 0.0;
    if (std::sscanf(line, " Percentage of runs with precision errors: %lf", &percentage) == 1)
      share = fmt::format("{:.3f}", 0.01 * percentage);
  }
  pclose(pipe);
  return share;
}

void print_table(const std::string& rbox_arguments, std::span<const ManualRow> rows,
                 const JoggleRunOptions& options) {
  const PointSet points = rbox(rbox_arguments);
  fmt::print("\n{}: roundoff {:.2g}\n{:>9} {:>9} {:>9} {:>9}\n", rbox_arguments,
             joggle_roundoff(points.view()), "joggle", "manual", "qhull", "ndhull");
  for (const ManualRow& row : rows) {
    const std::uint64_t problems =
        count_precision_problems(points.view(), {.threads = 1}, {.size = row.size}, options.runs);
    const std::string qhull = options.without_qhull ? "-" : share_of_qhull(rbox_arguments, row, options.runs);
    fmt::print("{:>9.2g} {:>9.3f} {:>9} {:>9.3f}\n", row.size, row.share, qhull,
               static_cast<double>(problems) / static_cast<double>(options.runs));
    std::fflush(stdout);
  }
}

void run_joggle(const JoggleRunOptions& options) {
  fmt::print("{}\nshare of {} joggles that had a precision problem\n", machine_line(describe_machine()),
             options.runs);
  print_table("c D3", kCube, options);
  print_table("1000 W0 D3", kCubeSurface, options);
}

}  // namespace

void add_joggle_command(CLI::App& app) {
  const auto options = std::make_shared<JoggleRunOptions>();
  CLI::App* command = app.add_subcommand("joggle", "how often joggled input has a precision problem");
  command->add_option("--runs", options->runs, "joggles for each size")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}))
      ->capture_default_str();
  command->add_flag("--without-qhull", options->without_qhull, "do not run Qhull's program beside");
  command->footer("Example: ndhull-bench joggle --runs 200");
  command->callback([options] { run_joggle(*options); });
}

}  // namespace ndhull
