// Memory for tables that come and go, kept from one to the next.
#pragma once

#include <cstddef>

namespace ndhull {

/// [bytes] of address space that the system lets this process have (`ulimit -v`, some batch systems).
std::size_t address_space();

/// Blocks of this many bytes are worth a place in the store; smaller ones are the allocator's.
inline constexpr std::size_t kSmallestBlock = std::size_t{1} << 16;
/// Larger ones go back to the system as soon as they are not needed.
inline constexpr std::size_t kLargestBlock = std::size_t{1} << 25;

/// Takes a block of at least `bytes` bytes, at a multiple of 64, from the store of the process: one range of
/// addresses in huge pages, the lowest free place first, so that memory that has been touched is touched
/// again. What is in it is anything. Free places of more than 64 MB are given back to the system. Any
/// thread may call. Cost: the free places, some dozens at most. Returns null for sizes outside
/// [kSmallestBlock, kLargestBlock], and where the system refuses the addresses.
void* take_block(std::size_t bytes) noexcept;

/// Is the address one of the store's?
bool is_in_store(const void* address) noexcept;

/// Gives all whole pages of free places back to the system: before work that memory is counted for begins anew.
void give_back_free_pages() noexcept;

/// For a process that was copied (fork): leaves behind what was free, and begins in pages that have not been
/// used. Pages that it shares with the first process would be copied when it writes to them, small ones at a
/// time. Blocks that it has stay.
void leave_shared_blocks() noexcept;

/// Gives a block back. Returns false, and does nothing, when `address` is not of the store.
bool give_block(void* address) noexcept;

}  // namespace ndhull
