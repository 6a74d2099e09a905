#include "core/huge_array.h"

#include <sys/mman.h>

#include <cstdint>
#include <new>

namespace ndhull {
namespace {

constexpr std::size_t kPageBytes = 4096;
// Below this size huge pages would only waste memory: small hulls stay small.
constexpr std::size_t kHugePageBytes = std::size_t{1} << 21;

std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

}  // namespace

void* reserve_pages(std::size_t bytes) {
  const std::size_t rounded = round_up(bytes, kPageBytes);
  void* address =
      mmap(nullptr, rounded, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (address == MAP_FAILED) throw std::bad_alloc();
  if (rounded >= kHugePageBytes)
    madvise(address, rounded, MADV_HUGEPAGE);  // advice: failure costs speed only
  return address;
}

void release_pages(void* address, std::size_t bytes) { munmap(address, round_up(bytes, kPageBytes)); }

void discard_pages(void* from, void* to) {
  const std::size_t begin = round_up(reinterpret_cast<std::uintptr_t>(from), kPageBytes);
  const std::size_t end = reinterpret_cast<std::uintptr_t>(to) / kPageBytes * kPageBytes;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace ndhull
