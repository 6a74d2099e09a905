// The fixed list of inputs that measurements are made on, and how a command line picks from it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/points/point_set.h"

namespace CLI {
class App;
}

namespace ndhull {

/// The points of one case. They are the same for both engines but where Qhull refuses them.
struct BenchInput {
  PointSet points;
  std::optional<PointSet> full_rank_points;  ///< flat input in coordinates that are independent, for Qhull

  const PointSet& qhull_points() const { return full_rank_points ? *full_rank_points : points; }
};

/// One line of the list.
struct BenchCase {
  std::string name;            ///< an rbox command, or a polytope with its parameter
  bool is_sphere_set = false;  ///< one of those the geometric mean is over
  bool unit_cube = false;      ///< widths measured after scaling to the unit cube; Qhull gets QbB
  double qhull_seconds = 0.0;  ///< [seconds] that Qhull 2020.2 takes; half of it on a fast core
  std::function<BenchInput(const std::string& data_folder)> load;

  /// Longer runs are made once; those of Qhull are left out on request.
  static constexpr double kSlowSeconds = 20.0;
  bool is_slow_for_qhull() const { return qhull_seconds > kSlowSeconds; }
};

/// The points of a file, as doubles, because Qhull takes nothing else. Throws as read_points.
BenchInput load_points(const std::string& path);

/// The input called `name`: one of the list below, "abalone, unit cube", or an rbox command.
BenchCase named_bench_input(const std::string& name);

/// All cases of exact hulls, in the order of the tables.
std::vector<BenchCase> all_bench_cases();

/// The options by which every command picks cases.
struct CaseSelection {
  std::string only;         ///< part of a name; empty: all
  bool list = false;        ///< print the names instead of running
  std::string data_folder;  ///< where bench/data is

  void add_options(CLI::App& command);
  bool is_chosen(const std::string& name) const { return name.find(only) != std::string::npos; }
  /// Throws Error kUsage when no name matches.
  std::vector<BenchCase> cases() const;
  /// Throws it.
  [[noreturn]] void refuse() const;
  /// With `list`, prints the names and returns true.
  bool print_list() const;
};

}  // namespace ndhull
