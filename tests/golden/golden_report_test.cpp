// Whole reports of a few small inputs, compared key by key with tests/golden/*.json.
//
// After a change that is meant to change them:  NDHULL_UPDATE_GOLDEN=1 ctest --preset dev -R GoldenReport
// then read the difference before it is committed. Keys that depend on the machine or the clock are left out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "approx/polytope/outer_volume.h"
#include "approx/report.h"
#include "tests/support/degeneracies.h"
#include "tests/support/named_polytopes.h"
#include "tools/points/generate.h"

namespace ndhull {
namespace {

using Json = nlohmann::ordered_json;

/// Of one run or one machine: clocks, memory, version; counters of the work, which say nothing about the
/// result; a ratio of two roundoffs.
bool is_of_the_run(const std::string& key) {
  static const std::set<std::string> keys{"ndhull", "seconds", "peak_memory_bytes", "statistics",
                                          "width_ratio"};
  return keys.contains(key);
}

Json without_the_run(const Json& report) {
  Json kept = Json::object();
  for (const auto& [key, value] : report.items()) {
    if (!is_of_the_run(key)) kept[key] = value;
  }
  return kept;
}

/// Counts, words and flags are equal; reals agree to 1e-9 of their size or, below 1, of 1: instruction sets
/// round differently, and offsets and widths are roundoff themselves.
void expect_alike(const Json& expected, const Json& found, const std::string& path) {
  if (expected.is_number() && found.is_number() && (expected.is_number_float() || found.is_number_float())) {
    const double value = expected.get<double>();
    EXPECT_NEAR(found.get<double>(), value, 1e-9 * std::max(1.0, std::abs(value))) << path;
  } else if (expected.is_object() && found.is_object()) {
    for (const auto& [key, value] : expected.items()) {
      ASSERT_TRUE(found.contains(key)) << path << "." << key << " is missing";
      expect_alike(value, found.at(key), path + "." + key);
    }
    for (const auto& [key, value] : found.items()) EXPECT_TRUE(expected.contains(key)) << path << "." << key;
  } else if (expected.is_array() && found.is_array()) {
    ASSERT_EQ(found.size(), expected.size()) << path;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      expect_alike(expected[k], found[k], path + "[" + std::to_string(k) + "]");
    }
  } else {
    EXPECT_EQ(found, expected) << path;
  }
}

void expect_golden(const std::string& name, const PointSet& set, HullOptions options = {},
                   bool facet_list = false) {
  options.threads = 1;
  ReportContext context;
  context.input_path = name;
  context.options = options;
  context.facet_list = facet_list;
  const Hull hull = convex_hull(set.view(), options);
  const OuterVolume outer = outer_volume(hull, {}, {.max_facets = 100'000});
  context.outer_volume = &outer;
  const Json report = without_the_run(Json::parse(hull_report_json(hull, context)));
  const std::string path = name + ".json";
  if (std::getenv("NDHULL_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(path) << report.dump(2) << "\n";
    return;
  }
  std::ifstream file(path);
  ASSERT_TRUE(file) << "no " << path << ": see the first lines of golden_report_test.cpp";
  expect_alike(Json::parse(file), report, name);
}

PointSet points(PointFamily family, std::size_t n, std::size_t d) {
  return generate_points({.family = family, .dimension = d, .count = n, .seed = 1});
}

TEST(GoldenReportRegression, CubeWithItsFacets) { expect_golden("cube3_facets", cube(3).points, {}, true); }
TEST(GoldenReportRegression, SphereIn6D) { expect_golden("sphere6", points(PointFamily::kSphere, 60, 6)); }
TEST(GoldenReportRegression, GridIn5D) { expect_golden("grid5", grid(3, 5).points); }
TEST(GoldenReportRegression, TriangulatedGridIn3D) {
  HullOptions options;
  options.triangulate = true;
  expect_golden("grid3_triangulated", grid(3, 3).points, options);
}
TEST(GoldenReportRegression, FlatIn5D) {
  expect_golden("flat5", embedded(points(PointFamily::kGaussian, 30, 3), 5, 2));
}
TEST(GoldenReportRegression, OnePoint) { expect_golden("point4", points(PointFamily::kGaussian, 1, 4)); }
TEST(GoldenReportRegression, SegmentOnTheLine) {
  expect_golden("segment1", points(PointFamily::kGaussian, 9, 1));
}
TEST(GoldenReportRegression, EllipsoidInTheUnitCube) {
  HullOptions options;
  options.unit_cube = true;
  expect_golden("ellipsoid4_unit_cube", points(PointFamily::kEllipsoid, 50, 4), options);
}
TEST(GoldenReportRegression, FacetLimitOnASphere) {
  HullOptions options;
  options.limits.max_facets = 50;
  expect_golden("sphere4_facet_limit", points(PointFamily::kSphere, 200, 4), options);
}

}  // namespace
}  // namespace ndhull
