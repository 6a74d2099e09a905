#include "tools/points/rbox.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "core/error.h"
#include "tests/points/rbox_golden.h"

namespace ndhull {
namespace {

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

// Standard output of a shell command.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char buffer[4096];
  for (std::size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, got);
  pclose(pipe);
  return text;
}

void expect_usage_error(const std::string& arguments, const std::string& part) {
  SCOPED_TRACE(arguments);
  try {
    rbox(arguments);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUsage);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(RboxGoldenText, IsWhatTheProgramPrints) {
  ASSERT_GE(std::size(kRboxGolden), 60U);
  for (const RboxGolden& golden : kRboxGolden) {
    SCOPED_TRACE(golden.arguments);
    const std::string text = rbox_text(golden.arguments);
    EXPECT_EQ(text.size(), golden.length);
    EXPECT_EQ(fnv1a(text), golden.hash);
  }
}

TEST(RboxOracle, PrintsTheSameBytesAsTheInstalledProgram) {
  if (!std::filesystem::exists("/usr/bin/rbox")) GTEST_SKIP() << "no program rbox here";
  for (const RboxGolden& golden : kRboxGolden) {
    EXPECT_EQ(rbox_text(golden.arguments), output_of(std::string("/usr/bin/rbox ") + golden.arguments))
        << golden.arguments;
  }
  for (const char* const large :
       {"20000 s D5 t1", "20000 x D6 t5", "20000 L3 s G0.1 W.2 D5 B2.3", "20000 W0 D8",
        "20000 Z0.3 G0.5 s D5 t1", "3001 r B0.7", "3001 l B3.3", "20000 M3,4 D6 z"}) {
    EXPECT_TRUE(rbox_text(large) == output_of(std::string("/usr/bin/rbox ") + large)) << large;
  }
}

TEST(RboxLaw, PointsAreThoseThatAReaderOfTheTextGets) {
  for (const RboxGolden& golden : kRboxGolden) {
    SCOPED_TRACE(golden.arguments);
    const PointSet points = rbox(golden.arguments);
    std::istringstream text(rbox_text(golden.arguments));
    std::string line;
    std::getline(text, line);
    std::getline(text, line);
    const bool is_cdd = line == "begin";
    if (is_cdd) std::getline(text, line);
    EXPECT_EQ(std::stoul(line), points.rows());
    for (std::size_t row = 0; row < points.rows(); ++row) {
      std::string word;
      if (is_cdd) text >> word;
      for (const double value : points.row(row)) {
        text >> word;
        EXPECT_EQ(value, std::strtod(word.c_str(), nullptr));
      }
    }
  }
}

TEST(RboxExample, HeaderIsTheCommandWithSingleBlanks) {
  const PointSet points = rbox("  10   s  D3 ");
  EXPECT_EQ(points.header, "rbox 10 s D3");
  EXPECT_EQ(points.dimension, 3U);
  EXPECT_EQ(points.rows(), 10U);
  EXPECT_EQ(points.view().rows, 10U);
  EXPECT_EQ(rbox("10 s D3 n").header, "");
}

TEST(RboxExample, XAndYMakeTheSamePoints) {
  const PointSet inside = rbox("30 x D4");
  const PointSet both = rbox("30 y D4");
  ASSERT_EQ(both.rows(), inside.rows() + 5);
  EXPECT_TRUE(
      std::equal(inside.coordinates.begin(), inside.coordinates.end(), both.coordinates.begin() + 20));
}

TEST(RboxExample, TimeAsSeedIsToldInTheHeaderAndRepeatsThePoints) {
  const PointSet first = rbox("t 5 D2");
  ASSERT_EQ(first.header.rfind("rbox 5 D2 t", 0), 0U) << first.header;
  EXPECT_EQ(rbox(first.header.substr(5)).coordinates, first.coordinates);
}

TEST(RboxErrors, NameTheArgument) {
  expect_usage_error("3 q", "'q'");
  expect_usage_error("s", "number of points");
  expect_usage_error("c s", "number of points");
  expect_usage_error("3sD2", "'D2'");
  expect_usage_error("10.5", "'.5'");
  expect_usage_error("1e2 D2", "'e2 D2'");
  expect_usage_error("3 W1e-2,3", "',3'");
  expect_usage_error("5 D201", "201");
  expect_usage_error("5 D0", "0");
  expect_usage_error("5 L2 Z1", "'Ln'");
  expect_usage_error("5 L1", "'Ln'");
  expect_usage_error("5 x s", "'x'");
  expect_usage_error("5 r D4", "'r'");
  expect_usage_error("5 l D4", "'l'");
  expect_usage_error("5 r C2", "'Cn,r,m'");
  expect_usage_error("5 C0", "'Cn,r,m'");
  expect_usage_error("5 C2,.1,6", "'Cn,r,m'");
  expect_usage_error("c C1", "'Cn,r,m'");
  expect_usage_error("P1,2,3 D2", "'Pn,m,..'");
  expect_usage_error("P1,a", "'a'");
  expect_usage_error("5 z B1e12", "'z'");
}

TEST(RboxErrors, WhatIsNotReproducedIsRefused) {
  expect_usage_error("D4", "self-test");
  expect_usage_error("P 5", "'P'");
  expect_usage_error("P1, 2", "'Pn,m,..'");
  expect_usage_error("5 M D2", "'M'");
  expect_usage_error("5 M3,", "'Mn,m,r'");
  expect_usage_error("5 M3,4 r", "'r'");
  expect_usage_error("5 l Z", "'Zn'");
  expect_usage_error("5 y s", "'y'");
  expect_usage_error("5 x y", "'y'");
  expect_usage_error("1 l", "'l'");
  expect_usage_error("1 r L3 D2", "lens");
  expect_usage_error("5 L2 D1", "'Ln'");
  expect_usage_error("\"10 s\"", "quoted");
  expect_usage_error("3000000000", "2147483647");
  expect_usage_error("99999999999999999999", "out of range");
  expect_usage_error("5 t3000000000", "'tn'");
  expect_usage_error("5 t t", "'t'");
  expect_usage_error("5 Binf", "finite");
  expect_usage_error("5 O0." + std::string(200, '0'), "180");
  expect_usage_error("c D27", "2^26");
}

}  // namespace
}  // namespace ndhull
