// The program lrs: vertex enumeration in exact rational arithmetic. Reading and writing are in its time,
// which they are small beside.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "bench/hull_run.h"

namespace ndhull {
namespace {

// lrs takes integers and fractions, and its numbers grow with their digits.
constexpr double kDenominator = 1048576.0;
// Beyond, it takes hours.
constexpr std::size_t kMostPoints = 300;

std::string as_fractions(const PointSet& points) {
  std::string text =
      fmt::format("V-representation\nbegin\n{} {} rational\n", points.rows(), points.dimension + 1);
  for (std::size_t row = 0; row < points.rows(); ++row) {
    text += "1";
    for (const double coordinate : points.row(row)) {
      text += fmt::format(" {:.0f}/{:.0f}", std::round(coordinate * kDenominator), kDenominator);
    }
    text += "\n";
  }
  return text + "end\n";
}

}  // namespace

HullRun run_lrs(const BenchInput& input) {
  const PointSet& points = input.qhull_points();
  if (points.rows() > kMostPoints) {
    throw std::runtime_error(fmt::format("lrs is compared on at most {} points", kMostPoints));
  }
  std::string path = (std::filesystem::temp_directory_path() / "ndhull-lrs-XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) throw std::runtime_error(path + " cannot be written");
  close(descriptor);
  std::ofstream(path) << as_fractions(points);

  HullRun run;
  const Stopwatch watch;
  std::string output;
  // timeout: a child that is killed for its own limit takes this one with it within the hour.
  std::FILE* pipe = popen(fmt::format("timeout 3600 lrs '{}' 2>&1 | tail -n 20", path).c_str(), "r");
  std::array<char, 4096> block;
  for (std::size_t count = 0; pipe != nullptr && (count = fread(block.data(), 1, block.size(), pipe)) > 0;) {
    output.append(block.data(), count);
  }
  const int status = pipe == nullptr ? -1 : pclose(pipe);
  run.wall_seconds = watch.wall_seconds();
  std::filesystem::remove(path);
  constexpr std::string_view kFacets = "Totals: facets=";
  const std::size_t place = output.find(kFacets);
  const char* const digits = output.c_str() + (place == std::string::npos ? 0 : place + kFacets.size());
  run.facets = std::strtoull(digits, nullptr, 10);
  if (status != 0 || place == std::string::npos || run.facets == 0) {
    throw std::runtime_error("lrs (Debian package lrslib) gave no number of facets");
  }
  run.detail = {{"rounded_to", 1.0 / kDenominator}};
  return run;
}

}  // namespace ndhull
