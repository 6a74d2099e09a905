// One measured run as one line of JSON: what every command but `peers` writes, and what `report` and
// `compare` read.
#pragma once

#include <compare>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/child_process.h"
#include "bench/hull_run.h"

namespace ndhull {

/// Which measurement a run is of. Runs with equal keys are repeats.
struct RunKey {
  std::string input;    ///< name of the points
  std::string engine;   ///< ndhull, qhull, cgal, lrs
  std::string options;  ///< text of the option set
  unsigned threads = 1;

  friend auto operator<=>(const RunKey&, const RunKey&) = default;
};

/// A run and what came of it.
struct RunRecord {
  std::string command;  ///< of ndhull-bench, that made it
  std::string group;    ///< of runs that are compared with each other; may be empty
  std::string task;     ///< what the run is for in its group; may be empty
  RunKey key;
  unsigned round = 0;
  nlohmann::json points;  ///< of the input: points, dimension, and where it has them family, seed
  std::string end;        ///< done, failed, crashed, time_limit
  std::string reason;     ///< not for done
  std::uint64_t peak_bytes = 0;
  HullRun run;                       ///< for done
  nlohmann::json machine = nullptr;  ///< read from a file: where it was measured

  bool is_done() const { return end == "done"; }
  /// What the engine says itself of how it ended: "complete", a limit's name; "" of engines that do not say.
  std::string status() const;
  bool is_complete() const { return is_done() && (status().empty() || status() == "complete"); }
};

void to_json(nlohmann::json& json, const RunRecord& record);
void from_json(const nlohmann::json& json, RunRecord& record);

std::string end_name(ChildResult::End end);
/// Takes over what a child returned: a HullRun, or why there is none.
void set_result(const ChildResult& result, RunRecord& record);

/// The runs of one measurement.
struct Repeats {
  std::vector<RunRecord> done;
  std::string failure;  ///< of the last run that was not done; empty: none

  bool is_empty() const { return done.empty(); }
  const HullRun& last() const { return done.back().run; }
  double median_seconds() const;
  std::uint64_t peak_bytes() const;  ///< largest
};
void add_repeat(const RunRecord& record, Repeats& repeats);

/// "0.171 (0.17 .. 0.18)": the median, and with more than one run the smallest and the largest.
std::string seconds_with_spread(const Repeats& repeats);

/// "4.9 .. 5.5": the smallest and the largest of `other`'s seconds over `ndhull`'s in one round; empty when
/// fewer than two rounds have both.
std::string ratio_spread(const Repeats& ndhull, const Repeats& other);

/// The records of a file of JSON lines, in order. A last line that is not whole (the writer was stopped) is
/// left out. Throws Error kFileMissing; kBadHeader: a line is no record, the message has its number.
std::vector<RunRecord> read_records(const std::string& path);

/// Appends lines to a file as they are measured, so that what was measured stays when a long bench is
/// interrupted. Each line gets the machine's description.
class RecordFile {
 public:
  /// An empty path writes nothing. `append`: after what the file has, less a last line that is not whole.
  /// Throws Error kFileWrite.
  RecordFile(const std::string& path, bool append);
  /// Throws Error kFileWrite.
  void write(nlohmann::json line);

 private:
  std::string path_;
  std::ofstream file_;
  nlohmann::json machine_;
};

}  // namespace ndhull
