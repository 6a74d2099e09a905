// Three kinds of trouble have three mechanisms. Bad input throws Error with a code and the numbers; a
// limit reached or precision lost is a success with the fact in the result; our own bug is
// NDHULL_CHECK, which stops at once with the place and the condition.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace ndhull {

/// What was wrong with the input or the request. `to_string` gives the short code that the one-line
/// message of the command line program starts with.
enum class ErrorCode {
  kUsage,             ///< an option or argument that cannot be honoured
  kFileMissing,       ///< the file cannot be opened
  kFileWrite,         ///< a result cannot be written; nothing was left behind
  kEmptyInput,        ///< no points at all
  kBadHeader,         ///< the header of a format is not what the format says
  kBadNumber,         ///< text where a number is expected
  kNotFinite,         ///< NaN or infinity
  kOutOfRange,        ///< numbers so large or small that results would be no doubles
  kRaggedRow,         ///< a row with another number of columns than the first
  kWrongCount,        ///< fewer or more rows than announced
  kTruncated,         ///< a binary file that ends early
  kUnknownType,       ///< a binary element type that is not read
  kDimensionTooLow,   ///< dimension 0
  kDimensionTooHigh,  ///< the affine rank is above kMaxRank, kMaxRayRank or kMaxExtremeRank
  kTooManyPoints,     ///< more rows than 32-bit ids can number
  kTooManySimplices,  ///< a hull that was found without its simplices has too many to list
  kBadHalfspace,      ///< a zero normal, a point that is not inside, or planes that doubles do not tell apart
};

std::string_view to_string(ErrorCode code);

/// Bad input. what() is one line: place, what was found, what was expected, and one way to mend it.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// Prints the failed condition to standard error and aborts. Never returns.
[[noreturn]] void check_failed(const char* file, int line, const char* condition);

}  // namespace ndhull

#define NDHULL_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::ndhull::check_failed(__FILE__, __LINE__, #condition))
