// A growing array that never copies: address space is reserved once, pages come when they are touched.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace ndhull {

/// Fewer bytes are the allocator's.
inline constexpr std::size_t kLeastPagesBytes = std::size_t{1} << 16;

/// Reserves `bytes` of address space (no memory is used yet) and asks for huge pages. It reads as zero.
/// `at_once`: so many bytes will soon be written; where they are few the first part is in small pages.
/// Throws std::bad_alloc when the address space is refused.
void* reserve_pages(std::size_t bytes, std::size_t at_once);
/// The same for what will all be written at once: from the store of blocks, if it takes so many bytes. What
/// is in it may be anything.
void* take_pages(std::size_t bytes);
/// Gives back what either of them returned.
void release_pages(void* address, std::size_t bytes);
/// Gives the memory of whole pages in [from, to) back to the system; the addresses stay reserved.
void discard_pages(void* from, void* to);
/// The same for a table's rows from there on, unless they are the store's. A huge page is only divided where
/// the table keeps less than a quarter of it: the system brings that part again, 4 kB at a time.
void discard_tail(void* from, void* to);

/// Array of plain records that can grow in place up to the capacity given at the start. Growing costs
/// nothing but the pages that are touched: references stay valid, peak memory is the final size.
/// New elements are zero, unless it was made to be written at once.
template <class T>
class HugeArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  HugeArray() = default;
  /// `at_once`: so many elements will soon be written.
  explicit HugeArray(std::size_t capacity, std::size_t at_once = 0)
      : data_(static_cast<T*>(reserve_pages(bytes_for(capacity), at_once * sizeof(T)))),
        capacity_(capacity) {}
  /// An array that will not grow, whose elements may be anything until they are written: its memory is the
  /// one that the table before it had (core/machine/block_store.h).
  static HugeArray to_write(std::size_t size) {
    HugeArray array;
    array.data_ = static_cast<T*>(take_pages(bytes_for(size)));
    array.capacity_ = size;
    return array;
  }
  HugeArray(HugeArray&& other) noexcept { swap(other); }
  HugeArray& operator=(HugeArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~HugeArray() {
    if (data_ != nullptr) release_pages(data_, bytes_for(capacity_));
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t index) { return data_[index]; }
  const T& operator[](std::size_t index) const { return data_[index]; }
  std::size_t capacity() const { return capacity_; }

  /// Returns the memory behind elements [count, capacity) to the system, but for a part of a huge page.
  void discard_from(std::size_t count) {
    if (data_ != nullptr && bytes_for(capacity_) >= kLeastPagesBytes)
      discard_tail(data_ + count, data_ + capacity_);
  }

 private:
  // 64 spare bytes: vector loads may read, never use, what lies behind the last element.
  static std::size_t bytes_for(std::size_t capacity) { return capacity * sizeof(T) + 64; }
  void swap(HugeArray& other) {
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }

  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace ndhull
