// Points as text: Qhull's format and tables.
#include <unistd.h>

#include <string>
#include <thread>

#include "tests/io/io_test_support.h"

namespace ndhull {
namespace {

using Values = std::vector<double>;

void expect_points(std::string_view content, std::size_t dimension, const Values& values,
                   const std::string& path = "points.txt") {
  SCOPED_TRACE(std::string(content.substr(0, 60)));
  const PointFile file = parse(content, path);
  EXPECT_EQ(file.view().dimension, dimension);
  EXPECT_EQ(rows_of(file.view()), values);
}

TEST(QhullTextExample, DimensionWithCommentThenCountThenFreeFormCoordinates) {
  expect_points("3 rbox 2 D3\n2\n1 2 3\n4 5 6\n", 3, {1, 2, 3, 4, 5, 6});
  expect_points("3\n2\n1 2\n3 4 5\n\n6", 3, {1, 2, 3, 4, 5, 6});
  expect_points("3 2\n1 2 3\n4 5 6\n", 3, {1, 2, 3, 4, 5, 6});
  expect_points("\n# comment\n3\r\n2\r\n1 2 3\r\n4 5 6\r\n", 3, {1, 2, 3, 4, 5, 6});
}

TEST(QhullTextExample, TextIsACommentToTheEndOfItsLineWhereQhullTakesItForOne) {
  const Values values{1, 2, 3, 4, 5, 6};
  for (const char* content :
       {"my points here\n3\n2\n1 2 3\n4 5 6\n", "points\n3\n2\n1 2 3\n4 5 6\n",
        "rbox 2 D3 | qhull FQ p\n3\n2\n1 2 3\n4 5 6\n", "mine\nof 2024\n3\n2\n1 2 3\n4 5 6\n",
        "my 2 points\n3 2\n1 2 3\n4 5 6\n", "my points\n3 2\n1 2 3\n4 5 6\n",
        "-- points --\n3 of D3\nhow many:\n2 points\nrows:\n1 2 3 first\n4 5\n6 end\n",
        "3\nmine\n2\n1 2 3\n4 5 6\n", "3\n2\n1 2 3\n4 5 6\nend of it, 7 8\n"}) {
    expect_points(content, 3, values);
  }
}

TEST(QhullTextExample, ACommentWhereANumberIsMissingIsNone) {
  expect_refused(ErrorCode::kBadNumber, "line 4: column 2: found \"x\"", "3\n2\n1 2 3\n4 x 6\n");
  expect_refused(ErrorCode::kBadNumber, "line 3: column 1: found \"x\"", "3\n2\nx 2 3\n4 5 6\n");
  expect_refused(ErrorCode::kBadNumber, "line 5: column 1: found \"NA\"", "mine\n3\n2\n1 2 3\nNA NA NA\n");
  expect_refused(ErrorCode::kNotFinite, "line 4: column 2", "3\n2\n1 2 3\n4 nan 6\n");
  expect_refused(ErrorCode::kWrongCount, "found 3 numbers", "my points\n3\n2\n1 2 3\n");
  expect_refused(ErrorCode::kWrongCount, "found 6 numbers", "3\n3\n1 2 3\n4 5 6\nend of it\nindeed\n");
}

TEST(TableExample, NamesAboveIntegersAreNoCommentOfQhulls) {
  expect_points("x\n3\n2\n1\n5\n6\n7\n1\n", 1, {3, 2, 1, 5, 6, 7, 1});
  expect_points("x y\n2 3\n1 2\n3 4\n5 6\n", 2, {2, 3, 1, 2, 3, 4, 5, 6});
  expect_points("x y\n1 2\n3 4\n", 2, {1, 2, 3, 4});
  EXPECT_EQ(rows_of(parse("x y name\n1 2 a\n3 4 b\n", "points.txt", ColumnChoice("x,y")).view()),
            (Values{1, 2, 3, 4}));
}

TEST(QhullTextExample, CountBeforeDimensionIsReadWhenTheLinesSaySo) {
  expect_points("4\n2\n1 2\n3 4\n5 6\n7 8\n", 2, {1, 2, 3, 4, 5, 6, 7, 8});
  expect_points("4 2\n1 2\n3 4\n5 6\n7 8\n", 2, {1, 2, 3, 4, 5, 6, 7, 8});
}

TEST(QhullTextExample, FewerPointsThanDimensionsAreNotInterchanged) {
  expect_points("4\n2\n1 2 3 4\n5 6 7 8\n", 4, {1, 2, 3, 4, 5, 6, 7, 8});
  expect_points("4\n2\n1 2 3\n4 5 6\n7 8\n", 4, {1, 2, 3, 4, 5, 6, 7, 8});
}

TEST(QhullTextExample, LinesOfSeveralPointsAreNotPoints) {
  expect_points("2\n4\n1 2 3 4\n5 6 7 8\n", 2, {1, 2, 3, 4, 5, 6, 7, 8});
  expect_points("2 3\n1 2 3\n4 5 6\n", 2, {1, 2, 3, 4, 5, 6});
}

TEST(TableExample, EverySeparatorGivesTheSamePoints) {
  const Values values{1, -2.5, 3e4, 0.25, 5, -6};
  for (const char* content :
       {"1,-2.5,3e4\n.25,5.,-6\n", "1;-2.5;3e4\n.25;5.;-6\n", "1\t-2.5\t3e4\n.25\t5.\t-6\n",
        "  1 -2.5   3e4\n.25 5. -6", "1, -2.5, +3E+4\r\n.25 ,5.,-6\r\n\r\n",
        "\xEF\xBB\xBF\"1\",\"-2.5\",\"3e4\"\n\".25\",\"5.\",\"-6\"\n\n\n",
        "# made by hand\n1,-2.5,3e4 # first\n\n.25,5.,-6\n"}) {
    expect_points(content, 3, values);
  }
}

TEST(TableExample, HeaderNamesAreKeptWithoutTheirQuotes) {
  for (const char* content : {"x,\"y, or so\",z\n1,2,3\n", "x\ty, or so\tz\n1\t2\t3\n",
                              "x;y, or so;z\r\n1;2;3\r\n", "x \"y, or so\" z\n1 2 3\n"}) {
    SCOPED_TRACE(content);
    const PointFile file = parse(content, "points.dat");
    EXPECT_EQ(file.column_names, (std::vector<std::string>{"x", "y, or so", "z"}));
    EXPECT_EQ(rows_of(file.view()), (Values{1, 2, 3}));
  }
}

TEST(TableExample, NumbersInQuotesAboveNumbersWithoutAreNames) {
  for (const char* content :
       {"\"1\",\"2\"\n3,4\n5,6\n", "\"1\";\"2\"\n# a comment\n\n3;4\n5;6\n", "\"1\" \"2\"\n3 4\n5 6\n"}) {
    SCOPED_TRACE(content);
    const PointFile file = parse(content, "points.dat");
    EXPECT_EQ(file.column_names, (std::vector<std::string>{"1", "2"}));
    EXPECT_EQ(rows_of(file.view()), (Values{3, 4, 5, 6}));
  }
  expect_points("\"1\",\"2\"\n\"3\",\"4\"\n", 2, {1, 2, 3, 4});
  expect_points("\"1\",\"2\"\n", 2, {1, 2});
}

TEST(TableExample, ARowOfMissingValuesIsNoHeader) {
  for (const char* row : {"NA,NA", "na,n/a", "\"NA\",\"NA\"", "NA,", "null,None", ".,.", "-,?"})
    expect_refused(ErrorCode::kBadNumber, "line 1: column", std::string(row) + "\n1,2\n", "points.csv");
  expect_refused(ErrorCode::kBadNumber, "\"NA\", expected a number; fill in the value", "1,2\n3,NA\n");
  expect_points("Na,K\n1,2\n", 2, {1, 2});
}

TEST(TableExample, LinesMayEndWithCarriageReturnsAlone) {
  expect_points("x,y\r1,2\r3,4\r", 2, {1, 2, 3, 4});
  expect_points("1 -2\r3 4", 2, {1, -2, 3, 4});
  expect_points("3\r2\r1 2 3\r4 5 6\r\n", 3, {1, 2, 3, 4, 5, 6});
  expect_points("1,2\r\r\n3,4\r\r\n", 2, {1, 2, 3, 4});
  expect_refused(ErrorCode::kRaggedRow, "line 3: found 1 columns", "x,y\r1,2\r3\r");
}

TEST(TableExample, ATableOfIntegersIsNotTakenForQhullText) {
  expect_points("2 3\n4 5\n6 7\n", 2, {2, 3, 4, 5, 6, 7});
  expect_points("3 1 2\n4 5 6\n", 3, {3, 1, 2, 4, 5, 6});
  expect_points("3\n2\n1\n", 1, {3, 2, 1}, "points.csv");
  expect_points("33 ,28\n19 ,86\n", 2, {33, 28, 19, 86});
  expect_points("33 ;28\n19 ;86.5\n", 2, {33, 28, 19, 86.5});
}

TEST(TableExample, NumbersAreRoundedCorrectly) {
  expect_points("0.1,1e-400,4.9e-324,9007199254740993,1.7976931348623157e308\n", 5,
                {0.1, 0.0, 4.9e-324, 9007199254740992.0, 1.7976931348623157e308});
}

TEST(TextRefusedExample, RaggedRows) {
  expect_refused(ErrorCode::kRaggedRow, "line 3: found 2 columns, expected 3 as in line 1",
                 "1,2,3\n4,5,6\n7,8\n");
  expect_refused(ErrorCode::kRaggedRow, "line 2: found 4", "1 2 3\n4 5 6 7\n");
  expect_refused(ErrorCode::kRaggedRow, "line 2: found 3 columns, expected 2", "x,y\n1,2,3\n");
  expect_refused(ErrorCode::kRaggedRow, "line 4: found 2 columns", "3\n2\n1 2 3\n4 5\n");
}

TEST(TextRefusedExample, NaNAndInfinityHoweverSpelled) {
  for (const char* word : {"nan", "NaN", "-nan", "NAN(0x7ff)", "inf", "-Inf", "+inf", "Infinity", "-INFINITY",
                           "1e999", "-1e400", "1.#INF", "-1.#IND", "1.#QNAN", "\"nan\""}) {
    const std::string content = std::string("1,2\n3,") + word + "\n";
    expect_refused(ErrorCode::kNotFinite, "line 2: column 2", content);
  }
  expect_refused(ErrorCode::kNotFinite, "line 1: column 1", "nan,inf\n1,2\n");
  expect_refused(ErrorCode::kNotFinite, "line 4: column 3", "3\n2\n1 2 3\n4 5 inf\n");
}

TEST(TextRefusedExample, TextInANumber) {
  for (const char* word : {"1.2abc", "abc", "1.2.3", "--1", "1e", "0x10", "1_000", "NA", "1 000", "\"7"}) {
    const std::string content = std::string("1,2\n3,") + word + "\n";
    expect_refused(ErrorCode::kBadNumber, "line 2: column 2", content, "points.csv");
  }
  expect_refused(ErrorCode::kBadNumber, "\"1.2abc\"", "1.2abc,2\n3,4\n");
  expect_refused(ErrorCode::kBadNumber, "empty field", "1,,3\n");
  expect_refused(ErrorCode::kBadNumber, "column 3: found an empty field", "1,2,\n");
  expect_refused(ErrorCode::kBadNumber, "line 3: column 2: found \"5x\"", "3\n2\n1 5x 3\n4 5 6\n");
  expect_refused(ErrorCode::kBadNumber, "decimal point", "1,5;2,5\n");
}

TEST(TextRefusedExample, FewerOrMoreNumbersThanAnnounced) {
  expect_refused(ErrorCode::kWrongCount, "found 3 numbers, expected 2 x 3 = 6", "3\n2\n1 2 3\n");
  expect_refused(ErrorCode::kWrongCount, "found 9 numbers", "3\n2\n1 2 3\n4 5 6\n7 8 9\n");
  expect_refused(ErrorCode::kWrongCount, "found 0 numbers", "3 rbox\n2\n");
}

TEST(TextRefusedExample, NothingToRead) {
  expect_refused(ErrorCode::kEmptyInput, "points.txt", "");
  expect_refused(ErrorCode::kEmptyInput, "points.txt", " \n\n");
  expect_refused(ErrorCode::kEmptyInput, "header line", "x,y,z\n", "points.csv");
  expect_refused(ErrorCode::kEmptyInput, "comments", "# x y z\n");
  expect_refused(ErrorCode::kEmptyInput, "0 points", "3\n0\n");
  expect_refused(ErrorCode::kEmptyInput, "points.npy", "", "points.npy");
}

TEST(TextRefusedExample, DimensionZero) {
  expect_refused(ErrorCode::kDimensionTooLow, "line 1: found dimension 0", "0\n5\n");
}

TEST(TextRefusedExample, HeadersThatAreDamaged) {
  expect_refused(ErrorCode::kBadHeader, "number of points", "3 rbox D3\n1.5 2 3\n");
  expect_refused(ErrorCode::kBadHeader, "end of the file", "3\n");
  expect_refused(ErrorCode::kBadHeader, "fits in memory", "9999999999\n9999999999999\n");
  expect_refused(ErrorCode::kBadHeader, "index column", ",x,y\n0,1,2\n", "points.csv");
}

TEST(TextRefusedExample, BinaryFilesAreNamed) {
  expect_refused(ErrorCode::kBadHeader, "gzip", "\x1F\x8B\x08");
  expect_refused(ErrorCode::kBadHeader, ".npz", "PK\x03\x04");
  expect_refused(ErrorCode::kBadHeader, "UTF-16",
                 "\xFF\xFE"
                 "1");
  expect_refused(ErrorCode::kBadHeader, "binary", std::string_view("1 2\0 3", 6));
}

TEST(FileBytesExample, MissingFilesAndDirectoriesAreErrors) {
  const Scratch scratch;
  expect_error(ErrorCode::kFileMissing, "no such file", [&] { read_points(scratch.path("nothing.csv")); });
  expect_error(ErrorCode::kFileMissing, "directory", [&] { read_points(scratch.path("")); });
}

TEST(FileBytesExample, APipeIsReadToItsEnd) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  std::string content = "2\n400000\n";
  for (int row = 0; row < 400000; ++row) content += "1 -1\n";
  std::thread writer([&] {
    for (std::size_t done = 0; done < content.size();) {
      done += static_cast<std::size_t>(::write(ends[1], content.data() + done, content.size() - done));
    }
    ::close(ends[1]);
  });
  FileBytes bytes = FileBytes::read_descriptor(ends[0], "standard input");
  writer.join();
  ::close(ends[0]);
  const PointFile file = parse_points(std::move(bytes), "-");
  EXPECT_EQ(file.path, "standard input");
  EXPECT_EQ(file.view().rows, 400000U);
  EXPECT_EQ(file.view().at(399999, 1), -1.0);
}

TEST(FileBytesExample, AFileIsReadFromItsPathAndMovesWithItsPoints) {
  const Scratch scratch;
  PointFile file = read_points(scratch.write("points.csv", "1,2\n3,4\n"));
  const PointView before = file.view();
  const PointFile moved = std::move(file);
  EXPECT_EQ(moved.view().data, before.data);
  EXPECT_EQ(rows_of(moved.view()), (Values{1, 2, 3, 4}));
}

}  // namespace
}  // namespace ndhull
