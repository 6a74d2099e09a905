// What a run of `ndhull hull` hands on of its limits: to growth, to what comes after it, to reading.
#pragma once

#include <cstddef>
#include <cstdint>

#include "approx/hull.h"
#include "core/machine/stopwatch.h"
#include "tools/hull_run.h"

namespace ndhull {

/// What is left of the limits since `start`, or what the machine has.
Limits limits_left(Limits limits, Clock::time_point start);

/// What is done with each facet of an exact hull once there are facets, for Limits::share_afterwards.
double share_afterwards(const HullRequest& request);

/// [bytes] of each simplex, for Limits::bytes_afterwards.
std::uint64_t bytes_afterwards(const HullRequest& request, std::size_t dimension);

/// [bytes] How large a mapped file may be to stay in memory: a small part of what is allowed.
std::size_t kept_file_bytes(const Limits& limits);

/// [s] of what is left of the limit for one more number in the report, since the rest has to be written too;
/// 0: no limit.
double seconds_for_measure(const Limits& limits, Clock::time_point start);

/// For what the outer polytope measures: little beside the hull, or what was asked for within all limits.
Limits limits_for_measure(const HullRequest& request, const Hull& hull, Clock::time_point start);

}  // namespace ndhull
