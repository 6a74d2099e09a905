// Files of cdd and lrs, and halfspaces in all text formats.
#include <cmath>

#include "tests/io/io_test_support.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/rational.h"

namespace ndhull {
namespace {

using Values = std::vector<double>;

HalfspaceFile halfspaces(std::string_view content, const std::string& path = "planes.txt") {
  return parse_halfspaces(FileBytes::copy_of(content), path);
}

void expect_halfspaces_refused(ErrorCode code, std::string_view mention, std::string_view content,
                               const std::string& path = "planes.ine") {
  SCOPED_TRACE(std::string(content.substr(0, 60)));
  expect_error(code, mention, [&] { halfspaces(content, path); });
}

TEST(CddPointsExample, IntegersRationalsAndRealsAfterTheLeadingOne) {
  const std::string content =
      "square\n* a comment\nV-representation\nbegin\n 4 3 rational\n1 0 0\n1 1/2 0 # corner\n* another\n1 0 "
      "-3/4\n"
      "1 12345678901234567890/2 1\nend\nhull\n";
  const PointFile file = parse(content, "square.ext");
  EXPECT_EQ(file.view().dimension, 2U);
  EXPECT_EQ(rows_of(file.view()), (Values{0, 0, 0.5, 0, 0, -0.75, 6172839450617283945.0, 1}));
  EXPECT_EQ(rows_of(parse(content, "-").view()), rows_of(file.view())) << "content tells the format";
}

TEST(CddPointsExample, RationalsOfAnyLengthAreRoundedOnce) {
  const std::string ones(400, '1'), zeros(399, '0');
  const std::string content = "V-representation\nbegin\n3 3 rational\n1 " + ones + "/1" + zeros + " -" +
                              ones + "/" + ones + "\n1 1/" + ones + " +3" + zeros + "/-2" + zeros + "\n1 " +
                              // 1 + 2^-53 and a little: just above a tie. Divided as doubles it would be 1.
                              "9007199254740993000001/9007199254740992000000 1/3\nend\n";
  EXPECT_EQ(rows_of(parse(content, "a.ext").view()),
            (Values{1.1111111111111112, -1.0, 0.0, -1.5, 1.0000000000000002, 1.0 / 3.0}));
}

TEST(CddPointsLaw, LongRationalsAreTheNearestDoubles) {
  // A double times 10^20 + 7 over the same number, and what is next to half a unit above.
  for (const double value : {1.0, 3.0, 0.1, 1e-300, 5e300, 1e15 + 1.0, 0x1p-1022}) {
    int exponent = 0;
    const auto bits = static_cast<std::uint64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
    std::string p = std::to_string(bits), q = "1";
    const auto doubled = [](std::string number) {
      int carry = 0;
      for (auto digit = number.rbegin(); digit != number.rend(); ++digit) {
        const int twice = 2 * (*digit - '0') + carry;
        *digit = static_cast<char>('0' + twice % 10);
        carry = twice / 10;
      }
      return carry > 0 ? "1" + number : number;
    };
    for (; exponent > 0; --exponent) p = doubled(p);
    for (; exponent < 0; ++exponent) q = doubled(q);
    EXPECT_EQ(nearest_quotient(p, q), value);
    EXPECT_EQ(nearest_quotient("-" + p + std::string(30, '0'), "+" + q + std::string(30, '0')), -value);
    EXPECT_EQ(nearest_quotient(p + std::string(29, '0') + "1", q + std::string(30, '0')), value);
  }
  EXPECT_EQ(nearest_quotient("9007199254740993", "1"), 9007199254740992.0) << "halves to even";
  EXPECT_EQ(nearest_quotient("9007199254740995", "1"), 9007199254740996.0);
  EXPECT_EQ(nearest_quotient("1" + std::string(400, '0'), "1"), HUGE_VAL);
  for (const char* const q : {"0", "", "-", "1.5", "2e3", "1-2"}) EXPECT_FALSE(nearest_quotient("1", q)) << q;
}

TEST(CddPointsExample, TheCountMayBeOpenAsLrsWritesIt) {
  const std::string content =
      "V-representation\nbegin\n***** 3 rational\n 1 0 0\n 1 1 0\n 1 0 1\nend\n*Totals: 3\n";
  EXPECT_EQ(rows_of(parse(content, "-").view()), (Values{0, 0, 1, 0, 0, 1}));
}

TEST(CddRefusedExample, RaysLinesAndHalfspacesAreNoPoints) {
  const std::string rows = "begin\n2 3 integer\n1 0 0\n0 1 0\nend\n";
  expect_refused(ErrorCode::kBadHeader, "line 5: column 1: found 0", "V-representation\n" + rows, "a.ext");
  expect_refused(ErrorCode::kBadHeader, "linearity", "V-representation\nlinearity 1 2\n" + rows, "a.ext");
  expect_refused(ErrorCode::kBadHeader, "ndhull intersect", "H-representation\n" + rows, "a.ext");
  expect_refused(ErrorCode::kBadHeader, "ndhull intersect", rows, "a.ine");
  expect_refused(ErrorCode::kBadHeader, "found 2, expected 1", "begin\n1 2 integer\n2 5\nend\n", "a.ext");
}

TEST(CddRefusedExample, DamagedMatrices) {
  const std::string head = "V-representation\nbegin\n";
  expect_refused(ErrorCode::kBadHeader, "begin", "V-representation\n1 2 3\n", "a.ext");
  expect_refused(ErrorCode::kBadHeader, "line 3", head + "2 3\n1 0 0\n1 1 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kBadHeader, "line 3", head + "2 3 complex\n1 0 0\n1 1 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kBadHeader, "a.ext", head, "a.ext");
  expect_refused(ErrorCode::kDimensionTooLow, "found 1 columns", head + "2 1 integer\n1\n1\nend\n", "a.ext");
  expect_refused(ErrorCode::kEmptyInput, "0 rows", head + "0 3 integer\nend\n", "a.ext");
  expect_refused(ErrorCode::kEmptyInput, "a.ext", "\n", "a.ext");
  expect_refused(ErrorCode::kRaggedRow, "line 5: found 2 columns", head + "2 3 real\n1 0 0\n1 1\nend\n",
                 "a.ext");
  expect_refused(ErrorCode::kWrongCount, "found 3 numbers", head + "2 3 real\n1 0 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kWrongCount, "found 9 numbers", head + "2 3 real\n1 0 0\n1 1 0\n1 2 0\nend\n",
                 "a.ext");
  expect_refused(ErrorCode::kWrongCount, "end", head + "2 3 real\n1 0 0\n1 1 0\n", "a.ext");
  expect_refused(ErrorCode::kBadNumber, "line 4: column 2", head + "1 3 rational\n1 1/ 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kBadNumber, "q != 0", head + "1 3 rational\n1 1/0 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kBadNumber, "\"x\"", head + "1 3 rational\n1 x 0\nend\n", "a.ext");
  expect_refused(ErrorCode::kNotFinite, "line 4: column 3", head + "1 3 real\n1 0 nan\nend\n", "a.ext");
}

TEST(HalfspaceExample, CddInequalitiesAreTurnedRound) {
  // 1 - x >= 0 is x - 1 <= 0; 1/2 + y >= 0 is -y - 1/2 <= 0.
  const HalfspaceFile file =
      halfspaces("H-representation\nbegin\n2 3 rational\n1 -1 0\n1/2 0 1\nend\n", "a.ine");
  EXPECT_EQ(file.dimension, 2U);
  EXPECT_EQ(file.rows, (Values{1, 0, -1, 0, -1, -0.5}));
  EXPECT_FALSE(file.interior_point.has_value());
}

TEST(HalfspaceExample, QhullTextAndTablesHoldNormalsAndOffsets) {
  const Values rows{1, 0, -1, 0, -1, -0.5};
  for (const char* content : {"3\n2\n1 0 -1\n0 -1 -.5\n", "3 2\n1 0 -1\n0 -1 -.5\n", "1 0 -1\n0 -1 -.5\n",
                              "a,b,c\n1,0,-1\n0,-1,-.5\n"}) {
    const HalfspaceFile file = halfspaces(content);
    EXPECT_EQ(file.dimension, 2U);
    EXPECT_EQ(file.count, 2U);
    EXPECT_EQ(file.rows, rows);
  }
}

TEST(HalfspaceExample, AnInteriorPointMayStandInFront) {
  const HalfspaceFile file = halfspaces("2 1\n0.25 -0.25 \n3\n2\n1 0 -1\n0 -1 -.5\n");
  EXPECT_EQ(file.interior_point, (Values{0.25, -0.25}));
  EXPECT_EQ(file.rows, (Values{1, 0, -1, 0, -1, -0.5}));
}

TEST(HalfspaceExample, OneHalfspaceIsNotTakenForAnInteriorPoint) {
  const HalfspaceFile file = halfspaces("3 1\n1 0 -1\n");
  EXPECT_FALSE(file.interior_point.has_value());
  EXPECT_EQ(file.rows, (Values{1, 0, -1}));
}

TEST(HalfspaceExample, EquationsAreTwoHalfspacesAndRowsThatHoldEverywhereAreNone) {
  const std::string rows = "begin\n4 3 integer\n1 -1 0\n1 0 0\n0 0 0\n2 0 1\nend\n";
  for (const std::string& content : {"H-representation\nlinearity 1 4\n" + rows, rows + "equality 1 4\n",
                                     "linearity 3  4 3 4 # the last\n" + rows}) {
    SCOPED_TRACE(content);
    const HalfspaceFile file = halfspaces(content, "a.ine");
    EXPECT_EQ(file.rows, (Values{1, 0, -1, 0, -1, -2, 0, 1, 2}));
    EXPECT_EQ(file.count, 3U);
    EXPECT_EQ(file.file_row, (std::vector<std::uint32_t>{0, 3, 3}));
    EXPECT_EQ(file.is_reversed, (std::vector<bool>{false, false, true}));
    EXPECT_EQ(file.file_row_count, 4U);
    EXPECT_FALSE(file.impossible.has_value());
  }
  EXPECT_EQ(halfspaces("linearity 0\n" + rows, "a.ine").rows, (Values{1, 0, -1, 0, -1, -2}));
}

TEST(HalfspaceExample, ARowThatHoldsNowhereIsKept) {
  const std::string rows = "begin\n2 3 integer\n1 -1 0\n-2 0 0\nend\n";
  const HalfspaceFile file = halfspaces(rows, "a.ine");
  ASSERT_TRUE(file.impossible.has_value());
  EXPECT_EQ(file.impossible->row, 1U);
  EXPECT_EQ(file.impossible->offset, 2.0);
  expect_error(ErrorCode::kBadHalfspace, "a.ine, row 1 (counted from 0)", [&] { file.require_possible(); });
  const std::string positive = "linearity 1 2\nbegin\n2 3 integer\n1 -1 0\n2 0 0\nend\n";
  ASSERT_TRUE(halfspaces(positive, "a.ine").impossible.has_value());
  EXPECT_EQ(halfspaces(positive, "a.ine").impossible->offset, -2.0);
}

TEST(HalfspaceRefusedExample, EquationsPointsAndZeroNormals) {
  const std::string rows = "begin\n2 3 integer\n1 -1 0\n1 0 1\nend\n";
  for (const char* list : {"linearity\n", "linearity 2 1\n", "linearity 1 1 2\n", "linearity 1 0\n",
                           "linearity 1 3\n", "linearity 1 1\nlinearity 1 2\n"}) {
    SCOPED_TRACE(list);
    expect_halfspaces_refused(ErrorCode::kBadHeader, "line ", "H-representation\n" + (list + rows));
  }
  expect_halfspaces_refused(ErrorCode::kBadNumber, "line 6: column 3: found \"x\"", rows + "linearity 1 x\n");
  expect_halfspaces_refused(ErrorCode::kBadHeader, "strict_inequality", "strict_inequality 1 1\n" + rows);
  expect_halfspaces_refused(ErrorCode::kBadHeader, "ndhull hull", "V-representation\n" + rows);
  expect_halfspaces_refused(ErrorCode::kBadHalfspace, "halfspace 0 (counted from 0)", "3\n1\n0 -0 1\n",
                            "a.txt");
}

TEST(HalfspaceRefusedExample, BadTextKeepsItsLine) {
  expect_halfspaces_refused(ErrorCode::kBadNumber, "line 6: column 2", "2 1\n0 0\n3\n2\n1 0 -1\n0 x 1\n",
                            "a.txt");
  expect_halfspaces_refused(ErrorCode::kBadHeader, "dimension 3", "3 1\n0 0 0\n3\n1\n1 0 -1\n", "a.txt");
  expect_halfspaces_refused(ErrorCode::kDimensionTooLow, "1 column", "1\n2\n3\n4\n", "a.csv");
  expect_halfspaces_refused(ErrorCode::kNotFinite, "line 1", "1 inf 2\n", "a.txt");
  expect_halfspaces_refused(ErrorCode::kEmptyInput, "a.txt", "", "a.txt");
}

}  // namespace
}  // namespace ndhull
