// The bytes of an input: a file mapped read-only, or a pipe read to its end.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/io/sudden_end.h"

namespace ndhull {

/// Owns the bytes of one input. They do not move when the object does, so views into them stay valid.
/// The first byte is aligned to 16 at least.
class FileBytes {
 public:
  FileBytes() = default;
  FileBytes(FileBytes&& other) noexcept { swap(other); }
  FileBytes& operator=(FileBytes&& other) noexcept {
    swap(other);
    return *this;
  }
  ~FileBytes();

  /// Opens `path`; "-" is standard input. Regular files are mapped, not copied.
  /// Throws Error kFileMissing: not there, a directory, or not readable.
  static FileBytes read(const std::string& path);
  /// The same for an open descriptor, which stays open; `name` is for messages.
  static FileBytes read_descriptor(int descriptor, const std::string& name);
  /// Bytes that are in memory already.
  static FileBytes copy_of(std::string_view content);

  /// Zeros, to be written to.
  static FileBytes of_size(std::size_t size);

  std::string_view view() const { return {data_, size_}; }
  /// Of bytes that are in memory; null for a mapping.
  char* writable() { return is_mapping() ? nullptr : buffer_.data(); }
  /// A file, mapped: not a pipe, nor a copy.
  bool is_mapping() const { return mapping_ != nullptr; }
  /// The first `count` bytes were read and are not needed for now: those of a mapped file leave the memory,
  /// and come again when they are.
  void give_back(std::size_t count) const;

 private:
  void swap(FileBytes& other) noexcept;

  const char* data_ = nullptr;
  std::size_t size_ = 0;
  void* mapping_ = nullptr;   // of size_ bytes, or null when buffer_ holds the bytes
  WatchedMapping watched_;    // the mapping's
  std::vector<char> buffer_;  // heap memory: aligned as operator new does
};

/// The name messages use: the path, or "standard input" for "-".
std::string display_name(const std::string& path);

/// The extension of `path` in lower case, without the dot: "npy" for "a/b.NPY", "" when there is none.
std::string extension_of(const std::string& path);

/// What stands between the fields of a table whose name ends so: csv, tsv; '\0' for any other extension.
char table_separator(const std::string& extension);

}  // namespace ndhull
