#include "tools/io/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace ndhull {
namespace {

[[noreturn]] void fail_to_read(const std::string& name, int error_number) {
  if (error_number == ENOENT) {
    throw Error(ErrorCode::kFileMissing,
                fmt::format("{}: found no such file, expected a readable file; check the path", name));
  }
  if (error_number == EISDIR) {
    throw Error(ErrorCode::kFileMissing,
                fmt::format("{}: found a directory, expected a file; name a file inside it", name));
  }
  throw Error(ErrorCode::kFileMissing,
              fmt::format("{}: found \"{}\", expected a readable file; check its permissions", name,
                          std::strerror(error_number)));
}

/// Closes the descriptor when the scope ends, whichever way.
struct DescriptorGuard {
  int descriptor;
  ~DescriptorGuard() { ::close(descriptor); }
};

}  // namespace

FileBytes::~FileBytes() {
  if (mapping_ != nullptr) ::munmap(mapping_, size_);
}

void FileBytes::swap(FileBytes& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(mapping_, other.mapping_);
  std::swap(watched_, other.watched_);
  std::swap(buffer_, other.buffer_);
}

FileBytes FileBytes::read(const std::string& path) {
  if (path == "-") return read_descriptor(STDIN_FILENO, display_name(path));
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail_to_read(path, errno);
  const DescriptorGuard guard{descriptor};
  return read_descriptor(descriptor, path);
}

FileBytes FileBytes::read_descriptor(int descriptor, const std::string& name) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_to_read(name, errno);
  if (S_ISDIR(status.st_mode)) fail_to_read(name, EISDIR);

  FileBytes bytes;
  // A redirected file may have been read in part by somebody else: only a fresh one is mapped.
  const bool at_start = S_ISREG(status.st_mode) && ::lseek(descriptor, 0, SEEK_CUR) == 0;
  if (at_start && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* mapping = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (mapping != MAP_FAILED) {
      ::madvise(mapping, size, MADV_SEQUENTIAL);
      bytes.mapping_ = mapping;
      bytes.watched_ = WatchedMapping(mapping, size, name);
      bytes.data_ = static_cast<const char*>(mapping);
      bytes.size_ = size;
      return bytes;
    }
  }

  // Pipes, and file systems that cannot map. 1 MiB at first: most piped inputs need no second round.
  std::vector<char> buffer(std::size_t{1} << 20);
  std::size_t used = 0;
  for (;;) {
    if (used == buffer.size()) buffer.resize(buffer.size() * 2);
    const ssize_t got = ::read(descriptor, buffer.data() + used, buffer.size() - used);
    if (got == 0) break;
    if (got > 0) {
      used += static_cast<std::size_t>(got);
    } else if (errno != EINTR) {
      fail_to_read(name, errno);
    }
  }
  bytes.buffer_ = std::move(buffer);
  bytes.data_ = bytes.buffer_.data();
  bytes.size_ = used;
  return bytes;
}

void FileBytes::give_back(std::size_t count) const {
  constexpr std::size_t kLargestPage = std::size_t{1} << 16;  // of all machines in use
  if (mapping_ != nullptr) ::madvise(mapping_, count / kLargestPage * kLargestPage, MADV_DONTNEED);
}

FileBytes FileBytes::copy_of(std::string_view content) {
  FileBytes bytes;
  bytes.buffer_.assign(content.begin(), content.end());
  bytes.data_ = bytes.buffer_.data();
  bytes.size_ = content.size();
  return bytes;
}

FileBytes FileBytes::of_size(std::size_t size) {
  FileBytes bytes;
  bytes.buffer_.resize(size);
  bytes.data_ = bytes.buffer_.data();
  bytes.size_ = size;
  return bytes;
}

std::string display_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string extension_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
  std::string extension = path.substr(dot + 1);
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

char table_separator(const std::string& extension) {
  if (extension == "csv") return ',';
  return extension == "tsv" ? '\t' : '\0';
}

}  // namespace ndhull
