// Where the points of `ndhull hull` come from: one input, or files that one process or several share.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "approx/sharded_hull.h"
#include "approx/verify/verify.h"
#include "tools/io/point_reader.h"
#include "tools/processes/process_group.h"
#include "tools/processes/shard_files.h"

namespace ndhull {

/// The points of this process, and then their hull.
///
/// Several processes: all make the same calls in the same order. An Error is thrown in all of them when any
/// has one; what else one throws ends all, after one line on standard error.
class HullInput {
 public:
  /// Opens `points_path` (`columns`, `kept_bytes`: as read_points has it), or the files of `shards_pattern`
  /// where that is not empty. `check` is called by the first process once its points are known to be good.
  /// `group`: null for one process. Throws  Error as read_points and ShardFiles do, and what `check` throws.
  HullInput(const std::string& points_path, const ColumnChoice& columns, std::size_t kept_bytes,
            const std::string& shards_pattern, const ProcessGroup* group, const std::function<void()>& check);

  /// The hull of all points: in the first process, nothing in the others. Points of it are rows of view().
  std::optional<Hull> compute(const HullOptions& options);

  /// verify_hull of what the first process has, and every plane against every point of every process,
  /// exactly. `hull`: null but in the first process, which alone gets what was found: the first failure, or
  /// "".
  std::string verify(const Hull* hull, VerifyMode mode, unsigned threads, Verification& verification) const;

  /// From now on points of the hull are rows of all points, also of those that other processes hold.
  void number_as_whole(Hull& hull) const;

  std::size_t dimension() const { return shards_ ? shards_->shards().dimension : file_.view().dimension; }
  /// The points of one process; of several, in the first one, those that were kept.
  PointView view() const { return kept_ ? kept_->view() : file_.view(); }

 private:
  const ProcessGroup* group_;
  PointFile file_;
  std::unique_ptr<ShardFiles> shards_;  // of several processes
  std::optional<ReducedPoints> kept_;   // theirs, in the first one
};

}  // namespace ndhull
