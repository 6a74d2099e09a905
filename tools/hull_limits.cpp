#include "tools/hull_limits.h"

#include <algorithm>

#include "approx/polytope/outer_volume.h"
#include "approx/report.h"
#include "tools/command_line/machine_memory.h"
#include "tools/io/point_reader.h"

namespace ndhull {
namespace {

/// [s] that are left of the limit since then; one that is used up leaves next to nothing, 0 is none.
double seconds_left(const Limits& limits, Clock::time_point start) {
  return limits.max_seconds > 0.0 ? std::max(limits.max_seconds - seconds_since(start), 1e-9) : 0.0;
}

}  // namespace

Limits limits_left(Limits limits, Clock::time_point start) {
  limits.max_seconds = seconds_left(limits, start);
  limits.max_memory_bytes = limit_left(limits.max_memory_bytes, resident_memory_bytes());
  limits.machine_memory_bytes = memory_of_machine();
  return limits;
}

// Measured in 5-d to 11-d.
double share_afterwards(const HullRequest& request) {
  constexpr double kText = 8.0, kBytes = 1.5, kBounding = 2.0, kSelecting = 0.5;
  if (!request.options.accuracy.is_exact()) return 0.0;
  double share = request.selection.bounded ? kBounding : request.selection.is_set() ? kSelecting : 0.0;
  if (request.selection.is_set()) return share;  // few are written
  if (!request.planes_path.empty()) share += request.planes_path.ends_with(".npy") ? kBytes : kText;
  if (request.facet_list) share += kText;
  return share + kText * static_cast<double>(request.formats.size());
}

// Ids in order for --verify (complex_check.h), with the ridges that are looked at meanwhile; normals once more
// for --bounded.
std::uint64_t bytes_afterwards(const HullRequest& request, std::size_t dimension) {
  std::uint64_t bytes = 0;
  if (request.verify) bytes = 5 * dimension + 5;
  if (request.selection.bounded && request.options.accuracy.is_exact()) bytes = 8 * dimension + 16;
  return bytes;
}

std::size_t kept_file_bytes(const Limits& limits) {
  return limits.max_memory_bytes == 0 ? kKeptFileBytes
                                      : std::min<std::size_t>(kKeptFileBytes, limits.max_memory_bytes / 16);
}

double seconds_for_measure(const Limits& limits, Clock::time_point start) {
  constexpr double kShare = 0.8;
  return kShare * seconds_left(limits, start);
}

Limits limits_for_measure(const HullRequest& request, const Hull& hull, Clock::time_point start) {
  const Limits& limits = request.options.limits;
  Limits left{.max_facets = request.outer_volume ? 0 : affordable_simplices(hull, limits),
              .max_seconds = seconds_for_measure(limits, start)};
  const std::uint64_t bytes = resident_memory_bytes();
  if (limits.max_memory_bytes > 0)
    left.max_memory_bytes = limits.max_memory_bytes > bytes ? limits.max_memory_bytes - bytes : 1;
  return left;
}

}  // namespace ndhull
