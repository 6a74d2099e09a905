// Files that are written: whole or not at all, and read back as they were.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/io/io_test_support.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/index_writer.h"
#include "tools/io/output_file.h"
#include "tools/io/plane_writer.h"

namespace ndhull {
namespace {

TEST(OutputFileExample, TheTargetAppearsAtCommit) {
  const Scratch scratch;
  const std::string path = scratch.path("result.txt");
  {
    OutputFile file(path);
    file.print("{} ", 42);
    file.write("points\n");
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(scratch.read("result.txt"), "42 points\n");
  EXPECT_EQ(scratch.file_count(), 1U);
}

TEST(OutputFileExample, WithoutCommitTheOldFileStaysAndNothingIsLeftBehind) {
  const Scratch scratch;
  const std::string path = scratch.write("result.txt", "old");
  {
    OutputFile file(path);
    file.write(std::string(1 << 20, 'x'));
  }
  EXPECT_EQ(scratch.read("result.txt"), "old");
  EXPECT_EQ(scratch.file_count(), 1U);
}

TEST(OutputFileExample, AnExistingFileKeepsItsPermissionsAndALinkStaysALink) {
  const Scratch scratch;
  const std::string path = scratch.write("result.txt", "old");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  std::filesystem::create_symlink(path, scratch.path("link"));
  OutputFile file(scratch.path("link"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(scratch.path("link")));
  EXPECT_EQ(scratch.read("result.txt"), "new");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640U);
}

TEST(OutputFileRefusedExample, FoldersThatCannotBeWritten) {
  const Scratch scratch;
  expect_error(ErrorCode::kFileWrite, "No such file",
               [&] { OutputFile file(scratch.path("no/result.txt")); });
  expect_error(ErrorCode::kFileWrite, "directory", [&] { OutputFile file(scratch.path("")); });
  scratch.write("plain", "");
  expect_error(ErrorCode::kFileWrite, "Not a directory",
               [&] { OutputFile file(scratch.path("plain/result.txt")); });
  if (::geteuid() != 0) {  // root may write anywhere
    std::filesystem::create_directory(scratch.path("closed"));
    std::filesystem::permissions(scratch.path("closed"), std::filesystem::perms::owner_read);
    expect_error(ErrorCode::kFileWrite, "denied",
                 [&] { OutputFile file(scratch.path("closed/result.txt")); });
    std::filesystem::permissions(scratch.path("closed"), std::filesystem::perms::owner_all);
  }
}

TEST(OutputFileRefusedExample, AFullDiskIsReported) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  expect_error(ErrorCode::kFileWrite, "No space left", [] {
    OutputFile file("/dev/full");
    file.write("x");
    file.commit();
  });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "a device is never replaced";
}

TEST(OutputFileExample, ADescriptorGetsAllBytesAtCommit) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  OutputFile file(ends[1], "pipe");
  file.print("{}\n", 7);
  file.commit();
  ::close(ends[1]);
  EXPECT_EQ(FileBytes::read_descriptor(ends[0], "pipe").view(), "7\n");
  ::close(ends[0]);
}

/// Numbers that lose something unless 17 digits are written.
std::vector<double> awkward_planes() {
  return {0.1,  -1.0 / 3.0, std::nextafter(1.0, 2.0),           -0.1 - 0.2, 1e-300, 5e-324,
          -1.0, 0.0,        std::numeric_limits<double>::max(), M_PI,       -1e22,  123456789.12345678};
}

void write_all(const std::string& path, const std::vector<double>& rows, std::size_t dimension) {
  write_planes(path, rows.size() / (dimension + 1), dimension, [&](std::size_t index, double* row) {
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(index * (dimension + 1)), dimension + 1, row);
  });
}

TEST(PlaneWriterLaw, WhatIsWrittenIsReadBackIdentically) {
  const Scratch scratch;
  const std::vector<double> rows = awkward_planes();
  for (const std::size_t dimension : {1U, 2U, 3U, 5U}) {
    for (const char* name :
         {"planes.ine", "planes.npy", "planes.csv", "planes.tsv", "planes.txt", "planes"}) {
      SCOPED_TRACE(name);
      write_all(scratch.path(name), rows, dimension);
      const HalfspaceFile file = read_halfspaces(scratch.path(name));
      EXPECT_EQ(file.dimension, dimension);
      EXPECT_EQ(file.rows, rows);
    }
  }
}

TEST(PlaneWriterLaw, NoPlanesAreReadBackInTheirDimension) {
  const Scratch scratch;
  for (const char* name : {"planes.ine", "planes.npy", "planes.csv", "planes.tsv", "planes.txt"}) {
    SCOPED_TRACE(name);
    write_all(scratch.path(name), {}, 3);
    const HalfspaceFile file = read_halfspaces(scratch.path(name));
    EXPECT_EQ(file.dimension, 3U);
    EXPECT_EQ(file.count, 0U);
    EXPECT_TRUE(file.rows.empty());
  }
}

TEST(PlaneWriterExample, TheFormatsAreThoseOtherProgramsRead) {
  const Scratch scratch;
  const std::vector<double> rows{1, 0, -0.5, 0, -1, -0.25};
  write_all(scratch.path("a.ine"), rows, 2);
  EXPECT_EQ(scratch.read("a.ine"), "H-representation\nbegin\n2 3 real\n0.5 -1 0\n0.25 0 1\nend\n");
  write_all(scratch.path("a.txt"), rows, 2);
  EXPECT_EQ(scratch.read("a.txt"), "3\n2\n     1      0   -0.5 \n     0     -1  -0.25 \n");
  write_all(scratch.path("a.npy"), rows, 2);
  EXPECT_EQ(scratch.read("a.npy"), npy_bytes<double>("<f8", {2, 3}, rows));
}

TEST(PlaneWriterExample, NothingIsLeftWhenThePlanesFail) {
  const Scratch scratch;
  EXPECT_THROW(
      write_planes(scratch.path("a.npy"), 3, 2, [](std::size_t, double*) { throw std::runtime_error("x"); }),
      std::runtime_error);
  EXPECT_EQ(scratch.file_count(), 0U);
}

TEST(IndexWriterExample, TextIsTheCountAndOneIndexALine) {
  const Scratch scratch;
  const std::vector<PointId> ids{PointId{7}, PointId{0}, PointId{12}};
  write_indices(scratch.path("a.txt"), ids);
  EXPECT_EQ(scratch.read("a.txt"), "3\n7\n0\n12\n");
}

TEST(IndexWriterExample, ATableHasNoCount) {
  const Scratch scratch;
  const std::vector<PointId> ids{PointId{7}, PointId{0}, PointId{12}};
  write_indices(scratch.path("a.csv"), ids);
  EXPECT_EQ(scratch.read("a.csv"), "7\n0\n12\n");
}

TEST(IndexWriterExample, NpyIsOneAxisOfInt64) {
  const Scratch scratch;
  const std::vector<PointId> ids{PointId{7}, PointId{0}, PointId{12}};
  write_indices(scratch.path("a.npy"), ids);
  EXPECT_EQ(scratch.read("a.npy"), npy_bytes<std::int64_t>("<i8", {3}, {7, 0, 12}));
  EXPECT_EQ(make_npy_header("<i8", {3}).size() % 64, 0U);
}

}  // namespace
}  // namespace ndhull
