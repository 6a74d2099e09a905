#include "tools/command_line/machine_memory.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>

namespace ndhull {
namespace {

namespace fs = std::filesystem;

/// Of what is available: the rest is for other programs, and for what accounting does not see.
constexpr double kShareOfMachine = 0.8;

/// A file with one number; nothing for "max", or without such a file.
std::optional<std::uint64_t> number_in(const fs::path& path) {
  std::ifstream file(path);
  std::uint64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

/// The numbers behind these names, added up; 0 without such a file.
std::uint64_t sum_of(const fs::path& path, std::string_view first, std::string_view second) {
  std::ifstream file(path);
  std::uint64_t sum = 0;
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t end = line.find_first_of(": ");
    const std::string_view name = std::string_view(line).substr(0, end);
    if (end == std::string::npos || (name != first && name != second)) continue;
    sum += std::strtoull(line.c_str() + end + 1, nullptr, 10);
  }
  return sum;
}

struct GroupFiles {
  const char *most, *used, *cached, *also_cached;
};
constexpr GroupFiles kUnified{"memory.max", "memory.current", "inactive_file", "active_file"};
constexpr GroupFiles kFirstVersion{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file",
                                   "total_active_file"};

/// What the group and those around it leave. In a container the group's path may be that of the host: its
/// files are in the top folder then, which is looked at in any case.
std::uint64_t left_in_groups(const fs::path& top, const fs::path& group, const GroupFiles& files) {
  std::uint64_t left = UINT64_MAX;
  for (fs::path inner = group.relative_path();; inner = inner.parent_path()) {
    const fs::path folder = top / inner;
    const auto most = number_in(folder / files.most), used = number_in(folder / files.used);
    if (most && used) {
      const std::uint64_t cached = sum_of(folder / "memory.stat", files.cached, files.also_cached);
      const std::uint64_t held = *used > cached ? *used - cached : 0;
      left = std::min(left, *most > held ? *most - held : 1);
    }
    if (inner.empty()) return left;
  }
}

}  // namespace

std::uint64_t available_memory_bytes(const fs::path& root) {
  std::uint64_t available = UINT64_MAX;
  if (const std::uint64_t kilobytes = sum_of(root / "proc/meminfo", "MemAvailable", ""); kilobytes > 0)
    available = 1024 * kilobytes;
  std::ifstream groups(root / "proc/self/cgroup");  // lines number:controllers:path
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1),
                      path = line.substr(second + 1);
    if (controllers.empty())
      available = std::min(available, left_in_groups(root / "sys/fs/cgroup", path, kUnified));
    if ((',' + controllers + ',').find(",memory,") != std::string::npos)
      available = std::min(available, left_in_groups(root / "sys/fs/cgroup/memory", path, kFirstVersion));
  }
  return available == UINT64_MAX ? 0 : available;
}

std::uint64_t memory_of_machine() {
  const std::uint64_t available = available_memory_bytes();
  if (available == 0) return 0;
  return std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(kShareOfMachine * static_cast<double>(available)));
}

}  // namespace ndhull
