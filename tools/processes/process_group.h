// The processes that mpirun started together, if it did.
#pragma once

#include <cstddef>
#include <memory>

#include "approx/reduction/point_shards.h"

namespace ndhull {

/// One of several processes. Every call of ShardExchange is made by all of them, in the same order.
class ProcessGroup : public ShardExchange {
 public:
  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;
  /// Of this group, on this machine, this one among them.
  virtual std::size_t processes_on_machine() const = 0;
  /// Ends all processes at once with this exit code, this one at the latest when it returns and exits.
  virtual void end_all(int exit_code) const = 0;
  bool is_first() const override { return rank() == 0; }
};

/// The group that this process was started in; null when it was started alone. MPI is loaded only then: the
/// program starts faster without.
///
/// Throws  Error kUsage when mpirun started several processes and this build has no MPI.
std::unique_ptr<ProcessGroup> join_processes();

}  // namespace ndhull
