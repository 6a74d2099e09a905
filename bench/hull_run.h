// One measured hull, by ndhull and by Qhull, with the same figures of both.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "approx/hull.h"
#include "bench/bench_cases.h"
#include "bench/child_process.h"

namespace ndhull {

/// The figures of one hull. Lengths are in what they were measured in: input units, or the unit cube.
/// `detail` is what only one engine has.
struct HullRun {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;  ///< of the whole process in that time
  std::uint64_t facets = 0;  ///< after merging
  std::uint64_t vertices = 0;
  double max_facet_width = 0.0;      ///< [distance] widest facet: outer plane minus inner plane
  double max_outer_offset = 0.0;     ///< [distance] of all facets, >= 0
  double min_inner_offset = 0.0;     ///< [distance] of all facets, <= 0
  std::uint64_t resident_bytes = 0;  ///< before the call, with the points loaded
  std::uint64_t peak_bytes = 0;      ///< largest so far, right after the call; 0: not known
  nlohmann::json detail;
};

void to_json(nlohmann::json& json, const HullRun& run);
/// Figures that the line does not have (it was written before they were) stay 0.
void from_json(const nlohmann::json& json, HullRun& run);

/// ndhull::convex_hull. Time: the whole call, growth, certificate and merging.
/// detail: status, counts of the work, areas and volumes (outer_volume null where it is not affordable; it is
/// computed after the clock has stopped, and only `with_outer_volume`), phase_seconds and detail_seconds as
/// lists of [name, seconds]. Throws what convex_hull throws.
HullRun run_ndhull(const BenchInput& input, const HullOptions& options, bool with_outer_volume = false);

/// libqhull_r on points in memory, with the options the program `qhull` has without any, and `options` ("QbB
/// W0.1 C0.01"). Time: qh_qhull, which is what Qhull prints as "seconds to compute hull (after input)": it
/// merges and finds the outer planes as well; reading, checks of the output and printing are not in it.
/// Throws    std::runtime_error with Qhull's exit code and first line of message.
/// Planes    `outer_planes`, where given, gets a row normal, offset for each facet, raised to its outer
///           plane.
/// Leaks     Qhull's memory: call it in a child process.
HullRun run_qhull(const BenchInput& input, const std::string& options,
                  std::vector<double>* outer_planes = nullptr);

/// CGAL's Triangulation of the points, 3-d to 7-d. `facets` are its infinite cells: simplices, coplanar ones
/// not merged. Time: inserting all points. Throws std::runtime_error in other dimensions.
HullRun run_cgal(const BenchInput& input);

/// The program lrs, on coordinates rounded to 2^-20. Time: of the process. Memory is not known.
/// Throws std::runtime_error for more than 300 points, or when lrs is not installed or finds no facets.
HullRun run_lrs(const BenchInput& input);

/// As linked, "2020.2.r".
const char* qhull_version();

}  // namespace ndhull
