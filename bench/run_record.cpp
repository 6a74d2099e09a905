#include "bench/run_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "bench/machine.h"
#include "bench/sample.h"
#include "bench/table.h"
#include "core/error.h"

namespace ndhull {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::kFileMissing, path + ": cannot be opened");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string RunRecord::status() const {
  return run.detail.is_object() ? run.detail.value("status", std::string()) : std::string();
}

std::string end_name(ChildResult::End end) {
  switch (end) {
    case ChildResult::End::kDone: return "done";
    case ChildResult::End::kFailed: return "failed";
    case ChildResult::End::kCrashed: return "crashed";
    case ChildResult::End::kTimeLimit: return "time_limit";
  }
  return {};
}

void to_json(nlohmann::json& json, const RunRecord& record) {
  json = record.is_done() ? nlohmann::json(record.run) : nlohmann::json{{"reason", record.reason}};
  json["command"] = record.command;
  if (!record.group.empty()) json["group"] = record.group;
  if (!record.task.empty()) json["task"] = record.task;
  json["input"] = record.key.input;
  json["engine"] = record.key.engine;
  json["options"] = record.key.options;
  json["threads"] = record.key.threads;
  json["round"] = record.round;
  json["points"] = record.points;
  json["end"] = record.end;
  json["peak_bytes"] = record.peak_bytes;
  if (!record.machine.is_null()) json["machine"] = record.machine;
}

void from_json(const nlohmann::json& json, RunRecord& record) {
  json.at("command").get_to(record.command);
  record.group = json.value("group", std::string());
  record.task = json.value("task", std::string());
  json.at("input").get_to(record.key.input);
  json.at("engine").get_to(record.key.engine);
  json.at("options").get_to(record.key.options);
  json.at("threads").get_to(record.key.threads);
  json.at("round").get_to(record.round);
  json.at("end").get_to(record.end);
  json.at("peak_bytes").get_to(record.peak_bytes);
  record.points = json.at("points");
  record.machine = json.value("machine", nlohmann::json());
  if (record.is_done()) {
    json.get_to(record.run);
  } else {
    json.at("reason").get_to(record.reason);
  }
}

void set_result(const ChildResult& result, RunRecord& record) {
  record.end = end_name(result.end);
  record.reason = result.reason;
  record.peak_bytes = result.peak_bytes;
  if (!result.done()) return;
  result.values.get_to(record.run);
  // What the child did after the call is not the engine's.
  if (record.run.peak_bytes > 0) record.peak_bytes = record.run.peak_bytes;
}

double Repeats::median_seconds() const {
  std::vector<double> seconds;
  for (const RunRecord& record : done) seconds.push_back(record.run.wall_seconds);
  return median(seconds);
}

std::uint64_t Repeats::peak_bytes() const {
  std::uint64_t peak = 0;
  for (const RunRecord& record : done) peak = std::max(peak, record.peak_bytes);
  return peak;
}

void add_repeat(const RunRecord& record, Repeats& repeats) {
  if (record.is_done()) {
    repeats.done.push_back(record);
  } else {
    repeats.failure = record.reason;
  }
}

std::string seconds_with_spread(const Repeats& repeats) {
  if (repeats.is_empty()) return "-";
  std::vector<double> seconds;
  for (const RunRecord& record : repeats.done) seconds.push_back(record.run.wall_seconds);
  const auto [low, high] = std::minmax_element(seconds.begin(), seconds.end());
  if (seconds.size() == 1) return short_number(*low);
  return fmt::format("{} ({} .. {})", short_number(repeats.median_seconds()), short_number(*low),
                     short_number(*high));
}

std::string ratio_spread(const Repeats& ndhull, const Repeats& other) {
  std::vector<double> ratios;
  for (const RunRecord& ours : ndhull.done) {
    for (const RunRecord& theirs : other.done) {
      if (ours.round == theirs.round) ratios.push_back(theirs.run.wall_seconds / ours.run.wall_seconds);
    }
  }
  if (ratios.size() < 2) return {};
  const auto [low, high] = std::minmax_element(ratios.begin(), ratios.end());
  return fmt::format("{} .. {}", short_number(*low), short_number(*high));
}

std::vector<RunRecord> read_records(const std::string& path) {
  const std::string text = read_text(path);
  std::vector<RunRecord> records;
  std::size_t line_number = 0;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    ++line_number;
    try {
      records.push_back(nlohmann::json::parse(text.substr(begin, end - begin)).get<RunRecord>());
    } catch (const nlohmann::json::exception& error) {
      throw Error(ErrorCode::kBadHeader,
                  fmt::format("{}, line {}: found no record of a run ({})", path, line_number, error.what()));
    }
  }
  return records;
}

RecordFile::RecordFile(const std::string& path, bool append) : path_(path), machine_(describe_machine()) {
  if (path.empty()) return;
  if (append && std::filesystem::exists(path)) {
    const std::string text = read_text(path);
    const std::size_t last = text.rfind('\n');
    std::filesystem::resize_file(path, last == std::string::npos ? 0 : last + 1);
  }
  file_.open(path, append ? std::ios::app : std::ios::trunc);
  if (!file_) throw Error(ErrorCode::kFileWrite, path + ": cannot be written");
}

void RecordFile::write(nlohmann::json line) {
  if (path_.empty()) return;
  if (!line.contains("machine")) line["machine"] = machine_;
  if (!(file_ << line.dump() << std::endl)) throw Error(ErrorCode::kFileWrite, path_ + ": cannot be written");
}

}  // namespace ndhull
