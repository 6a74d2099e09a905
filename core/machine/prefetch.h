// Asking for memory before it is read.
#pragma once

#include <cstddef>

namespace ndhull {

/// Begins the way of a record from memory to the cache: of the line that it begins in. The address need not
/// be valid.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* record) {
  // GCC takes a function that does nothing but this for one without effect, and leaves out calls of it.
  asm volatile("");
  __builtin_prefetch(record);
}

/// Of `count` elements, at least one: the lines of the first and of the last.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T* first, std::size_t count) {
  prefetch(first);
  __builtin_prefetch(first + count - 1);
}

}  // namespace ndhull
