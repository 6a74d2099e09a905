// The program's `new`: vectors of some hundred kilobytes and more come from the store of blocks, like the
// engine's own tables. A vector of the allocator's goes back to the system when it is freed, and each page of
// the next one is an interrupt: half a microsecond, ten on some virtual machines. Those too large for the
// store get huge pages. The library leaves the `new` of programs alone; one that computes hulls of hundreds
// of thousands of facets may link this file.
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <new>

#include "core/machine/block_store.h"

// Sanitizers have their own, which know where each block ends. (gcc defines a name, clang answers a
// question.)
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define NDHULL_HAS_SANITIZER
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define NDHULL_HAS_SANITIZER
#endif

#ifndef NDHULL_HAS_SANITIZER

namespace {

/// Asks for huge pages. Advice: failure costs speed only.
void* in_huge_pages(void* address, std::size_t bytes) {
  constexpr std::uintptr_t kPage = 4096;
  const std::uintptr_t begin = (reinterpret_cast<std::uintptr_t>(address) + kPage - 1) / kPage * kPage;
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(address) + bytes) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  return address;
}

}  // namespace

void* operator new(std::size_t bytes) {
  if (void* const block = ndhull::take_block(bytes)) return block;
  for (;;) {
    if (void* const address = std::malloc(bytes == 0 ? 1 : bytes))
      return bytes > ndhull::kLargestBlock ? in_huge_pages(address, bytes) : address;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* address) noexcept {
  if (!ndhull::give_block(address)) std::free(address);
}
void operator delete(void* address, std::size_t) noexcept { operator delete(address); }

void* operator new[](std::size_t bytes) { return operator new(bytes); }
void operator delete[](void* address) noexcept { operator delete(address); }
void operator delete[](void* address, std::size_t) noexcept { operator delete(address); }

#endif
