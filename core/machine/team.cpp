#include "core/machine/team.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace ndhull {
namespace {

constexpr std::uint64_t kFieldMask = 0xFFFF;
constexpr unsigned kFieldBits = 16;
/// Longer than what one thread does alone between the loops of large insertions.
constexpr std::chrono::microseconds kSpinning{200};
constexpr unsigned kPausesAtOnce = 64;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

std::size_t team_threads(std::size_t most) {
  const int threads = tbb::this_task_arena::max_concurrency();
  return std::clamp<std::size_t>(threads > 0 ? static_cast<std::size_t>(threads) : 1, 1, most);
}

Team::Team(std::size_t threads) {
  workers_.reserve(threads - 1);
  try {
    for (std::size_t i = 1; i < threads; ++i) workers_.emplace_back([this] { serve(); });
  } catch (const std::system_error&) {  // the system has no more threads: those that there are will do
  }
}

Team::~Team() {
  is_over_.store(true);
  calls_.fetch_add(1);
  calls_.notify_all();
}

void Team::for_each_block(std::size_t count, std::size_t size, const BlockWork& work) {
  const std::size_t blocks = (count + size - 1) / size;
  NDHULL_CHECK(blocks <= kFieldMask);
  if (blocks <= 1) {
    if (blocks == 1) work(0, count);
    return;
  }
  work_ = &work;
  count_ = count;
  size_ = size;
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t number = (loop_.load(std::memory_order_relaxed) >> (2 * kFieldBits)) + 1;
  loop_.store(number << (2 * kFieldBits) | std::uint64_t{blocks} << kFieldBits);
  if (sleepers_.load() > 0) {
    calls_.fetch_add(1);
    calls_.notify_all();
  }
  while (take_block()) {
  }
  // Another thread is at the last block, or was taken off its core there.
  for (unsigned waited = 0; done_.load(std::memory_order_acquire) != blocks; ++waited) {
    constexpr unsigned kPatience = 4096;
    if (waited < kPatience) {
      pause();
    } else {
      std::this_thread::yield();
    }
  }
  if (has_failed_.exchange(false)) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// Takes a block of the present loop and does it; false when there is none.
bool Team::take_block() {
  std::uint64_t loop = loop_.load();
  for (;;) {
    const std::uint64_t block = loop & kFieldMask, blocks = loop >> kFieldBits & kFieldMask;
    if (block >= blocks) return false;
    if (!loop_.compare_exchange_weak(loop, loop + 1)) continue;
    try {
      (*work_)(block * size_, std::min(count_, (block + 1) * size_));
    } catch (...) {
      if (!has_failed_.exchange(true)) failure_ = std::current_exception();
    }
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }
}

void Team::serve() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_work = Clock::now();
  while (!is_over_.load(std::memory_order_relaxed)) {
    bool worked = false;
    for (unsigned i = 0; i < kPausesAtOnce; ++i) {
      if (take_block()) {
        worked = true;
      } else {
        pause();
      }
    }
    const Clock::time_point now = Clock::now();
    if (worked) last_work = now;
    if (now - last_work < kSpinning) continue;
    sleep();
    last_work = Clock::now();
  }
}

// Whoever starts a loop looks for sleepers after it is there; whoever falls asleep looks for a loop after it
// has said so. One of the two sees the other.
void Team::sleep() {
  const std::uint32_t calls = calls_.load();
  sleepers_.fetch_add(1);
  const std::uint64_t loop = loop_.load();
  const bool has_blocks = (loop & kFieldMask) < (loop >> kFieldBits & kFieldMask);
  if (!has_blocks && !is_over_.load()) calls_.wait(calls);
  sleepers_.fetch_sub(1);
}

}  // namespace ndhull
