#include "tools/io/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "core/error.h"

namespace ndhull {
namespace {

/// The file a path stands for when links are followed; the path itself when there is no such file yet.
std::string resolve(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr), &std::free);
  return real == nullptr ? path : std::string(real.get());
}

// Names that are taken are the remains of runs that were killed: a few attempts find a free one.
constexpr int kNameAttempts = 100;

}  // namespace

OutputFile::OutputFile(int descriptor, const std::string& name) : name_(name), descriptor_(descriptor) {}

OutputFile::OutputFile(const std::string& path) : name_(path == "-" ? "standard output" : path) {
  if (path == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  owns_descriptor_ = true;
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  // A target that may not be written must not be replaced either, though the folder would allow it.
  if (exists && ::access(path.c_str(), W_OK) != 0) fail(errno);
  target_ = resolve(path);
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = fmt::format("{}.{}-{}.part", target_, ::getpid(), attempt);
    doomed_ = DoomedFile(temporary_);  // before it is there: a signal may come at any time
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && (errno != EEXIST || attempt == kNameAttempts)) {
      const int error_number = errno;
      temporary_.clear();
      fail(error_number);
    }
  }
  // Best effort: some file systems have no permissions.
  if (exists && ::fchmod(descriptor_, status.st_mode & 07777) != 0) errno = 0;
}

OutputFile::~OutputFile() {
  if (owns_descriptor_ && descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::fail(int error_number) const {
  throw Error(ErrorCode::kFileWrite,
              fmt::format("{}: found \"{}\", expected a file that can be written; choose another "
                          "folder or make room",
                          name_, std::strerror(error_number)));
}

void OutputFile::write(std::string_view text) {
  buffer_.append(text.data(), text.data() + text.size());
  if (buffer_.size() >= kFlushSize) flush();
}

void OutputFile::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      fail(errno);
    }
  }
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  if (!owns_descriptor_) return;
  // Network file systems report a full disk at close.
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
  doomed_ = DoomedFile();
}

void write_text(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace ndhull
