// How facets, time and memory grow: fitted to exact hulls of generated points, beside what is expected.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

/// RunRecord::task of means over many seeds: detail has mean_facets, standard_error, expected_facets, seeds.
inline constexpr const char* kCountsTask = "counts";

/// Exact hulls of one family, dimension and number of points by one engine on one thread, means over the
/// seeds.
struct GrowthSample {
  std::string family, engine;
  std::size_t dimension = 0, points = 0, seeds = 0;
  double facets = 0.0, seconds = 0.0, bytes = 0.0;  ///< bytes: peak memory beyond the points
  std::optional<double> expected_facets;            ///< of families of which they are known
};

/// From all exact, complete runs of generated points, in the order of engine, family, dimension, points.
std::vector<GrowthSample> growth_samples(const std::vector<RunRecord>& records);

/// Measured / expected facets; exponents with the number of points; factors with the dimension; exponents
/// with the facets; threads. Tables for which there are fewer than three sizes are left out.
std::vector<Table> scaling_tables(const std::vector<RunRecord>& records);

}  // namespace ndhull
