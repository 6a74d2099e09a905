#include "core/machine/huge_array.h"

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include "core/machine/block_store.h"

namespace ndhull {
namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kHugePageBytes = std::size_t{1} << 21;
constexpr std::size_t kLineBytes = 64;
// In small pages, unless all of it will soon be written: of twenty tables most hold little, and a huge page
// for each would be memory that nobody needs.
constexpr std::size_t kSmallPartBytes = std::size_t{1} << 19;
static_assert(kLeastPagesBytes == kSmallestBlock);

std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

void* allocate_small(std::size_t bytes) {
  void* const address = std::aligned_alloc(kLineBytes, round_up(bytes, kLineBytes));
  if (address == nullptr) throw std::bad_alloc();
  return address;
}

}  // namespace

// Placed so that huge pages can begin where the small part ends.
void* reserve_pages(std::size_t bytes, std::size_t at_once) {
  if (bytes < kLeastPagesBytes) return std::memset(allocate_small(bytes), 0, bytes);
  const std::size_t rounded = round_up(bytes, kPageBytes);
  const std::size_t small_part = at_once < kSmallPartBytes ? kSmallPartBytes : 0;
  const bool has_huge = rounded >= small_part + kHugePageBytes;
  const std::size_t mapped = has_huge ? rounded + kHugePageBytes : rounded;
  void* const address =
      mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (address == MAP_FAILED) throw std::bad_alloc();
  if (!has_huge) return address;
  const auto first = reinterpret_cast<std::uintptr_t>(address);
  const std::uintptr_t huge = round_up(first + small_part, kHugePageBytes);
  const std::uintptr_t begin = huge - small_part, end = begin + rounded;
  if (begin > first) munmap(address, begin - first);
  if (first + mapped > end) munmap(reinterpret_cast<void*>(end), first + mapped - end);
  madvise(reinterpret_cast<void*>(huge), end - huge, MADV_HUGEPAGE);  // advice: failure costs speed only
  return reinterpret_cast<void*>(begin);
}

void* take_pages(std::size_t bytes) {
  if (bytes < kLeastPagesBytes) return allocate_small(bytes);
  void* const block = take_block(bytes);
  return block != nullptr ? block : reserve_pages(bytes, bytes);
}

void release_pages(void* address, std::size_t bytes) {
  if (bytes < kLeastPagesBytes) {
    std::free(address);
  } else if (!give_block(address)) {
    munmap(address, round_up(bytes, kPageBytes));
  }
}

void discard_pages(void* from, void* to) {
  const std::size_t begin = round_up(reinterpret_cast<std::uintptr_t>(from), kPageBytes);
  const std::size_t end = reinterpret_cast<std::uintptr_t>(to) / kPageBytes * kPageBytes;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

void discard_tail(void* from, void* to) {
  if (is_in_store(from)) return;
  constexpr std::size_t kWorthDividing = kHugePageBytes / 4;
  const auto first = reinterpret_cast<std::uintptr_t>(from);
  const bool divides = first % kHugePageBytes < kWorthDividing;
  discard_pages(divides ? from : reinterpret_cast<void*>(round_up(first, kHugePageBytes)), to);
}

}  // namespace ndhull
