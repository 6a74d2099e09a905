#include "core/huge_array.h"

#include <sys/mman.h>

#include <cstdint>
#include <new>

#include "core/block_store.h"

namespace ndhull {
namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kHugePageBytes = std::size_t{1} << 21;
// The first part of an array is in small pages, so that many small arrays do not each clear a huge one: where
// the machine is virtual, memory that it has not used for a while costs 2 ms a huge page. A small hull has
// about 20 arrays.
constexpr std::size_t kSmallPartBytes = std::size_t{1} << 19;

std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

}  // namespace

// Placed so that the small part ends where huge pages can begin.
void* reserve_pages(std::size_t bytes) {
  const std::size_t rounded = round_up(bytes, kPageBytes);
  const bool is_small = rounded <= kSmallPartBytes;
  const std::size_t mapped = is_small ? rounded : rounded + kHugePageBytes;
  void* address =
      mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (address == MAP_FAILED) throw std::bad_alloc();
  if (is_small) return address;
  const auto first = reinterpret_cast<std::uintptr_t>(address);
  const std::uintptr_t huge = round_up(first + kSmallPartBytes, kHugePageBytes);
  const std::uintptr_t begin = huge - kSmallPartBytes;
  const std::uintptr_t end = begin + rounded;
  if (begin > first) munmap(address, begin - first);
  if (first + mapped > end) munmap(reinterpret_cast<void*>(end), first + mapped - end);
  madvise(reinterpret_cast<void*>(huge), end - huge, MADV_HUGEPAGE);  // advice: failure costs speed only
  return reinterpret_cast<void*>(begin);
}

void* take_pages(std::size_t bytes) {
  void* const block = take_block(bytes);
  return block != nullptr ? block : reserve_pages(bytes);
}

void release_pages(void* address, std::size_t bytes) {
  if (!give_block(address)) munmap(address, round_up(bytes, kPageBytes));
}

void discard_pages(void* from, void* to) {
  if (is_in_store(from)) return;
  const std::size_t begin = round_up(reinterpret_cast<std::uintptr_t>(from), kPageBytes);
  const std::size_t end = reinterpret_cast<std::uintptr_t>(to) / kPageBytes * kPageBytes;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace ndhull
