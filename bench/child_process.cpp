// The child sends its result as CBOR through a pipe. End of file on the pipe is its end; the pipe is polled
// against the time limit, so that neither a hanging child nor a long answer blocks us.
#include "bench/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/machine/block_store.h"

namespace ndhull {
namespace {

double clock_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

void send_all(int descriptor, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = write(descriptor, bytes.data() + sent, bytes.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(1);
    sent += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void run_child(const std::function<nlohmann::json()>& work, int descriptor) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a measurement nobody waits for would disturb the next one
#endif
  nlohmann::json answer;
  try {
    answer["values"] = work();
  } catch (const std::exception& error) {
    answer["error"] = error.what();
  }
  send_all(descriptor, nlohmann::json::to_cbor(answer));
  _exit(0);
}

// Reads to the end of file; false when `max_seconds` passed before.
bool receive_all(int descriptor, double max_seconds, std::vector<std::uint8_t>& bytes) {
  const Stopwatch watch;
  std::array<std::uint8_t, 4096> block;
  while (true) {
    int wait_ms = -1;
    if (max_seconds > 0.0) {
      const double left = max_seconds - watch.wall_seconds();
      if (left <= 0.0) return false;
      wait_ms = static_cast<int>(std::min(std::ceil(left * 1000.0), 1e6));
    }
    pollfd waited{descriptor, POLLIN, 0};
    const int ready = poll(&waited, 1, wait_ms);
    if (ready < 0 && errno != EINTR) fail("poll");
    if (ready <= 0) continue;
    const ssize_t count = read(descriptor, block.data(), block.size());
    if (count < 0 && errno != EINTR) fail("read");
    if (count == 0) return true;
    if (count > 0) bytes.insert(bytes.end(), block.begin(), block.begin() + count);
  }
}

std::uint64_t peak_bytes_of(const rusage& usage) {
#ifdef __APPLE__
  return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
  return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);  // in KiB
#endif
}

void interpret(int status, const std::vector<std::uint8_t>& bytes, ChildResult& result) {
  if (WIFSIGNALED(status)) {
    result.end = ChildResult::End::kCrashed;
    result.reason = fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
    return;
  }
  const nlohmann::json answer = nlohmann::json::from_cbor(bytes, true, false);
  if (answer.is_discarded() || (!answer.contains("values") && !answer.contains("error"))) {
    result.reason = fmt::format("ended with exit code {} and no result", WEXITSTATUS(status));
  } else if (answer.contains("error")) {
    result.reason = answer["error"].get<std::string>();
  } else {
    result.end = ChildResult::End::kDone;
    result.values = answer["values"];
  }
}

/// A child at work, and the end of the pipe that it answers through.
struct StartedChild {
  pid_t process = -1;
  int answer = -1;
};

StartedChild start_child(const std::function<nlohmann::json()>& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) fail("pipe");
  std::fflush(nullptr);  // or the child would print what is in the buffers once more
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    close(ends[0]);
    leave_shared_blocks();  // a program of its own would have no others
    run_child(work, ends[1]);
  }
  close(ends[1]);
  return {child, ends[0]};
}

ChildResult await(const StartedChild& child, double max_seconds) {
  std::vector<std::uint8_t> bytes;
  const bool in_time = receive_all(child.answer, max_seconds, bytes);
  close(child.answer);
  if (!in_time) kill(child.process, SIGKILL);
  int status = 0;
  rusage usage{};
  while (wait4(child.process, &status, 0, &usage) < 0) {
    if (errno != EINTR) fail("wait4");
  }

  ChildResult result;
  result.peak_bytes = peak_bytes_of(usage);
  if (in_time) {
    interpret(status, bytes, result);
  } else {
    result.end = ChildResult::End::kTimeLimit;
    result.reason = fmt::format("stopped after {} s", max_seconds);
  }
  return result;
}

}  // namespace

ChildResult run_in_child(const std::function<nlohmann::json()>& work, double max_seconds) {
  return await(start_child(work), max_seconds);
}

std::vector<ChildResult> run_in_children(const std::function<nlohmann::json()>& work, std::size_t count,
                                         double max_seconds) {
  std::vector<StartedChild> children;
  for (std::size_t child = 0; child < count; ++child) children.push_back(start_child(work));
  std::vector<ChildResult> results;
  for (const StartedChild& child : children) results.push_back(await(child, max_seconds));
  return results;
}

ProgramRun run_program(const std::vector<std::string>& words, const std::string& input_path,
                       const std::string& output_path) {
  constexpr int kNotStarted = 127;
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int input = open(input_path.c_str(), O_RDONLY | O_CLOEXEC);
  const int output = open(output_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (input < 0 || output < 0) fail("open");
  const Stopwatch watch;
  const pid_t child = fork();
  if (child < 0) fail("fork");
  if (child == 0) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    if (dup2(input, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0)
      execvp(arguments.front(), arguments.data());
    _exit(kNotStarted);
  }
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) < 0) {
    if (errno != EINTR) fail("wait4");
  }
  const double wall_seconds = watch.wall_seconds();
  close(input);
  close(output);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted)
    throw std::runtime_error(words.front() + " cannot be started: is it installed?");
  if (WIFSIGNALED(status))
    throw std::runtime_error(fmt::format("{} was ended by signal {}", words.front(), WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0)
    throw std::runtime_error(fmt::format("{} ended with exit code {}", words.front(), WEXITSTATUS(status)));
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {wall_seconds, seconds(usage.ru_utime) + seconds(usage.ru_stime), peak_bytes_of(usage)};
}

void limit_address_space(std::uint64_t bytes) {
  if (bytes == 0) return;
  const rlimit limit{bytes, bytes};
  if (setrlimit(RLIMIT_AS, &limit) != 0) fail("setrlimit");
}

std::uint64_t resident_bytes() {
  unsigned long long total_pages = 0, resident_pages = 0;
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  const bool read = std::fscanf(file, "%llu %llu", &total_pages, &resident_pages) == 2;
  std::fclose(file);
  return read ? resident_pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? peak_bytes_of(usage) : 0;
}

Stopwatch::Stopwatch()
    : wall_start_(clock_seconds(CLOCK_MONOTONIC)), cpu_start_(clock_seconds(CLOCK_PROCESS_CPUTIME_ID)) {}
double Stopwatch::wall_seconds() const { return clock_seconds(CLOCK_MONOTONIC) - wall_start_; }
double Stopwatch::cpu_seconds() const { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_; }

}  // namespace ndhull
