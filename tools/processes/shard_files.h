// Points in several files: --points-sharded.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "approx/reduction/point_shards.h"
#include "core/error.h"
#include "tools/io/point_reader.h"
#include "tools/processes/process_group.h"

namespace ndhull {

/// The files that a pattern with * ? [...] names, in the order of their bytes.
/// Throws Error kFileMissing when there are none.
std::vector<std::string> files_matching(const std::string& pattern);

/// The files of this process and what all processes know of the others'.
class ShardFiles {
 public:
  /// Opens the share of this process: of F files and R processes, process r has F r / R .. F (r + 1) / R.
  /// Called by all processes; `group` is null for one, which then has all, and must outlive this.
  ///
  /// Throws  Error as read_points does, kWrongCount when files differ in their columns: the same in all
  ///         processes, whichever found it. `check` is called by the first one and may throw too.
  ShardFiles(const std::string& pattern, const ProcessGroup* group, const std::function<void()>& check);

  const PointShards& shards() const { return shards_; }

 private:
  std::vector<PointFile> files_;
  PointShards shards_;
};

/// Rows of all parts, one after the other, in memory.
PointFile joined(const std::string& pattern, const PointShards& shards);

/// Throws the error of the first process that has one, in all of them.
void agree_on_error(const ProcessGroup* group, const std::optional<Error>& mine);

}  // namespace ndhull
