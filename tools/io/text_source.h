// Text that is being read: places for messages, and the one way text becomes a double.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace ndhull {

/// Numbers read from text: rows x columns, row after row.
struct NumberTable {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;
  std::vector<std::string> names;  ///< of the columns; empty without a header line
};

/// A text and the name it has in messages. A text that is not kept must outlive the source.
class TextSource {
 public:
  TextSource(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}
  TextSource(std::string name, std::shared_ptr<const std::string> kept)
      : name_(std::move(name)), kept_(std::move(kept)), text_(*kept_) {}

  const std::string& name() const { return name_; }
  const char* begin() const { return text_.data(); }
  const char* end() const { return text_.data() + text_.size(); }
  /// The end of the line that holds `place`: its newline, or the end of the text.
  const char* line_end(const char* place) const;
  /// 1-based. Counts from the start: cost O(text), for messages only.
  std::size_t line_of(const char* place) const;

  /// Throws Error "name, line L: message".
  [[noreturn]] void fail(ErrorCode code, const char* place, const std::string& message) const;
  /// Throws for the word at `place`, number `column` of its line: kNotFinite for a spelling of NaN or
  /// infinity, kBadNumber for anything else.
  [[noreturn]] void fail_number(const char* place, std::size_t column) const;
  /// Throws kEmptyInput when there is nothing but white space.
  void require_content() const;

 private:
  std::string name_;
  std::shared_ptr<const std::string> kept_;
  std::string_view text_;
};

inline bool is_blank(char letter) {
  return letter == ' ' || letter == '\t' || letter == '\r' || letter == '\f' || letter == '\v';
}
inline const char* skip_blanks(const char* place, const char* end) {
  while (place != end && is_blank(*place)) ++place;
  return place;
}
inline bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Is `text` a spelling of NaN or infinity (nan, -inf, Infinity, 1.#IND, ...), in quotes or not?
bool names_non_finite(std::string_view text);

/// Is `text` a spelling of a value that is missing (NA, n/a, null, none, a point, a dash, ...)?
bool names_missing_value(std::string_view text);

/// Is the word at `place` meant as a number, if perhaps a damaged one? Digits behind a quote, a sign or a
/// point, a lone sign, a separator, and the spellings of NaN and infinity are; other words are text.
bool begins_like_number(const char* place, const char* end);

/// `text` for a one-line message: cut at 40 characters, control characters as question marks.
std::string printable(std::string_view text);

/// Reads the number at `place`, correctly rounded.
///
/// Returns   the first character behind it, or null when there is no finite number (text, NaN, infinity,
///           beyond the range of double). What follows the number is the caller's to judge.
/// Source    fast_float: Lemire. Number parsing at a gigabyte per second. Softw. Pract. Exp. 51(8), 2021.
const char* parse_number(const char* place, const char* end, double& value);

/// Reads an unsigned integer: the first character behind it, or null when there is none or it overflows.
const char* parse_count(const char* place, const char* end, std::size_t& value);

/// Reads all blank-separated numbers of the line at `place` to the back of `values`; # starts a comment.
/// Returns how many; `place` moves to the start of the next line (or the end). With `comment`, so does a word
/// that begins like no number, and its place is put there; without, it is an error.
std::size_t read_number_line(const TextSource& source, const char*& place, std::vector<double>& values,
                             const char** comment = nullptr);

}  // namespace ndhull
