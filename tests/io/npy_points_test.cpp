// Points and halfspaces as NumPy arrays.
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/io/io_test_support.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/output_file.h"

namespace ndhull {
namespace {

using Values = std::vector<double>;
const std::vector<std::size_t> kShape{2, 3};
const Values kRows{1, 2, 3, 4, 5, 6};

TEST(NpyExample, Float64AndFloat32AreViewsOfTheFile) {
  const Scratch scratch;
  const PointFile doubles = read_points(scratch.write("a.npy", npy_bytes<double>("<f8", kShape, kRows)));
  EXPECT_EQ(doubles.view().type, ScalarType::kFloat64);
  EXPECT_EQ(rows_of(doubles.view()), kRows);

  const PointFile floats =
      read_points(scratch.write("b.npy", npy_bytes<float>("<f4", kShape, {1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(floats.view().type, ScalarType::kFloat32);
  EXPECT_EQ(rows_of(floats.view()), kRows);
}

TEST(NpyDeathTest, AFileThatIsCutWhileItIsReadEndsWithOneLine) {
  const Scratch scratch;
  const Values values(1 << 16, 1.0);
  const std::string path = scratch.write("a.npy", npy_bytes<double>("<f8", {1 << 15, 2}, values));
  const auto read_behind_the_end = [&] {
    const PointFile file = read_points(path);
    const OutputFile begun(scratch.path("out.txt"));
    std::filesystem::resize_file(path, 100);
    ::exit(file.view().at(30000, 0) == 1.0 ? 7 : 8);
  };
  EXPECT_EXIT(read_behind_the_end(), ::testing::ExitedWithCode(1),
              "^ndhull: truncated: .*a.npy: found .*\n$");
  EXPECT_EQ(scratch.file_count(), 1U) << "the file begun is gone";
}

TEST(NpyExample, FortranOrderIsReadThroughStrides) {
  const PointFile file = parse(npy_bytes<double>("<f8", kShape, {1, 4, 2, 5, 3, 6}, true), "a.npy");
  EXPECT_EQ(file.view().row_stride, 1U);
  EXPECT_EQ(file.view().column_stride, 2U);
  EXPECT_EQ(rows_of(file.view()), kRows);
}

TEST(NpyExample, VersionsTwoAndThreeHaveLongerLengths) {
  const std::string one = npy_bytes<double>("<f8", kShape, kRows);
  for (const char version : {'\x02', '\x03'}) {
    std::string bytes =
        one.substr(0, 6) + version + '\0' + one.substr(8, 2) + std::string(2, '\0') + one.substr(10);
    EXPECT_EQ(rows_of(parse(bytes, "a.npy").view()), kRows);
  }
  std::string four = one;
  four[6] = '\x04';
  expect_refused(ErrorCode::kBadHeader, "version 4", four, "a.npy");
}

TEST(NpyExample, DataThatAreNotAlignedAreCopied) {
  std::string bytes = npy_bytes<double>("<f8", kShape, kRows);
  bytes.insert(bytes.find('}') + 1, " ");
  bytes[8] = static_cast<char>(bytes[8] + 1);
  EXPECT_EQ(rows_of(parse(bytes, "a.npy").view()), kRows);
}

TEST(NpyExample, IntegersAndHalvesBecomeDoubles) {
  const auto rows = [](const std::string& bytes) { return rows_of(parse(bytes, "a.npy").view()); };
  EXPECT_EQ(rows(npy_bytes<std::int8_t>("|i1", {1, 2}, {-128, 127})), (Values{-128, 127}));
  EXPECT_EQ(rows(npy_bytes<std::uint8_t>("|u1", {1, 2}, {0, 255})), (Values{0, 255}));
  EXPECT_EQ(rows(npy_bytes<std::int16_t>("<i2", {1, 2}, {-32768, 5})), (Values{-32768, 5}));
  EXPECT_EQ(rows(npy_bytes<std::uint16_t>("<u2", {1, 2}, {65535, 5})), (Values{65535, 5}));
  EXPECT_EQ(rows(npy_bytes<std::int32_t>("<i4", {1, 2}, {-7, 5})), (Values{-7, 5}));
  EXPECT_EQ(rows(npy_bytes<std::uint32_t>("<u4", {1, 2}, {4294967295U, 5})), (Values{4294967295.0, 5}));
  EXPECT_EQ(rows(npy_bytes<std::int64_t>("<i8", {1, 2}, {-(std::int64_t{1} << 53), 5})),
            (Values{-0x1p53, 5}));
  EXPECT_EQ(rows(npy_bytes<std::uint64_t>("<u8", {1, 2}, {std::uint64_t{1} << 63, 5})), (Values{0x1p63, 5}));
  EXPECT_EQ(rows(npy_bytes<std::uint16_t>("<f2", {1, 5}, {0x3C00, 0xC000, 0x0001, 0x7BFF, 0x8000})),
            (Values{1, -2, 0x1p-24, 65504, 0}));
}

TEST(NpyExample, ContentTellsTheFormatOfStandardInput) {
  EXPECT_EQ(rows_of(parse(npy_bytes<double>("<f8", kShape, kRows), "-").view()), kRows);
}

TEST(NpyRefusedExample, IntegersThatNoDoubleHolds) {
  const std::int64_t odd = (std::int64_t{1} << 53) + 1;
  expect_refused(ErrorCode::kBadNumber, "[1, 0]", npy_bytes<std::int64_t>("<i8", {2, 1}, {1, odd}), "a.npy");
  expect_refused(ErrorCode::kBadNumber, "[0, 0]",
                 npy_bytes<std::int64_t>("<i8", {1, 1}, {std::numeric_limits<std::int64_t>::max()}), "a.npy");
  expect_refused(ErrorCode::kBadNumber, "[0, 0]",
                 npy_bytes<std::uint64_t>("<u8", {1, 1}, {std::numeric_limits<std::uint64_t>::max()}),
                 "a.npy");
}

TEST(NpyRefusedExample, NaNAndInfinityWithTheirElement) {
  const std::vector<std::size_t> shape{5000, 2};
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    Values values(10000, 1.0);
    values[9001] = bad;
    expect_refused(ErrorCode::kNotFinite, "[4500, 1]", npy_bytes<double>("<f8", shape, values), "a.npy");
    expect_refused(ErrorCode::kNotFinite, "[4001, 1]", npy_bytes<double>("<f8", shape, values, true),
                   "a.npy");
    std::vector<float> floats(values.begin(), values.end());
    expect_refused(ErrorCode::kNotFinite, "[4500, 1]", npy_bytes<float>("<f4", shape, floats), "a.npy");
  }
  expect_refused(ErrorCode::kNotFinite, "[0, 1]", npy_bytes<std::uint16_t>("<f2", {1, 2}, {0, 0x7C00}),
                 "a.npy");
}

TEST(NpyLaw, TheLargestFiniteNumbersAreFinite) {
  const Values values{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), -0.0,
                      5e-324};
  EXPECT_EQ(rows_of(parse(npy_bytes<double>("<f8", {2, 2}, values), "a.npy").view()), values);
}

TEST(NpyRefusedExample, TypesThatAreNotReadAreNamed) {
  for (const char* type : {">f8", ">f4", ">i4", "<c16", "<f16", "|b1", "<U8", "|O", "|V8"}) {
    expect_refused(ErrorCode::kUnknownType, type, npy_bytes<double>(type, kShape, kRows), "a.npy");
  }
  std::string record = npy_bytes<double>("<f8", kShape, kRows);
  record.replace(record.find("'<f8'"), 5, "[('x', '<f8'), ('y\n', '<f8')]");
  record[8] = static_cast<char>(record[8] + 25);
  expect_refused(ErrorCode::kUnknownType, "('x', '<f8')", record, "a.npy");
}

TEST(NpyRefusedExample, OtherNumbersOfAxes) {
  expect_refused(ErrorCode::kBadHeader, "1 axes, expected 2", npy_bytes<double>("<f8", {6}, kRows), "a.npy");
  expect_refused(ErrorCode::kBadHeader, "reshape(-1, d)", npy_bytes<double>("<f8", {1, 2, 3}, kRows),
                 "a.npy");
}

TEST(NpyRefusedExample, NoRowsOrNoColumns) {
  expect_refused(ErrorCode::kEmptyInput, "(0, 3)", npy_bytes<double>("<f8", {0, 3}, {}), "a.npy");
  expect_refused(ErrorCode::kDimensionTooLow, "(3, 0)", npy_bytes<double>("<f8", {3, 0}, {}), "a.npy");
}

TEST(NpyRefusedExample, EveryTruncation) {
  const std::string bytes = npy_bytes<double>("<f8", kShape, kRows);
  for (std::size_t size = 6; size < bytes.size(); ++size) {
    expect_refused(ErrorCode::kTruncated, "a.npy", std::string_view(bytes).substr(0, size), "a.npy");
  }
  expect_refused(ErrorCode::kBadHeader, "NUMPY", std::string_view(bytes).substr(0, 5), "a.npy");
  expect_refused(ErrorCode::kWrongCount, "49 bytes", bytes + "x", "a.npy");
  expect_refused(ErrorCode::kTruncated, "a.npy", npy_bytes<double>("<f8", {1ULL << 62, 1ULL << 62}, kRows),
                 "a.npy");
}

TEST(NpyRefusedExample, HeadersThatNumpyDoesNotWrite) {
  const std::string bytes = npy_bytes<double>("<f8", kShape, kRows);
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"False", "Maybe"}, {"'descr'", "'crdes'"}, {"(2", "(-"}, {"{", "["}, {"'shape'", " shape "}}) {
    std::string damaged = bytes;
    damaged.replace(damaged.find(from), from.size(), to);
    expect_refused(ErrorCode::kBadHeader, "a.npy", damaged, "a.npy");
  }
  expect_refused(ErrorCode::kBadHeader, "numpy.save", "1 2 3\n", "a.npy");
}

TEST(NpyExample, RowsOfAnArrayAreHalfspaces) {
  const HalfspaceFile file = parse_halfspaces(
      FileBytes::copy_of(npy_bytes<float>("<f4", kShape, {1, 2, 3, 4, 5, 6}, true)), "planes.npy");
  EXPECT_EQ(file.dimension, 2U);
  EXPECT_EQ(file.count, 2U);
  EXPECT_EQ(file.rows, (Values{1, 3, 5, 2, 4, 6}));
}

}  // namespace
}  // namespace ndhull
