#include "core/error.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace ndhull {
namespace {

constexpr ErrorCode kLastCode = ErrorCode::kBadHalfspace;

TEST(ErrorLaw, EveryCodeHasItsOwnShortName) {
  std::set<std::string_view> names;
  for (int code = 0; code <= static_cast<int>(kLastCode); ++code) {
    names.insert(to_string(static_cast<ErrorCode>(code)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kLastCode) + 1);
  EXPECT_EQ(names.count("unknown"), 0u);
}

TEST(ErrorExample, CarriesCodeAndMessage) {
  const Error error(ErrorCode::kRaggedRow, "line 3: 4 columns, expected 5");
  EXPECT_EQ(error.code(), ErrorCode::kRaggedRow);
  EXPECT_STREQ(error.what(), "line 3: 4 columns, expected 5");
}

TEST(CheckDeathTest, AFailedCheckStopsWithPlaceAndCondition) {
  EXPECT_DEATH(NDHULL_CHECK(1 + 1 == 3), "error_test\\.cpp:[0-9]+: 1 \\+ 1 == 3");
}

}  // namespace
}  // namespace ndhull
