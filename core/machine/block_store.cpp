#include "core/machine/block_store.h"

#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <new>

namespace ndhull {
namespace {

constexpr std::size_t kStoreLine = 64;
constexpr std::size_t kStorePage = std::size_t{1} << 21;
constexpr std::size_t kMostAddresses = std::size_t{1} << 30;
constexpr std::size_t kMostKept = std::size_t{1} << 26;  // bytes of one free place
// Less is left at the end of the block before, since a place so small would only be looked at again and
// again.
constexpr std::size_t kSmallestPlace = std::size_t{1} << 12;

char* next_multiple(char* address, std::size_t unit) {
  const auto number = reinterpret_cast<std::uintptr_t>(address);
  return address + ((unit - number % unit) % unit);
}

/// Stands before each block and at the begin of each free place.
struct StorePlace {
  std::size_t bytes;      // with this
  StorePlace* next_free;  // by address
};
static_assert(sizeof(StorePlace) <= kStoreLine);

// All of it is constant before the program starts and nothing is destroyed: the program's own `new` may call
// it.
class BlockStore {
 public:
  void* take(std::size_t bytes) noexcept {
    const std::size_t wanted = (bytes + kStoreLine - 1) / kStoreLine * kStoreLine + kStoreLine;
    const std::lock_guard lock(mutex_);
    if (!is_asked_for_) ask_for_addresses();
    for (StorePlace** link = &first_free_; *link != nullptr; link = &(*link)->next_free)
      if ((*link)->bytes >= wanted) return block_of(take_from(link, wanted));
    if (static_cast<std::size_t>(end_.load(std::memory_order_relaxed) - top_) < wanted) return nullptr;
    StorePlace* const place = ::new (top_) StorePlace{wanted, nullptr};
    top_ += wanted;
    touched_ = std::max(touched_, top_);
    return block_of(place);
  }

  bool holds(const void* address) const noexcept {
    return address >= begin_.load(std::memory_order_relaxed) &&
           address < end_.load(std::memory_order_relaxed);
  }

  void give(void* block) noexcept {
    auto* const place = reinterpret_cast<StorePlace*>(static_cast<char*>(block) - kStoreLine);
    const std::lock_guard lock(mutex_);
    StorePlace** link = &first_free_;  // to what is joined in the end
    StorePlace** next = link;
    while (*next != nullptr && *next < place) {
      link = next;
      next = &(*next)->next_free;
    }
    place->next_free = *next;
    *next = place;
    join_next(place);
    if (!join_next(*link)) link = next;
    StorePlace* const joined = *link;
    if (end_of(joined) == top_) {
      top_ = reinterpret_cast<char*>(joined);
      *link = nullptr;
      if (static_cast<std::size_t>(touched_ - top_) <= kMostKept) return;
      discard(top_, touched_);
      touched_ = top_;
    } else if (joined->bytes > kMostKept) {
      discard(reinterpret_cast<char*>(joined) + sizeof(StorePlace), end_of(joined));
    }
  }

  void give_back() noexcept {
    const std::lock_guard lock(mutex_);
    for (StorePlace* place = first_free_; place != nullptr; place = place->next_free)
      discard(reinterpret_cast<char*>(place) + sizeof(StorePlace), end_of(place));
    discard(top_, touched_);
    touched_ = top_;
  }

  void leave_shared() noexcept {
    const std::lock_guard lock(mutex_);
    if (top_ == nullptr) return;
    top_ = touched_ = std::min(next_multiple(touched_, kStorePage), end_.load(std::memory_order_relaxed));
    first_free_ = nullptr;
  }

 private:
  static char* end_of(StorePlace* place) { return reinterpret_cast<char*>(place) + place->bytes; }
  static void* block_of(StorePlace* place) { return reinterpret_cast<char*>(place) + kStoreLine; }

  void ask_for_addresses() noexcept {
    is_asked_for_ = true;
    const std::size_t bytes = std::min(kMostAddresses, address_space() / 16);
    if (bytes < 2 * kStorePage) return;
    void* const mapped =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) return;
    char* const begin = next_multiple(static_cast<char*>(mapped), kStorePage);
    char* const end = static_cast<char*>(mapped) + bytes;
    madvise(begin, static_cast<std::size_t>(end - begin), MADV_HUGEPAGE);  // failure costs speed only
    top_ = touched_ = begin;
    begin_.store(begin, std::memory_order_relaxed);
    end_.store(end, std::memory_order_relaxed);
  }

  static StorePlace* take_from(StorePlace** link, std::size_t wanted) {
    StorePlace* const place = *link;
    if (place->bytes - wanted >= kSmallestPlace) {
      *link =
          ::new (reinterpret_cast<char*>(place) + wanted) StorePlace{place->bytes - wanted, place->next_free};
      place->bytes = wanted;
    } else {
      *link = place->next_free;
    }
    return place;
  }

  // With the free place behind, if that is next to it.
  static bool join_next(StorePlace* place) {
    StorePlace* const next = place->next_free;
    if (next == nullptr || end_of(place) != reinterpret_cast<char*>(next)) return false;
    place->bytes += next->bytes;
    place->next_free = next->next_free;
    return true;
  }

  // The whole huge pages of it.
  static void discard(char* from, char* to) {
    char* const first = next_multiple(from, kStorePage);
    if (first >= to) return;
    madvise(first, static_cast<std::size_t>(to - first) / kStorePage * kStorePage, MADV_DONTNEED);
  }

  std::mutex mutex_;
  bool is_asked_for_ = false;
  std::atomic<char*> begin_ = nullptr, end_ = nullptr;  // of the addresses; set once
  char* top_ = nullptr;                                 // no block is from here on
  char* touched_ = nullptr;           // and none has been from here on, unless it was discarded
  StorePlace* first_free_ = nullptr;  // the others follow it by address; none ends at the top
};

constinit BlockStore store;

}  // namespace

std::size_t address_space() {
  std::size_t least = SIZE_MAX;
  for (const auto kind : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit limit{};
    if (getrlimit(kind, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min<std::size_t>(least, limit.rlim_cur);
  }
  return least;
}

void* take_block(std::size_t bytes) noexcept {
  return bytes < kSmallestBlock || bytes > kLargestBlock ? nullptr : store.take(bytes);
}

void give_back_free_pages() noexcept { store.give_back(); }

void leave_shared_blocks() noexcept { store.leave_shared(); }

bool is_in_store(const void* address) noexcept { return store.holds(address); }

bool give_block(void* address) noexcept {
  const bool is_own = store.holds(address);
  if (is_own) store.give(address);
  return is_own;
}

}  // namespace ndhull
