// What a search for the largest facets found and what is known of the rest, as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "approx/planes/plane_check.h"
#include "approx/rays/largest_facets.h"
#include "approx/report.h"

namespace ndhull {

/// What the report says and the search does not know.
struct LargestReportContext {
  std::string input_path;
  LargestOptions options;  ///< the ones the search was made with
  /// Options of the program beyond them, in the order they are reported.
  std::vector<std::pair<std::string, OptionValue>> program_options = {};
  double read_seconds = 0.0, verify_seconds = 0.0, write_seconds = 0.0, total_seconds = 0.0;
  std::uint64_t peak_memory_bytes = 0;
  const PlaneCheck* verification = nullptr;  ///< null: not verified
  bool facet_list = false;                   ///< planes and vertices too
};

/// The report: keys as in the hull's where they mean the same.
///
/// largest  one line a facet: area, origin, hits, share of directions with its interval, leads.
/// sample   null without rays.
std::string largest_report_json(const LargestFacets& found, const LargestReportContext& context);

}  // namespace ndhull
