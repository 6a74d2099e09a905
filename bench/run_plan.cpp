#include "bench/run_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "bench/child_process.h"
#include "bench/hull_run.h"
#include "bench/table.h"
#include "core/error.h"
#include "tools/io/point_reader.h"
#include "tools/points/generate.h"
#include "tools/view/point_extent.h"

namespace ndhull {
namespace {

/// One repeat of a planned run.
struct Due {
  std::size_t run = 0;
  unsigned round = 0;
};

std::vector<Due> turns_of(const RunPlan& plan) {
  std::vector<Due> turns;
  for (std::size_t begin = 0, end = 0; begin < plan.runs.size(); begin = end) {
    unsigned rounds = 0;
    for (end = begin; end < plan.runs.size() && plan.runs[end].input == plan.runs[begin].input; ++end) {
      rounds = std::max(rounds, plan.runs[end].rounds);
    }
    for (unsigned round = 0; round < rounds; ++round) {
      for (std::size_t place = begin; place < end; ++place) {
        const std::size_t run = round % 2 == 0 ? place : begin + end - 1 - place;
        if (round < plan.runs[run].rounds) turns.push_back({run, round});
      }
    }
  }
  return turns;
}

// "562 facets, width 0.1, ": what the run has of these.
std::string outcome_of(const HullRun& run) {
  if (run.facets > 0)
    return fmt::format("{} facets, width {}, ", grouped_number(run.facets),
                       short_number(run.max_facet_width));
  return run.vertices > 0 ? fmt::format("{} vertices, ", grouped_number(run.vertices)) : "";
}

class Measurement {
 public:
  Measurement(const RunPlan& plan, const RunLimits& limits, const std::vector<RunRecord>& earlier,
              RecordFile& file)
      : plan_(plan), limits_(limits), file_(file), turns_(turns_of(plan)) {
    for (const RunRecord& record : earlier) earlier_.emplace(std::pair(record.key, record.round), record);
  }

  std::vector<RunRecord> measure_all() {
    for (next_ = 0; next_ < turns_.size(); ++next_) {
      const Due& due = turns_[next_];
      const RunRecord wanted = new_record(due);
      const auto found = earlier_.find({wanted.key, due.round});
      if (found != earlier_.end()) {
        remember(found->second);
      } else if (is_worth_repeating(wanted)) {
        measure_one(due, wanted);
      }
    }
    return std::move(records_);
  }

 private:
  RunRecord new_record(const Due& due) const {
    const PlannedRun& run = plan_.runs[due.run];
    const PlannedInput& input = plan_.inputs[run.input];
    return {.command = run.command,
            .group = run.group,
            .task = run.task,
            .key = {input.name, run.engine, run.options.text, run.threads},
            .round = due.round,
            .points = input.points,
            .end = {},
            .reason = {},
            .run = {}};
  }

  bool is_worth_repeating(const RunRecord& wanted) const {
    const auto last = last_of_.find(wanted.key);
    if (last == last_of_.end()) return true;
    const RunRecord& record = records_[last->second];
    return record.is_complete() && record.run.wall_seconds <= limits_.max_repeated_seconds;
  }

  void measure_one(const Due& due, RunRecord record) {
    const PlannedRun& run = plan_.runs[due.run];
    const std::string smaller = smaller_that_failed(record);
    if (!smaller.empty()) {
      record.end = "skipped";
      record.reason = smaller + " passed a limit already";
    } else {
      if (loaded_ != run.input) {
        input_ = plan_.inputs[run.input].load();
        loaded_ = run.input;
      }
      set_result(run_warm(run, due.round == 0 ? limits_.warm_ups : 0), record);
    }
    file_.write(record);
    remember(record);
    if (limits_.show_progress) show(record);
  }

  // A warm-up that fails, or takes as long as a run that is not repeated, is the measurement itself.
  ChildResult run_warm(const PlannedRun& run, unsigned warm_ups) const {
    for (unsigned count = 0; count < warm_ups; ++count) {
      ChildResult result = run_once(run);
      if (!result.done() || result.values.at("wall_seconds") > limits_.max_repeated_seconds) return result;
    }
    return run_once(run);
  }

  ChildResult run_once(const PlannedRun& run) const {
    if (run.work) {
      return run_in_child([&] { return nlohmann::json(run.work(input_)); }, limits_.max_seconds);
    }
    const bool unit_cube = plan_.inputs[run.input].unit_cube;
    if (run.engine == "qhull") {
      const std::string words =
          (unit_cube ? "QbB" : "") + run.options.qhull_options(largest_extent(input_.points.view()));
      return run_in_child(
          [&] {
            limit_address_space(limits_.max_memory_bytes);
            return nlohmann::json(run_qhull(input_, words));
          },
          limits_.max_seconds);
    }
    if (run.engine == "cgal") {
      return run_in_child([&] { return nlohmann::json(run_cgal(input_)); }, limits_.max_seconds);
    }
    if (run.engine == "lrs") {
      return run_in_child([&] { return nlohmann::json(run_lrs(input_)); }, limits_.max_seconds);
    }
    HullOptions options;
    options.accuracy = run.options.accuracy;
    options.unit_cube = unit_cube;
    options.threads = run.threads;
    options.limits.machine_memory_bytes = limits_.max_memory_bytes;
    return run_in_child([&] { return nlohmann::json(run_ndhull(input_, options, true)); },
                        limits_.max_seconds);
  }

