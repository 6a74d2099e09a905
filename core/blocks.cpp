#include "core/blocks.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace ndhull {

bool has_more_threads() { return tbb::this_task_arena::max_concurrency() > 1; }

void for_each_block(std::size_t count, std::size_t size, BlockWork work) {
  const auto run = [&](std::size_t block) { work(block * size, std::min(count, (block + 1) * size)); };
  const std::size_t blocks = (count + size - 1) / size;
  if (blocks <= 1 || !has_more_threads()) {
    for (std::size_t block = 0; block < blocks; ++block) run(block);
  } else {
    tbb::parallel_for(std::size_t{0}, blocks, run);
  }
}

}  // namespace ndhull
