#include "bench/bench_cases.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "tests/support/named_polytopes.h"
#include "tools/io/point_reader.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

BenchCase rbox_case(const std::string& arguments, double qhull_seconds) {
  return {.name = arguments, .qhull_seconds = qhull_seconds, .load = [arguments](const std::string&) {
            return BenchInput{rbox(arguments), {}};
          }};
}

BenchCase sphere_case(const std::string& arguments, double qhull_seconds) {
  BenchCase sphere = rbox_case(arguments, qhull_seconds);
  sphere.is_sphere_set = true;
  return sphere;
}

BenchCase data_case(const std::string& name, const std::string& file, double qhull_seconds) {
  return {.name = name,
          .unit_cube = true,
          .qhull_seconds = qhull_seconds,
          .load = [file](const std::string& data_folder) { return load_points(data_folder + "/" + file); }};
}

// Of x_ij + x_ji = 1 one is enough: the coordinates with i < j.
BenchInput load_linear_ordering(std::size_t n) {
  NamedPolytope polytope = linear_ordering(n);
  PointSet independent{n * (n - 1) / 2, {}, polytope.points.header};
  for (std::size_t row = 0; row < polytope.points.rows(); ++row) {
    std::size_t column = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j) continue;
        if (i < j) independent.coordinates.push_back(polytope.points.row(row)[column]);
        ++column;
      }
    }
  }
  return {std::move(polytope.points), std::move(independent)};
}

}  // namespace

std::vector<BenchCase> all_bench_cases() {
  std::vector<BenchCase> cases{
      sphere_case("2000 s D5 t1", 0.3), sphere_case("1000 s D6 t1", 0.9), sphere_case("500 s D7 t1", 3.3),
      sphere_case("300 s D8 t1", 10.7), sphere_case("150 s D9 t1", 14.5), sphere_case("80 s D10 t1", 9.9),
      rbox_case("10000 D6", 2.1),       rbox_case("1000 D8", 103.0),      rbox_case("c D8", 1.3),
      rbox_case("c D9", 70.0),          rbox_case("1000 W1e-13 D5", 0.2),
  };
  cases.push_back(data_case("diamonds, unit cube", "diamonds7.npy", 0.7));
  cases.push_back({.name = "cut polytope 6", .qhull_seconds = 60.0, .load = [](const std::string&) {
                     return BenchInput{cut_polytope(6).points, {}};
                   }});
  cases.push_back({.name = "linear ordering 5", .qhull_seconds = 10.0, .load = [](const std::string&) {
                     return load_linear_ordering(5);
                   }});
  return cases;
}

BenchInput load_points(const std::string& path) {
  const PointFile file = read_points(path);
  const PointView view = file.view();
  PointSet points{view.dimension, std::vector<double>(view.rows * view.dimension), {}};
  for (std::size_t row = 0; row < view.rows; ++row) view.copy_row(row, points.row(row).data());
  return {std::move(points), {}};
}

BenchCase named_bench_input(const std::string& name) {
  if (name == "abalone, unit cube") return data_case(name, "abalone7.npy", 1.0);
  for (BenchCase& bench_case : all_bench_cases()) {
    if (bench_case.name == name) return std::move(bench_case);
  }
  return rbox_case(name, 0.0);
}

void CaseSelection::add_options(CLI::App& command) {
  data_folder = NDHULL_BENCH_DATA;
  command.add_option("--only", only, "only the inputs whose name contains this");
  command.add_flag("--list", list, "print the names of the inputs and end");
  command.add_option("--data", data_folder, "the folder bench/data")->capture_default_str();
}

std::vector<BenchCase> CaseSelection::cases() const {
  std::vector<BenchCase> chosen;
  for (BenchCase& bench_case : all_bench_cases()) {
    if (is_chosen(bench_case.name)) chosen.push_back(std::move(bench_case));
  }
  if (chosen.empty()) refuse();
  return chosen;
}

void CaseSelection::refuse() const {
  throw Error(ErrorCode::kUsage, fmt::format("no input has \"{}\" in its name: see --list", only));
}

bool CaseSelection::print_list() const {
  if (!list) return false;
  for (const BenchCase& bench_case : cases()) {
    fmt::print("{}{}\n", bench_case.name, bench_case.is_slow_for_qhull() ? "  (slow for Qhull)" : "");
  }
  return true;
}

}  // namespace ndhull
