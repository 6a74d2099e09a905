#include "bench/compare.h"

#include <gtest/gtest.h>

namespace ndhull {
namespace {

/// Three rounds with this median and a spread of `spread` times it.
std::vector<RunRecord> runs(const std::string& options, double seconds, double spread, std::uint64_t facets,
                            double width, std::uint64_t created) {
  std::vector<RunRecord> records;
  for (const double factor : {1.0 - 0.5 * spread, 1.0, 1.0 + 0.5 * spread}) {
    RunRecord& record = records.emplace_back();
    record.command = "sweep";
    record.key = {"some points", "ndhull", options, 1};
    record.round = static_cast<unsigned>(records.size() - 1);
    record.end = "done";
    record.peak_bytes = 3000000;
    record.run.wall_seconds = seconds * factor;
    record.run.facets = facets;
    record.run.max_facet_width = width;
    record.run.resident_bytes = 1000000;
    record.run.detail = {{"status", "complete"}, {"created_simplices", created}};
  }
  return records;
}

std::vector<std::string> figures(const std::vector<Change>& changes) {
  std::vector<std::string> names;
  for (const Change& change : changes) names.push_back(change.figure);
  return names;
}

using Names = std::vector<std::string>;

TEST(CompareExample, EqualResultsDoNotDiffer) {
  const auto before = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  const Comparison comparison = compare_records(before, before, {});
  EXPECT_EQ(comparison.measurements, 1U);
  EXPECT_FALSE(comparison.has_regressed());
  EXPECT_TRUE(comparison_tables(comparison).empty());
}

TEST(CompareExample, SecondsBeyondToleranceAndNoiseAreARegression) {
  const auto before = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  EXPECT_FALSE(compare_records(before, runs("exact", 1.08, 0.05, 100, 1e-14, 500), {}).has_regressed());
  EXPECT_EQ(figures(compare_records(before, runs("exact", 1.2, 0.05, 100, 1e-14, 500), {}).regressions),
            Names{"seconds"});
  EXPECT_FALSE(compare_records(before, runs("exact", 1.2, 0.4, 100, 1e-14, 500), {}).has_regressed())
      << "rounds that differ by 40 % prove no 20 %";
  EXPECT_EQ(figures(compare_records(before, runs("exact", 0.5, 0.05, 100, 1e-14, 500), {}).improvements),
            Names{"seconds"});
  CompareOptions counts_only;
  counts_only.counts_only = true;
  EXPECT_FALSE(
      compare_records(before, runs("exact", 2.0, 0.05, 100, 1e-14, 500), counts_only).has_regressed());
}

TEST(CompareExample, CountedWorkHasNoNoise) {
  const auto before = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  EXPECT_EQ(figures(compare_records(before, runs("exact", 1.0, 0.05, 100, 1e-14, 510), {}).regressions),
            Names{"created_simplices"});
}

TEST(CompareExample, ExactHullsHaveTheFacetsTheyHad) {
  const auto before = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  for (const std::uint64_t facets : {99U, 101U}) {
    EXPECT_EQ(figures(compare_records(before, runs("exact", 1.0, 0.05, facets, 1e-14, 500), {}).regressions),
              Names{"facets"});
  }
}

TEST(CompareExample, ApproximateHullsMayBecomeBetter) {
  const auto before = runs("width 5%", 1.0, 0.05, 100, 0.05, 500);
  EXPECT_EQ(figures(compare_records(before, runs("width 5%", 1.0, 0.05, 90, 0.05, 500), {}).improvements),
            Names{"facets"});
  EXPECT_EQ(figures(compare_records(before, runs("width 5%", 1.0, 0.05, 110, 0.06, 500), {}).regressions),
            (Names{"facets", "max_facet_width"}));
}

TEST(CompareExample, ARunThatIsMissingOrFailsIsARegression) {
  const auto before = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  EXPECT_TRUE(compare_records(before, {}, {}).has_regressed());
  std::vector<RunRecord> failed = runs("exact", 1.0, 0.05, 100, 1e-14, 500);
  for (RunRecord& record : failed) record.end = "crashed";
  EXPECT_EQ(figures(compare_records(before, failed, {}).regressions), Names{"done"});
  for (RunRecord& record : failed) {
    record.end = "done";
    record.run.detail["status"] = "memory_limit";
  }
  EXPECT_EQ(figures(compare_records(before, failed, {}).regressions), Names{"done"});
  EXPECT_FALSE(compare_records({}, before, {}).has_regressed());
}

}  // namespace
}  // namespace ndhull
