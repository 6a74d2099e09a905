#include "core/machine/blocks.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "core/error.h"

namespace ndhull {

bool has_more_threads() { return tbb::this_task_arena::max_concurrency() > 1; }

// The two flags say again what parallel_for guarantees: a block comes after what was done before the loop,
// and before what is done after it. The thread sanitizer does not see that in a oneTBB that is not built for
// it.
void for_each_block(std::size_t count, std::size_t size, BlockWork work) {
  const auto run = [&](std::size_t block) { work(block * size, std::min(count, (block + 1) * size)); };
  const std::size_t blocks = (count + size - 1) / size;
  if (blocks <= 1 || !has_more_threads()) {
    for (std::size_t block = 0; block < blocks; ++block) run(block);
    return;
  }
  struct Shared {
    const decltype(run)* run_block = nullptr;
    std::atomic<bool> has_begun = false;
    std::atomic<std::size_t> done = 0;
  };
  Shared shared;
  shared.run_block = &run;
  shared.has_begun.store(true, std::memory_order_release);
  tbb::parallel_for(std::size_t{0}, blocks, [&shared](std::size_t block) {
    if (shared.has_begun.load(std::memory_order_acquire)) (*shared.run_block)(block);
    shared.done.fetch_add(1, std::memory_order_release);
  });
  NDHULL_CHECK(shared.done.load(std::memory_order_acquire) == blocks);
}

void run_alone(BlockWork work) {
  if (!has_more_threads()) return work(0, 1);
  tbb::task_arena one(1);
  one.execute([&] { work(0, 1); });
}

}  // namespace ndhull
