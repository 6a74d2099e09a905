// Columns that are chosen of tables and other files of points.
#include <string>
#include <string_view>

#include "tests/io/io_test_support.h"

namespace ndhull {
namespace {

using Values = std::vector<double>;
using Names = std::vector<std::string>;

void expect_chosen(std::string_view content, const std::string& list, const Values& values,
                   const Names& names = {}, const std::string& path = "points.txt") {
  SCOPED_TRACE(std::string(content.substr(0, 60)) + " --columns " + list);
  const PointFile file = parse(content, path, ColumnChoice(list));
  EXPECT_EQ(rows_of(file.view()), values);
  EXPECT_EQ(file.column_names, names);
}

void expect_not_chosen(ErrorCode code, const std::string& words, std::string_view content,
                       const std::string& list) {
  SCOPED_TRACE(std::string(content.substr(0, 60)) + " --columns " + list);
  expect_error(code, words, [&] { parse(content, "points.txt", ColumnChoice(list)); });
}

constexpr std::string_view kSpecies =
    "\"\",\"species\",\"mass\",\"h\",\"w\"\n"
    "\"1\",\"a, b\",1.5,2,3\r\n"
    "# a comment\n"
    "\"2\",\"Item #5\", 4 ,\"5\",6 # here too\n"
    "3,,7,8,NA\n";

TEST(ColumnChoiceExample, ByNameNumberAndRangeInTheOrderOfTheList) {
  expect_chosen(kSpecies, "3-4", {1.5, 2, 4, 5, 7, 8}, {"mass", "h"});
  expect_chosen(kSpecies, "h,3", {2, 1.5, 5, 4, 8, 7}, {"h", "mass"});
  expect_chosen(kSpecies, "4", {2, 5, 8}, {"h"});
  expect_chosen("4,x,5\n6,y,7\n", "3,1", {5, 4, 7, 6});
}

TEST(ColumnChoiceExample, EverySeparator) {
  expect_chosen("name\tx\ty\n a b\t1\t2\nc\t3\t4\n", "y,x", {2, 1, 4, 3}, {"y", "x"});
  expect_chosen("name;x;y\na,b;1;2\n", "2-3", {1, 2}, {"x", "y"});
  expect_chosen("x y site\n1 2 \"north  side\" # words\n 3\t4 south\n", "1-2", {1, 2, 3, 4}, {"x", "y"});
  expect_chosen("a 1 2\nb 3 4 # words\n", "3,2", {2, 1, 4, 3});
}

TEST(ColumnChoiceExample, FilesThatAreNumbersThroughout) {
  expect_chosen("3\n2\n1 2 3\n4 5 6\n", "3,1", {3, 1, 6, 4});
  expect_chosen("V-representation\nbegin\n2 4 rational\n1 1/2 2 3\n1 4 5 6\nend\n", "1,3", {0.5, 3, 4, 6}, {},
                "points.ext");
  const std::string array = npy_bytes<float>("<f4", {2, 3}, {1, 2, 3, 4, 5, 6}, true);
  expect_chosen(array, "3,1", {5, 1, 6, 2}, {}, "points.npy");
  expect_chosen(npy_bytes<std::int16_t>("<i2", {2, 3}, {1, 2, 3, 4, 5, 6}), "2", {2, 5}, {}, "points.npy");
}

TEST(ColumnChoiceExample, OtherColumnsOfAnArrayMayHoldAnyNumber) {
  const double nan = std::nan("");
  const std::string array = npy_bytes<double>("<f8", {2, 3}, {1, nan, 3, 4, 5, 6});
  expect_chosen(array, "3,1", {3, 1, 6, 4}, {}, "points.npy");
  expect_error(ErrorCode::kNotFinite, "element [0, 1]: found nan",
               [&] { parse(array, "points.npy", ColumnChoice("3,2")); });
  const std::string turned = npy_bytes<double>("<f8", {2, 3}, {1, 4, 2, 5, 3, nan}, true);
  expect_chosen(turned, "2-2", {2, 5}, {}, "points.npy");
  expect_error(ErrorCode::kNotFinite, "element [1, 2]: found nan",
               [&] { parse(turned, "points.npy", ColumnChoice("3,2")); });
}

TEST(ColumnChoiceExample, NamesThatAreNumbers) {
  expect_chosen("\"name\",\"1\",\"2\"\na,3,4\n", "2-3", {3, 4}, {"1", "2"});
  expect_chosen("\"1\",\"2\",\"3\"\n3,4,5\n", "3,1", {5, 3}, {"3", "1"});
  expect_not_chosen(ErrorCode::kUsage, "found \"1\", the name of column 2 and the number of another",
                    "\"0\",\"1\"\n3,4\n", "1");
  expect_not_chosen(ErrorCode::kUsage, "write 2-2 or 1-1", "\"0\",\"1\"\n3,4\n", "1");
  expect_chosen("\"0\",\"1\"\n3,4\n", "1-1", {3}, {"0"});
}

TEST(ColumnChoiceRefused, ANameThatSeveralColumnsHave) {
  expect_not_chosen(ErrorCode::kUsage, "found \"x\", the name of columns 1 and 3", "x,y,x\n1,2,3\n", "y,x");
  expect_chosen("x,y,x\n1,2,3\n", "y,3", {2, 3}, {"y", "x"});
}

TEST(ColumnChoiceRefused, ARowOfMissingValues) {
  expect_not_chosen(ErrorCode::kBadNumber, "line 1: column 2: found \"NA\"", "a,NA,NA\nb,1,2\n", "2-3");
}

TEST(ColumnChoiceRefused, WhatIsNoColumn) {
  for (const char* list : {"species,nope", "0", "6", "2-6", "4-3", "-2", "2-", "1.5", "Mass"})
    expect_not_chosen(ErrorCode::kUsage, "a number from 1 to 5 or a name of the header", kSpecies, list);
  expect_not_chosen(ErrorCode::kUsage, "the file has no header", "1,2\n", "x");
  expect_not_chosen(ErrorCode::kUsage, "column 3 of points.txt twice", kSpecies, "mass,h,3");
  for (const char* list : {"", ",", "1,", ",1", "1,,2"})
    expect_error(ErrorCode::kUsage, "--columns", [&] { ColumnChoice{list}; });
}

TEST(ColumnChoiceRefused, RowsThatAreDamaged) {
  expect_not_chosen(ErrorCode::kBadNumber, "line 5: column 5: found \"NA\"", kSpecies, "5");
  expect_not_chosen(ErrorCode::kBadNumber, "line 2: column 2: found \"a\"", kSpecies, "mass,species");
  expect_not_chosen(ErrorCode::kBadNumber, "column 2: found an empty field", "a,b\nx,\n", "b");
  expect_not_chosen(ErrorCode::kBadHeader, "column 1: found no name", kSpecies, "mass,1");
  expect_not_chosen(ErrorCode::kRaggedRow, "line 3: found 2 columns, expected 3", "a,b,c\n1,2,x\n3,4\n",
                    "a,b");
  expect_not_chosen(ErrorCode::kRaggedRow, "line 2: found 4 columns", "a b c\n1 2 x y\n", "a,b");
  expect_not_chosen(ErrorCode::kRaggedRow, "line 2: found 1 columns", "a 1 2\nb # 3 4\n", "2");
}

}  // namespace
}  // namespace ndhull