  // Of the same engine and options; empty: none.
  std::string smaller_that_failed(const RunRecord& wanted) const {
    for (const RunRecord& record : records_) {
      const bool passed_limit = record.end == "time_limit" || (record.is_done() && !record.is_complete());
      if (passed_limit && record.task == wanted.task && record.key.engine == wanted.key.engine &&
          record.key.options == wanted.key.options && record.key.input != wanted.key.input &&
          record.points.contains("family") && wanted.points.contains("family") &&
          record.points.at("family") == wanted.points.at("family") &&
          record.points.at("dimension") <= wanted.points.at("dimension") &&
          record.points.at("points") <= wanted.points.at("points")) {
        return record.key.input;
      }
    }
    return {};
  }

  void remember(const RunRecord& record) {
    last_of_[record.key] = records_.size();
    records_.push_back(record);
  }

  // [seconds] From the run most like it: the same one, else the last of the same engine, options and task; of
  // plain hulls with four times the seconds for each dimension more.
  double expected_seconds(const RunRecord& wanted) const {
    const auto same = last_of_.find(wanted.key);
    if (same != last_of_.end()) return is_worth_repeating(wanted) ? seconds_of(records_[same->second]) : 0.0;
    for (auto record = records_.rbegin(); record != records_.rend(); ++record) {
      if (record->end == "skipped" || record->key.engine != wanted.key.engine ||
          record->key.options != wanted.key.options || record->task != wanted.task) {
        continue;
      }
      if (!wanted.task.empty()) return seconds_of(*record);
      const auto more =
          wanted.points.at("dimension").get<double>() - record->points.at("dimension").get<double>();
      const double seconds = (seconds_of(*record) + 0.01) * std::pow(4.0, more);
      return limits_.max_seconds > 0.0 ? std::min(seconds, limits_.max_seconds) : seconds;
    }
    return 0.1;
  }

  double seconds_of(const RunRecord& record) const {
    return record.is_done() ? record.run.wall_seconds : limits_.max_seconds;
  }

  void show(const RunRecord& record) const {
    double left = 0.0;
    for (std::size_t turn = next_ + 1; turn < turns_.size(); ++turn) {
      const RunRecord wanted = new_record(turns_[turn]);
      const double warm_ups = turns_[turn].round == 0 ? limits_.warm_ups : 0.0;
      if (!earlier_.contains({wanted.key, wanted.round})) left += (1.0 + warm_ups) * expected_seconds(wanted);
    }
    const std::string outcome =
        record.is_done()
            ? fmt::format("{}{} s{}", outcome_of(record.run), short_number(record.run.wall_seconds),
                          record.is_complete() ? "" : ", " + record.status())
            : record.end + ": " + record.reason;
    fmt::print(stderr, "{:>4}/{} {:<34} {:<6} {:<12} {}  [{:.0f} s, about {:.0f} s left]\n", next_ + 1,
               turns_.size(), record.key.input, record.key.engine, record.key.options, outcome,
               watch_.wall_seconds(), left);
  }

  const RunPlan& plan_;
  const RunLimits& limits_;
  RecordFile& file_;
  const std::vector<Due> turns_;
  const Stopwatch watch_;
  std::map<std::pair<RunKey, unsigned>, RunRecord> earlier_;
  std::map<RunKey, std::size_t> last_of_;
  std::vector<RunRecord> records_;
  std::size_t next_ = 0;
  std::optional<std::size_t> loaded_;
  BenchInput input_;
};

}  // namespace

const char* engine_names() { return "ndhull, qhull, cgal, lrs"; }

std::vector<RunRecord> measure(const RunPlan& plan, const RunLimits& limits,
                               const std::vector<RunRecord>& earlier, RecordFile& file) {
  for (const PlannedRun& run : plan.runs) {
    const bool is_known =
        run.engine == "ndhull" || run.engine == "qhull" || run.engine == "cgal" || run.engine == "lrs";
    if (!is_known) {
      throw Error(ErrorCode::kUsage,
                  fmt::format("engine \"{}\" is not known, expected one of {}", run.engine, engine_names()));
    }
  }
  return Measurement(plan, limits, earlier, file).measure_all();
}

PlannedInput generated_input(const std::string& family, std::size_t dimension, std::size_t count,
                             std::uint64_t seed) {
  const GenerateOptions options{
      .family = point_family(family), .dimension = dimension, .count = count, .seed = seed};
  const std::size_t rows = row_count(options);
  return {.name = fmt::format("{} {}-d, {}, seed {}", family, dimension, rows, seed),
          .points = {{"family", family}, {"dimension", dimension}, {"points", rows}, {"seed", seed}},
          .load = [options] {
            return BenchInput{generate_points(options), {}};
          }};
}

PlannedInput case_input(const BenchCase& bench_case, const std::string& data_folder) {
  const BenchInput input = bench_case.load(data_folder);
  return {.name = bench_case.name,
          .points = {{"points", input.points.rows()},
                     {"dimension", input.points.dimension},
                     {"is_sphere_set", bench_case.is_sphere_set}},
          .unit_cube = bench_case.unit_cube,
          .load = [bench_case, data_folder] { return bench_case.load(data_folder); }};
}

PlannedInput file_input(const std::string& path, bool unit_cube) {
  const PointFile file = read_points(path);
  const PointView view = file.view();
  return {.name = std::filesystem::path(path).stem().string() + (unit_cube ? ", unit cube" : ""),
          .points = {{"file", path}, {"dimension", view.dimension}, {"points", view.rows}},
          .unit_cube = unit_cube,
          .load = [path] { return load_points(path); }};
}

}  // namespace ndhull
