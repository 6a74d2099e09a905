#include "bench/result_folder.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"

namespace ndhull {

std::vector<RunRecord> read_result_folder(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".jsonl") paths.push_back(entry.path().string());
  }
  if (error) throw Error(ErrorCode::kFileMissing, folder + ": " + error.message());
  if (paths.empty()) throw Error(ErrorCode::kFileMissing, folder + ": found no results, files *.jsonl");
  std::sort(paths.begin(), paths.end());
  std::vector<RunRecord> records;
  for (const std::string& path : paths) {
    for (RunRecord& record : read_records(path)) records.push_back(std::move(record));
  }
  return records;
}

}  // namespace ndhull
