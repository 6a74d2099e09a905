// What memory is free, read from files as the system writes them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tools/command_line/machine_memory.h"

namespace ndhull {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMegabyte = 1 << 20;

/// A folder with /proc and /sys in it.
class MachineMemory : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::path(testing::TempDir()) / (std::string("ndhull_machine_") + test.name());
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  void write_machine() const {
    write("proc/meminfo", "MemTotal:       16384 kB\nMemFree:         1024 kB\nMemAvailable:    8192 kB\n");
  }
  std::uint64_t available() const { return available_memory_bytes(root_); }

  fs::path root_;
};

TEST_F(MachineMemory, IsNotKnownWithoutFiles) { EXPECT_EQ(available(), 0U); }

TEST_F(MachineMemory, IsWhatTheMachineHas) {
  write_machine();
  EXPECT_EQ(available(), 8 * kMegabyte);
}

TEST_F(MachineMemory, IsWhatTheNarrowestGroupLeaves) {
  write_machine();
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  write("sys/fs/cgroup/outer/inner/memory.current", "1048576\n");
  EXPECT_EQ(available(), 8 * kMegabyte);
  write("sys/fs/cgroup/outer/memory.max", "6291456\n");
  write("sys/fs/cgroup/outer/memory.current", "3145728\n");
  EXPECT_EQ(available(), 3 * kMegabyte);
  write("sys/fs/cgroup/outer/memory.stat",
        "anon 1\ninactive_file 1048576\nactive_file 524288\nfile 99999999\n");
  EXPECT_EQ(available(), 4 * kMegabyte + kMegabyte / 2);
}

TEST_F(MachineMemory, InAContainerTheTopFolderIsTheGroup) {
  write_machine();
  write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/docker/0123\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "2097152\n");
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "1572864\n");
  write("sys/fs/cgroup/memory/memory.stat", "total_inactive_file 262144\ntotal_active_file 0\n");
  EXPECT_EQ(available(), 3 * kMegabyte / 4);
  write("sys/fs/cgroup/memory/memory.usage_in_bytes", "9999999\n");  // used up, but for what can be dropped
  EXPECT_EQ(available(), 1U);
}

}  // namespace
}  // namespace ndhull
