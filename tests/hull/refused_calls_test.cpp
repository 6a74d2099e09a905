// What the library refuses: options that contradict each other, numbers that are none, sizes that do not fit.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "approx/joggle.h"
#include "approx/option_check.h"
#include "approx/planes/contains.h"
#include "approx/polytope/halfspace_intersection.h"
#include "approx/rays/extreme_points.h"
#include "approx/rays/largest_facets.h"
#include "approx/reduction/kept_points.h"
#include "core/error.h"
#include "tests/hull/hull_support.h"

namespace ndhull {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <class Call>
void expect_refused(ErrorCode code, const Call& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown, expected " << to_string(code);
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.code()), to_string(code)) << error.what();
  }
}

PointSet sphere() { return family_points(PointFamily::kSphere, 60, 3, 5); }

TEST(RefusedCalls, OptionsThatContradictEachOther) {
  const PointSet set = sphere();
  const auto refused = [&](const HullOptions& options) {
    expect_refused(ErrorCode::kUsage, [&] { convex_hull(set.view(), options); });
  };
  refused({.accuracy = {.width = {0.1, false}, .facets = 20}});
  refused({.accuracy = {.width = {0.1, false}, .width_cap = {0.2, false}}});
  refused({.accuracy = {.width = {0.1, false}, .centrum_radius = {0.2, false}}});
  refused({.accuracy = {.facets = 20, .max_cosine = 0.9}});
  refused({.accuracy = {.effort = Effort::kThorough}});
  refused({.accuracy = {.width = {0.1, false}}, .triangulate = true});
  for (const double number : {kNan, -1.0, kInfinite}) {
    refused({.accuracy = {.width = {number, false}}});
    refused({.accuracy = {.outside_width = {number, true}}});
    refused({.accuracy = {.centrum_radius = {number, false}}});
    refused({.shift = number});
  }
  refused({.accuracy = {.max_cosine = kNan}});
  refused({.accuracy = {.max_cosine = -1.5}});
  refused({.shift = 0.5});
}

TEST(RefusedCalls, MessagesSpellOptionsAsTheCallerDoes) {
  const HullOptions options{.accuracy = {.width_cap = {0.2, false}}};
  for (const OptionSpelling spelling : {OptionSpelling::kField, OptionSpelling::kProgram}) {
    try {
      check_options(options, spelling);
      ADD_FAILURE();
    } catch (const Error& error) {
      const bool is_field = spelling == OptionSpelling::kField;
      EXPECT_EQ(std::string(error.what()).rfind(is_field ? "found width_cap " : "found --width-cap ", 0), 0U)
          << error.what();
    }
  }
}

TEST(RefusedCalls, AnyNumberOfThreadsIsTaken) {
  const PointSet set = sphere();
  const std::size_t facets = hull_of(set, {.threads = 1}).facet_count();
  EXPECT_EQ(hull_of(set, {.threads = 1'000'000'000}).facet_count(), facets);
}

TEST(RefusedCalls, MoreRowsThanIdsCanNumber) {
  const std::vector<double> row(3, 0.0);
  PointView many = PointView::row_major(row.data(), (std::size_t{1} << 32) + 5, 3);
  many.row_stride = 0;
  expect_refused(ErrorCode::kTooManyPoints, [&] { convex_hull(many); });
  expect_refused(ErrorCode::kTooManyPoints, [&] { extreme_points(many); });
  expect_refused(ErrorCode::kTooManyPoints, [&] { largest_facets(many); });
  expect_refused(ErrorCode::kTooManyPoints, [&] { intersect_halfspaces(many); });
}

TEST(RefusedCalls, HalfspacesAndInteriorPointsThatAreNoNumbers) {
  const std::vector<double> square{1, 0, -1, -1, 0, -1, 0, 1, -1, 0, -1, -1};
  const PointView rows = PointView::row_major(square.data(), 4, 3);
  EXPECT_EQ(intersect_halfspaces(rows).vertex_count(), 4U);
  for (const double number : {kNan, kInfinite, -kInfinite}) {
    IntersectionOptions options;
    options.interior_point = {number, 0.0};
    expect_refused(ErrorCode::kNotFinite, [&] { intersect_halfspaces(rows, options); });
  }
  const PointView no_columns = PointView::row_major(square.data(), 4, 0);
  expect_refused(ErrorCode::kDimensionTooLow, [&] { intersect_halfspaces(no_columns); });
}

TEST(RefusedCalls, QueriesThatAreNoNumbers) {
  const std::vector<double> planes{1, 0, -1, -1, 0, -1};
  for (const double number : {kNan, kInfinite}) {
    const std::vector<double> queries{0.0, 0.0, 0.5, number};
    expect_refused(ErrorCode::kNotFinite,
                   [&] { distances_to_planes(PointView::row_major(queries.data(), 2, 2), planes); });
  }
}

TEST(RefusedCalls, SizesOfAJoggle) {
  const PointSet set = sphere();
  for (const double size : {-1.0, 1e-300, kNan, kInfinite, 1e305}) {
    expect_refused(ErrorCode::kUsage, [&] { joggled_hull(set.view(), {}, {.size = size}); });
    expect_refused(ErrorCode::kUsage, [&] { count_precision_problems(set.view(), {}, {.size = size}, 1); });
  }
}

TEST(RefusedCalls, VerticesToKeepAndTheirCentre) {
  const PointSet set = sphere();
  const ExtremePoints found = extreme_points(set.view());
  const auto keep = [&](std::span<const double> centre, const KeepOptions& options) {
    expect_refused(ErrorCode::kUsage, [&] { keep_points(set.view(), found.vertices, centre, options); });
  };
  keep({}, {});
  keep(found.interior_point, {.given = found.vertices.size() + 1});
  keep(found.interior_point, {.enough = kNan});
  expect_refused(ErrorCode::kEmptyInput, [&] { distances_from_hull(set.view(), {}, found.interior_point); });
}

}  // namespace
}  // namespace ndhull
