// What a run made and how, as JSON: the counts, the certified numbers, the options, the times.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "approx/hull.h"

namespace ndhull {

struct FacetSelection;
struct OuterDistance;
struct OuterVolume;
struct Verification;

/// The version of the library, like 1.2.3.
std::string_view version();

/// The value of an option: std::monostate is null, an option that is off.
using OptionValue = std::variant<std::monostate, bool, std::uint64_t, double, std::string>;

/// What the report says and the hull does not know.
struct ReportContext {
  std::string input_path;
  HullOptions options;  ///< the ones the hull was made with
  /// Options of the program beyond them, in the order they are reported.
  std::vector<std::pair<std::string, OptionValue>> program_options = {};

  double read_seconds = 0.0;
  double select_seconds = 0.0;
  double outer_volume_seconds = 0.0;
  double write_seconds = 0.0;  ///< of all results but the report
  double total_seconds = 0.0;
  double verify_seconds = 0.0;
  std::uint64_t peak_memory_bytes = 0;

  const Verification* verification = nullptr;     ///< null: not verified
  const FacetSelection* selection = nullptr;      ///< null: all facets
  const OuterDistance* outer_distance = nullptr;  ///< of the selection; null: not computed
  const OuterVolume* outer_volume = nullptr;  ///< of the selection, else of all facets; null: not computed
  bool facet_list = false;
};

/// Writes the report: a JSON object of a few dozen lines, and with facet_list one line a facet.
///
/// Keys      as the documentation of `ndhull hull --report` lists them; lengths are in `length_unit`, offsets
///           of planes, normals, areas and volumes in input units.
/// Numbers   read back as the same doubles. A ratio without a divisor, and what is not known, is null.
/// Planes    facet_list: distance(x) = normal.x + offset; the certified plane is
///           normal.(x - reference) + centred_offset, which is the same up to roundoff.
/// Selection facet_list has the selected facets, each with its `id`; neighbours are ids, selected or not.
/// Sink      gets the text in pieces; memory does not grow with the facets.
void write_hull_report(const Hull& hull, const ReportContext& context,
                       const std::function<void(std::string_view)>& sink);

/// The same in one string.
std::string hull_report_json(const Hull& hull, const ReportContext& context);

/// The largest memory the process has had so far. [bytes] 0 where the system does not tell.
std::uint64_t peak_memory_bytes();
/// The memory that it has now. [bytes] 0 where the system does not tell.
std::uint64_t resident_memory_bytes();

}  // namespace ndhull
