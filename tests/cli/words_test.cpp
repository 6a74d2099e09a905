// The words of a command line that the program reads itself.
#include <gtest/gtest.h>

#include "core/error.h"
#include "tools/command_line/byte_count.h"
#include "tools/command_line/progress_line.h"
#include "tools/hull_command.h"

namespace ndhull {
namespace {

using Words = std::vector<std::string>;

TEST(ByteCountExample, UnitsArePowersOf1024) {
  EXPECT_EQ(parse_byte_count("65536", "--max-memory"), 65536U);
  EXPECT_EQ(parse_byte_count("64k", "--max-memory"), 65536U);
  EXPECT_EQ(parse_byte_count("512M", "--max-memory"), std::uint64_t{512} << 20);
  EXPECT_EQ(parse_byte_count("4G", "--max-memory"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_byte_count("4GB", "--max-memory"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_byte_count("1.5GiB", "--max-memory"), std::uint64_t{3} << 29);
  EXPECT_EQ(parse_byte_count("1T", "--max-memory"), std::uint64_t{1} << 40);
  EXPECT_EQ(parse_byte_count("7B", "--max-memory"), 7U);
}

TEST(ByteCountExample, WhatIsNoAmountIsRefused) {
  for (const char* const text :
       {"", "G", "0", "0.5", "-1G", "4X", "4GiBs", "4BB", "nan", "1e30", "4 G", "9999999T"}) {
    EXPECT_THROW(parse_byte_count(text, "--max-memory"), Error) << text;
  }
}

TEST(ByteCountExample, AmountsAreWrittenInTwoOrThreeDigits) {
  EXPECT_EQ(format_byte_count(0), "0 B");
  EXPECT_EQ(format_byte_count(999), "999 B");
  EXPECT_EQ(format_byte_count(1000), "0.977 KB");
  EXPECT_EQ(format_byte_count(std::uint64_t{3} << 29), "1.5 GB");
}

TEST(VerifyModeExample, OnlyTheWordAfterVerifyIsItsMode) {
  EXPECT_EQ(join_verify_mode({"hull", "--verify", "p.npy"}), (Words{"hull", "--verify=floating", "p.npy"}));
  EXPECT_EQ(join_verify_mode({"hull", "p.npy", "--verify"}), (Words{"hull", "p.npy", "--verify=floating"}));
  EXPECT_EQ(join_verify_mode({"hull", "--verify", "exact", "p"}), (Words{"hull", "--verify=exact", "p"}));
  EXPECT_EQ(join_verify_mode({"hull", "exact"}), (Words{"hull", "exact"}));
  EXPECT_EQ(join_verify_mode({"verify", "exact", "exact"}), (Words{"verify", "exact", "exact"}));
  EXPECT_EQ(join_verify_mode({}), Words{});
}

TEST(ProgressExample, ALineNamesEveryNumber) {
  EXPECT_EQ(describe(Progress{.phase = Phase::kGrowth,
                              .points_left = 12,
                              .simplices = 345,
                              .furthest_gauge = 0.25,
                              .elapsed_seconds = 1.5,
                              .memory_bytes = std::uint64_t{2} << 30}),
            "growth: 12 points left, 345 simplices, furthest 2.5e-01, 1.5 s, 2 GB");
}

TEST(ProgressExample, TwoLooksTellRatesAndAGuess) {
  const Progress before{.points_left = 100, .simplices = 1000, .elapsed_seconds = 1.0};
  Progress now{.points_left = 80, .simplices = 5000, .furthest_gauge = 0.25, .elapsed_seconds = 3.0};
  const ProgressRates rates = rates_between(before, now);
  EXPECT_EQ(rates.simplices_per_second, 2000.0);
  EXPECT_EQ(rates.seconds_left, 8.0);
  EXPECT_EQ(
      describe(now, rates),
      "growth: 80 points left, 5000 simplices (+2e+03/s), furthest 2.5e-01, 3.0 s (about 8 s left), 0 B");
  now.phase = Phase::kCertify;  // another phase has another pace
  EXPECT_EQ(rates_between(before, now).seconds_left, 0.0);
}

}  // namespace
}  // namespace ndhull
