#include "tools/processes/shard_files.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace ndhull {

std::vector<std::string> files_matching(const std::string& pattern) {
  ::glob_t found{};
  const int result = ::glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> files(found.gl_pathv, found.gl_pathv + (result == 0 ? found.gl_pathc : 0));
  ::globfree(&found);
  if (files.empty()) {
    throw Error(
        ErrorCode::kFileMissing,
        fmt::format("--points-sharded {}: found no such file, expected some; put the pattern in quotes, "
                    "like 'part-*.npy'",
                    pattern));
  }
  std::sort(files.begin(), files.end());
  return files;
}

void agree_on_error(const ProcessGroup* group, const std::optional<Error>& mine) {
  if (group == nullptr) {
    if (mine) throw *mine;
    return;
  }
  // Length, code, and one number a character; only the length without an error.
  std::vector<double> said = {0.0};
  if (mine) {
    said = {static_cast<double>(std::strlen(mine->what())), static_cast<double>(mine->code())};
    for (const char* at = mine->what(); *at != '\0'; ++at) said.push_back(static_cast<double>(*at));
  }
  said = group->all_gather(said);
  const auto first = std::find_if(said.begin(), said.end(), [](double number) { return number != 0.0; });
  if (first == said.end()) return;
  std::string message;
  std::transform(first + 2, first + 2 + static_cast<std::ptrdiff_t>(*first), std::back_inserter(message),
                 [](double number) { return static_cast<char>(number); });
  throw Error(static_cast<ErrorCode>(static_cast<int>(first[1])), message);
}

ShardFiles::ShardFiles(const std::string& pattern, const ProcessGroup* group,
                       const std::function<void()>& check) {
  std::optional<Error> error;
  std::vector<std::string> names;
  try {
    names = files_matching(pattern);
    const std::size_t rank = group == nullptr ? 0 : group->rank(),
                      size = group == nullptr ? 1 : group->size();
    for (std::size_t file = names.size() * rank / size; file < names.size() * (rank + 1) / size; ++file)
      files_.push_back(
          parse_points(FileBytes::read(names[file]), names[file], {}, 0));  // many small files can be much
    if (rank == 0) check();
  } catch (const Error& found) {
    error = found;
  }
  agree_on_error(group, error);

  shards_.exchange = group;
  std::vector<double> said;  // rows, columns, is single precision; of each file
  for (const PointFile& file : files_) {
    const PointView view = file.view();
    said.insert(said.end(), {static_cast<double>(view.rows), static_cast<double>(view.dimension),
                             view.type == ScalarType::kFloat32 ? 1.0 : 0.0});
  }
  said = shards_.all_gather(std::move(said));
  if (said.size() != 3 * names.size()) {
    throw Error(
        ErrorCode::kFileMissing,
        fmt::format("--points-sharded {}: found {} files in all processes, expected the same {} names on "
                    "every machine; use a folder that all of them see",
                    pattern, said.size() / 3, names.size()));
  }
  shards_.dimension = static_cast<std::size_t>(said[1]);
  shards_.type = ScalarType::kFloat32;
  std::size_t used = 0;
  for (std::size_t file = 0; file < names.size(); ++file) {
    const auto columns = static_cast<std::size_t>(said[3 * file + 1]);
    if (columns != shards_.dimension) {
      throw Error(
          ErrorCode::kWrongCount,
          fmt::format("{}: found {} columns, expected {} as in {}; keep files of other data out of {}",
                      names[file], columns, shards_.dimension, names.front(), pattern));
    }
    if (said[3 * file + 2] == 0.0) shards_.type = ScalarType::kFloat64;
    if (used < files_.size() && files_[used].path == names[file])
      shards_.parts.push_back({files_[used++].view(), shards_.rows});
    shards_.rows += static_cast<std::size_t>(said[3 * file]);
  }
  constexpr std::size_t kMostRows = 0xFFFF'FFFEu;
  if (shards_.rows > kMostRows) {
    throw Error(ErrorCode::kTooManyPoints,
                fmt::format("{}: found {} points, expected at most {}; take a sample", pattern, shards_.rows,
                            kMostRows));
  }
}

PointFile joined(const std::string& pattern, const PointShards& shards) {
  const std::size_t dimension = shards.dimension;
  std::vector<double> row(dimension);
  const auto for_each_row = [&](const auto& call) {
    for (const PointShard& part : shards.parts) {
      for (std::size_t i = 0; i < part.points.rows; ++i) {
        part.points.copy_row(i, row.data());
        call();
        if ((i + 1) % kShardBlock == 0) give_back_rows(part.points, i + 1 - kShardBlock, i + 1);
      }
    }
  };
  if (shards.type == ScalarType::kFloat64) {
    std::vector<double> values;
    values.reserve(shards.rows * dimension);
    for_each_row([&] { values.insert(values.end(), row.begin(), row.end()); });
    const PointView view = PointView::row_major(values.data(), shards.rows, dimension);
    return {pattern, std::move(values), view};
  }
  FileBytes bytes = FileBytes::of_size(shards.rows * dimension * sizeof(float));
  auto* next = reinterpret_cast<float*>(bytes.writable());
  for_each_row([&] {
    for (const double number : row) *next++ = static_cast<float>(number);
  });
  const PointView view =
      PointView::row_major(reinterpret_cast<const float*>(bytes.view().data()), shards.rows, dimension);
  return {pattern, std::move(bytes), view};
}

}  // namespace ndhull
