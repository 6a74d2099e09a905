// Loops over fixed blocks, shared out among threads.
//
// What a block holds never depends on the number of threads: work that starts afresh with each block, and is
// put together in the order of the blocks, gives the same bits for any number.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace ndhull {

/// A reference to a callable that outlives the call it is passed to. No memory, one indirect call.
class BlockWork {
 public:
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, BlockWork>)
      BlockWork(Callable&& callable)  // implicit: lambdas are passed as they are
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callable)))),
        call_([](void* object, std::size_t begin, std::size_t end) {
          (*static_cast<std::remove_reference_t<Callable>*>(object))(begin, end);
        }) {}
  void operator()(std::size_t begin, std::size_t end) const { call_(object_, begin, end); }

 private:
  void* object_;
  void (*call_)(void*, std::size_t, std::size_t);
};

/// May loops of this thread be shared with others?
bool has_more_threads();

/// Calls work(begin, end) for the blocks [0, size), [size, 2 size), ... of [0, count), the last one shorter:
/// at the same time where there are threads, otherwise one after the other. `size` is at least 1.
void for_each_block(std::size_t count, std::size_t size, BlockWork work);

/// Calls both, at the same time where there are threads; loops of `second` are not shared out then.
template <class First, class Second>
void do_beside(const First& first, const Second& second);

/// Calls work(0, 1) with loops that are not shared out: for work that is one of many blocks itself.
void run_alone(BlockWork work);

template <class First, class Second>
void do_beside(const First& first, const Second& second) {
  if (!has_more_threads()) {
    first();
    second();
    return;
  }
  for_each_block(2, 1, [&](std::size_t begin, std::size_t) {
    if (begin == 0) {
      first();
    } else {
      run_alone([&](std::size_t, std::size_t) { second(); });
    }
  });
}

}  // namespace ndhull
