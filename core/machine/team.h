// A few threads that wait for short loops while they are hot: starting one costs well below a microsecond.
//
// oneTBB's workers sleep between loops and take 5 to 50 us to come; one insertion of growth has some forty
// loops of about that length. A team belongs to one growth, as long as it lasts.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "core/machine/blocks.h"

namespace ndhull {

/// How many threads a team of this thread may have: those of its task arena, at most `most`.
std::size_t team_threads(std::size_t most);

/// Loops over blocks, shared by the thread that asks and others that spin for a while, then sleep.
///
/// Blocks are taken one at a time, so a thread that the system has taken off its core holds up no more than
/// the block that it is at.
class Team {
 public:
  /// `threads`: with the one that calls, at least 1. Starts the others, or as many as the system has.
  explicit Team(std::size_t threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  std::size_t threads() const { return workers_.size() + 1; }

  /// Calls work(begin, end) for the blocks [0, size), [size, 2 size), ... of [0, count), the last one
  /// shorter. At most 65,535 blocks, one loop at a time. Throws what `work` threw first, when all blocks
  /// are done.
  void for_each_block(std::size_t count, std::size_t size, const BlockWork& work);

 private:
  void serve();
  bool take_block();
  void sleep();

  // Loop number (32 bits), blocks in it (16), blocks taken (16): one word, so that a thread that comes late
  // takes no block of another loop.
  alignas(64) std::atomic<std::uint64_t> loop_ = 0;
  alignas(64) std::atomic<std::uint32_t> done_ = 0;  // blocks of this loop
  // Written between loops only: whoever has taken a block may read them.
  alignas(64) const BlockWork* work_ = nullptr;
  std::size_t count_ = 0, size_ = 1;
  alignas(64) std::atomic<std::uint32_t> sleepers_ = 0;
  std::atomic<std::uint32_t> calls_ = 0;  // changes when sleepers are to wake up
  std::atomic<bool> is_over_ = false;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr failure_;  // of who set has_failed_
  std::vector<std::jthread> workers_;
};

}  // namespace ndhull
