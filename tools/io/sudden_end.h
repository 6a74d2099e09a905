// Ends that leave no time to unwind: a mapped file that becomes shorter while it is read, the second Ctrl-C,
// a scheduler's SIGTERM. What was begun to be written is removed all the same.
#pragma once

#include <cstddef>
#include <string>

namespace ndhull {

/// A file being written that must not stay when the process ends suddenly. Of more than 16 at a time the rest
/// stay.
class DoomedFile {
 public:
  DoomedFile() = default;
  explicit DoomedFile(const std::string& path);
  DoomedFile(DoomedFile&& other) noexcept : slot_(other.slot_) { other.slot_ = nullptr; }
  DoomedFile& operator=(DoomedFile&& other) noexcept;
  /// The file is complete, or gone.
  ~DoomedFile();

 private:
  void* slot_ = nullptr;
};

/// A mapping of a file. Reading behind the end of a file that was cut after it was mapped raises SIGBUS,
/// which while this lives ends the process with one line about the file and exit code 1. Of more than 16 at a
/// time the rest are not watched.
class WatchedMapping {
 public:
  WatchedMapping() = default;
  WatchedMapping(const void* data, std::size_t size, const std::string& name);
  WatchedMapping(WatchedMapping&& other) noexcept : slot_(other.slot_) { other.slot_ = nullptr; }
  WatchedMapping& operator=(WatchedMapping&& other) noexcept;
  ~WatchedMapping();

 private:
  void* slot_ = nullptr;
};

/// Removes the doomed files and ends the process. May be called from a signal handler.
[[noreturn]] void end_suddenly(int exit_code);

}  // namespace ndhull
