// Two sets of results of the same measurements: what became worse beyond noise.
#pragma once

#include <string>
#include <vector>

#include "bench/run_record.h"
#include "bench/table.h"

namespace ndhull {

struct CompareOptions {
  double time_tolerance =
      0.10;  ///< [ratio] seconds may rise by this, or by the spread of either side if that is more
  double memory_tolerance = 0.10;  ///< [ratio] of peak memory beyond the points
  double width_tolerance = 0.05;   ///< [ratio] of the widest facet of approximate hulls, and of their facets
  double least_seconds = 0.005;    ///< shorter runs are not compared by seconds
  bool counts_only = false;  ///< compare what does not depend on the machine: facets, widths, counted work
};

/// One figure of one measurement that changed.
struct Change {
  RunKey key;
  std::string figure;
  double before = 0.0, after = 0.0;
  double allowed_ratio = 1.0;  ///< after / before may be this much
  bool is_regression() const { return after > before * allowed_ratio; }
};

struct Comparison {
  std::size_t measurements = 0;        ///< in both
  std::vector<RunKey> missing, added;  ///< only before; only after
  std::vector<Change> regressions, improvements;
  bool has_regressed() const { return !regressions.empty() || !missing.empty(); }
};

/// Compares measurements of equal keys.
///
/// Seconds       medians; noise is the range of the rounds over their median, of the noisier side.
/// Counted work  created simplices and insertions (they are the same on every machine), and instructions
///               where both have them: more than 1 % more is a regression.
/// Facets        of exact hulls any change is a regression; of approximate ones more facets, or a wider
///               widest facet.
/// Ends          a run that was done or complete before and is not after is a regression ("done", 1 and 0).
Comparison compare_records(const std::vector<RunRecord>& before, const std::vector<RunRecord>& after,
                           const CompareOptions& options);

/// Regressions, then improvements.
std::vector<Table> comparison_tables(const Comparison& comparison);

}  // namespace ndhull
