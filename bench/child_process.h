// A measurement in a process of its own: its peak memory is its own, and it may crash or be stopped.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ndhull {

/// What became of one measurement.
struct ChildResult {
  enum class End { kDone, kFailed, kCrashed, kTimeLimit };
  End end = End::kFailed;
  std::string reason;            ///< not for kDone: the message, the signal, or the limit; one line
  nlohmann::json values;         ///< kDone: what the work returned
  std::uint64_t peak_bytes = 0;  ///< largest resident memory of the child, with what it shares with us
  bool done() const { return end == End::kDone; }
};

/// Runs `work` in a forked child, waits for it, and returns what it returned.
///
/// Failure   an exception of `work` is kFailed with its message; a signal is kCrashed; more than
///           `max_seconds` of wall clock (0: no limit) is kTimeLimit, and the child is killed.
/// Requires  that this process has one thread: a forked child has only the thread that called fork.
/// Throws    std::system_error when no process can be made.
/// Not promised  destructors: the child ends without running those of static objects.
ChildResult run_in_child(const std::function<nlohmann::json()>& work, double max_seconds);

/// The same in so many children at the same time. Each has the whole time limit from when the one before it
/// ended.
std::vector<ChildResult> run_in_children(const std::function<nlohmann::json()>& work, std::size_t count,
                                         double max_seconds);

/// What a program took from its start to its end, starting it and reading and writing its files included.
struct ProgramRun {
  double wall_seconds = 0.0, cpu_seconds = 0.0;
  std::uint64_t peak_bytes = 0;  ///< largest resident memory
};

/// Runs a program, found as the shell finds it, from file to file; what it says on standard error goes where
/// ours goes. It ends with the process that waits for it: call it in a child that has a time limit.
/// Throws std::runtime_error when it cannot be started, or ends with anything but exit code 0.
ProgramRun run_program(const std::vector<std::string>& words, const std::string& input_path,
                       const std::string& output_path);

/// The largest address space of this process from now on, so that allocations beyond it fail; 0: as it is.
/// For a child that runs what has no limit of its own.
void limit_address_space(std::uint64_t bytes);

/// [bytes] Resident memory of this process now; 0 where the system does not say.
std::uint64_t resident_bytes();

/// [bytes] The largest resident memory that this process has had.
std::uint64_t peak_resident_bytes();

/// Wall clock and processor time (all threads) since construction.
class Stopwatch {
 public:
  Stopwatch();
  double wall_seconds() const;
  double cpu_seconds() const;

 private:
  double wall_start_, cpu_start_;
};

}  // namespace ndhull
