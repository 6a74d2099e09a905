// Results that are complete or not there: written beside the target, renamed at the end.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "tools/io/sudden_end.h"

namespace ndhull {

/// A file being written. Without `commit` the target stays as it was and nothing is left behind.
///
/// Target    "-" is standard output: bytes go there as the buffer fills, and `commit` sends the rest. A
///           target that exists and is no regular file (a device, a pipe) is written directly. A link stays
///           a link, and an existing file keeps its permissions.
/// Throws    Error kFileWrite, with the system's reason, from the constructor, `write` and `commit`.
/// Not promised  that the file survives a power failure: there is no fsync.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  /// On an open descriptor, which stays open; `name` is for messages.
  OutputFile(int descriptor, const std::string& name);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  void write(std::string_view text);
  /// Formats to the end of the file.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(fmt::appender(buffer_), format, std::forward<Args>(args)...);
    if (buffer_.size() >= kFlushSize) flush();
  }
  /// Makes what was written the target. Nothing may be written afterwards.
  void commit();

 private:
  // [bytes] Larger blocks no longer make writing faster.
  static constexpr std::size_t kFlushSize = std::size_t{1} << 18;

  void flush();
  [[noreturn]] void fail(int error_number) const;

  std::string name_;       // for messages
  std::string target_;     // empty when nothing is renamed
  std::string temporary_;  // empty when there is none
  DoomedFile doomed_;      // the temporary one
  int descriptor_ = -1;
  bool owns_descriptor_ = false;
  fmt::memory_buffer buffer_;
};

/// One file, written and committed.
void write_text(const std::string& path, std::string_view text);

}  // namespace ndhull
