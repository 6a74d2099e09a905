// Option strings of Qhull: what they ask for, and what is refused.
#include "tools/qhull/qhull_options.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tools/qhull/qhull_scaling.h"

namespace ndhull {
namespace {

QhullCommand parsed(const char* options) { return parse_qhull_command(options, QhullProgram::kQhull); }

/// The message of the refusal; empty when there is none.
std::string refusal(const char* options, QhullProgram program = QhullProgram::kQhull) {
  try {
    parse_qhull_command(options, program);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    return error.what();
  }
  return {};
}

TEST(QhullOptions, TheManualsRecipeIsRead) {
  const QhullCommand command = parsed("  Qx W1e-1   C1e-2 PA10 FV Fo\n");
  EXPECT_EQ(command.text, "Qx W1e-1 C1e-2 PA10 FV Fo");
  EXPECT_EQ(command.outside_width, 0.1);
  EXPECT_EQ(command.centrum_radius, 0.01);
  EXPECT_EQ(command.selection.largest, 10U);
  EXPECT_TRUE(command.keeps_closest);
  EXPECT_FALSE(command.prints_kept);
  EXPECT_EQ(command.formats, (std::vector<std::string>{"FV", "Fo"}));
}

TEST(QhullOptions, LettersOfAGroupMayBeJoined) {
  const QhullCommand command = parsed("snFxSo TvsF2000 QciJ1e-9R-7 Qb2:-1e-14B2:1e-14 Pd0D1:-.5g");
  EXPECT_TRUE(command.has_summary && command.verify && command.has_statistics);
  EXPECT_EQ(command.formats, (std::vector<std::string>{"n", "Fx", "FS", "Fo"}));
  EXPECT_EQ(command.progress_facets, 2000U);
  EXPECT_TRUE(command.keep_coplanar && command.keep_interior);
  EXPECT_EQ(command.joggle, 1e-9);
  EXPECT_EQ(command.seed, 7U);
  ASSERT_EQ(command.column_bounds.size(), 2U);
  EXPECT_EQ(command.column_bounds[0].column, 2U);
  EXPECT_FALSE(command.column_bounds[0].is_upper);
  EXPECT_EQ(command.column_bounds[0].value, -1e-14);
  EXPECT_TRUE(command.column_bounds[1].is_upper);
  EXPECT_EQ(command.column_bounds[1].value, 1e-14);
  ASSERT_EQ(command.normal_bounds.size(), 2U);
  EXPECT_TRUE(command.normal_bounds[0].is_least);
  EXPECT_EQ(command.normal_bounds[0].value, 0.0);
  EXPECT_EQ(command.normal_bounds[1].column, 1U);
  EXPECT_EQ(command.normal_bounds[1].value, -0.5);
  EXPECT_TRUE(command.prints_kept);
}

TEST(QhullOptions, MergingBeforeAndAfterIsTheSame) {
  EXPECT_EQ(parsed("C-1e-2 C1e-3").centrum_radius, 1e-2);
  EXPECT_EQ(parsed("A-0.9 A0.95").max_cosine, 0.9);
  EXPECT_EQ(parsed("C-0").centrum_radius, 0.0);
}

TEST(QhullOptions, MergingIsOffWithQ0AndQJUnlessItIsAskedFor) {
  EXPECT_TRUE(parsed("").is_merged);
  EXPECT_FALSE(parsed("Q0").is_merged);
  EXPECT_TRUE(parsed("Q0 C-0").is_merged);
  EXPECT_TRUE(parsed("Q1 Q10 Q17").is_merged);
  EXPECT_FALSE(parsed("QJ").is_merged);
  EXPECT_EQ(parsed("QJ").joggle, 0.0);
  EXPECT_TRUE(parsed("QJ1e-6 C0.1").is_merged);
}

TEST(QhullOptions, VStandsForWOfTwiceItsSize) {
  EXPECT_EQ(parsed("V1e-3").outside_width, 2e-3);
  EXPECT_EQ(parsed("V1e-3 W5e-2").outside_width, 5e-2);
  EXPECT_EQ(parsed("U1e-3").outside_width, std::nullopt);
  EXPECT_EQ(parsed("U1e-3").coplanar_depth, 1e-3);
}

TEST(QhullOptions, OptionsThatOnlySteerQhullChangeNothing) {
  QhullCommand plain = parsed(""), steered = parsed("E1e-9 Qxfgmrsvw Q1 Q2 Q12 Q14 Po Tacf _max-width");
  EXPECT_EQ(steered.outside_width, plain.outside_width);
  EXPECT_EQ(steered.is_merged, plain.is_merged);
  EXPECT_TRUE(steered.formats.empty());
  EXPECT_FALSE(steered.verify);
}

TEST(QhullOptions, PathsMayBeQuoted) {
  const QhullCommand command = parsed("TI 'a b.txt' TO c.txt s");
  EXPECT_EQ(command.input_path, "a b.txt");
  EXPECT_EQ(command.output_path, "c.txt");
  EXPECT_TRUE(command.has_summary);
}

TEST(QhullOptions, WhatCannotBeHonouredNamesWhatCan) {
  const auto names = [](const char* options, const char* nearest) {
    const std::string message = refusal(options);
    EXPECT_NE(message.find(nearest), std::string::npos) << options << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  };
  names("d Qt", "PDk:0");
  names("v", "lift");
  names("R1e-3", "QJ");
  names("Fp", "qhalf");
  names("H0,0", "qhalf");
  names("Gv", "ndhull view");
  names("FF", "--facet-list");
  names("QR3", "QR-n");
  names("QV0", "FN");
  names("QG0", "ndhull contains");
  names("TA5", "--max-facets");
  names("T4", "TFn");
  names("TR5", "QJ");
  names("Qt C0.1", "Ft");
  for (const char* options :
       {"Z9",    "Fz",  "Q18", "Q123", "W",     "Wx", "W-1", "C", "A2", "PA0",  "PAx", "PdX",
        "Pd0:2", "QbX", "TF",  "TI",   "TO ''", "F",  "P",   "Q", "T",  "1e-2", "QJ-1"}) {
    EXPECT_FALSE(refusal(options).empty()) << options;
  }
}

TEST(QhalfOptions, InteriorPointAndFormats) {
  const QhullCommand command = parse_qhull_command("H0,-.5,1e-1 Fp FxN", QhullProgram::kQhalf);
  EXPECT_EQ(command.interior_point, (std::vector<double>{0.0, -0.5, 0.1}));
  EXPECT_EQ(command.formats, (std::vector<std::string>{"Fp", "Fx", "FN"}));
  for (const char* options :
       {"n", "FS", "Fa", "FV", "FA", "Ft", "PA3", "FD", "C0.1", "W1e-2", "QJ", "Qt", "QbB", "H0;1"}) {
    EXPECT_FALSE(refusal(options, QhullProgram::kQhalf).empty()) << options;
  }
}

class Scaling : public ::testing::Test {
 protected:
  /// Columns 0 .. 4, 10 .. 14 and 5.
  PointSet scaled(const char* options) const { return scaled_points(points_.view(), parsed(options)); }
  PointSet points_{3, {0, 10, 5, 1, 12, 5, 4, 14, 5}, ""};
};

TEST_F(Scaling, BoundsAreMetExactly) {
  const PointSet points = scaled("Qb0:-1B0:1 Qb1:0 Qb2:0B2:0");
  EXPECT_EQ(points.dimension, 2U);
  EXPECT_EQ(points.coordinates, (std::vector<double>{-1, 0, -0.5, 7, 1, 14}));
}

TEST_F(Scaling, UnitCubeAndLastCoordinate) {
  EXPECT_EQ(scaled("QbB Qb2:0B2:0").coordinates, (std::vector<double>{-0.5, -0.5, -0.25, 0, 0.5, 0.5}));
  EXPECT_EQ(scaled("Qbb Qb2:0B2:0").coordinates, (std::vector<double>{0, 0, 1, 2, 4, 4}));
}

TEST_F(Scaling, WhatCannotBeScaledIsRefused) {
  for (const char* options : {"QbB", "Qb3:0", "Qb0:1B0:-1", "Qb0:0B0:0 Qb1:0B1:0 Qb2:0B2:0"}) {
    EXPECT_THROW(scaled(options), Error) << options;
  }
}

}  // namespace
}  // namespace ndhull
