#include "tools/io/text_source.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

namespace ndhull {
namespace {

/// The word at `place`. A decimal comma is part of it, a separator is not.
std::string word_at(const char* place, const char* end, bool with_comma) {
  const char* stop = place;
  while (stop != end && !is_blank(*stop) && *stop != '\n' && (with_comma || (*stop != ',' && *stop != ';')))
    ++stop;
  return printable(std::string_view(place, static_cast<std::size_t>(stop - place)));
}

/// Digits that stand for a number no double can hold.
bool overflows(const char* place, const char* end) {
  if (place != end && (*place == '+' || *place == '-')) ++place;
  double value = 0.0;
  return place != end && (is_digit(*place) || *place == '.') &&
         fast_float::from_chars(place, end, value).ec != std::errc::invalid_argument && std::isinf(value);
}

}  // namespace

const char* TextSource::line_end(const char* place) const {
  const auto left = static_cast<std::size_t>(end() - place);
  const void* newline = left == 0 ? nullptr : std::memchr(place, '\n', left);
  return newline == nullptr ? end() : static_cast<const char*>(newline);
}

std::size_t TextSource::line_of(const char* place) const {
  return static_cast<std::size_t>(std::count(begin(), place, '\n')) + 1;
}

void TextSource::fail(ErrorCode code, const char* place, const std::string& message) const {
  throw Error(code, fmt::format("{}, line {}: {}", name_, line_of(place), message));
}

void TextSource::fail_number(const char* place, std::size_t column) const {
  double value = 0.0;
  const char* const stop = place == end() ? nullptr : parse_number(place, end(), value);
  const bool decimal_comma = stop != nullptr && stop != end() && *stop == ',';
  const std::string word = word_at(place, end(), decimal_comma);
  if (names_non_finite(word) || overflows(place, end())) {
    fail(ErrorCode::kNotFinite, place,
         fmt::format("column {}: found {}, expected a finite number; remove the row or replace the value",
                     column, word));
  }
  if (word.empty()) {
    fail(ErrorCode::kBadNumber, place,
         fmt::format("column {}: found nothing, expected a number; fill in the value or remove the row",
                     column));
  }
  if (names_missing_value(word)) {
    fail(ErrorCode::kBadNumber, place,
         fmt::format("column {}: found \"{}\", expected a number; fill in the value or remove the row",
                     column, word));
  }
  fail(ErrorCode::kBadNumber, place,
       fmt::format("column {}: found \"{}\", expected a number; {}", column, word,
                   decimal_comma ? "write a decimal point, and one separator in all lines"
                                 : "correct it, or put # before text that is a comment"));
}

void TextSource::require_content() const {
  if (std::all_of(begin(), end(), [](char letter) { return is_blank(letter) || letter == '\n'; })) {
    throw Error(ErrorCode::kEmptyInput,
                fmt::format("{}: found an empty file, expected numbers; check what wrote it", name_));
  }
}

bool names_non_finite(std::string_view text) {
  std::string word;
  for (const char letter : text) {
    if (letter == '"' || letter == '+' || letter == '-') continue;
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  // nan(0x1) shows the payload; 1.#INF and 1.#QNAN is how older C libraries print.
  return word == "nan" || word.starts_with("nan(") || word == "inf" || word == "infinity" ||
         word.starts_with("1.#in") || word.starts_with("1.#qnan") || word.starts_with("1.#snan");
}

bool names_missing_value(std::string_view text) {
  std::string word;
  for (const char letter : text) word += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  constexpr std::string_view kSpellings[] = {"na",   "n/a", "#n/a", "<na>", "null",
                                             "none", "nil", ".",    "-",    "?"};
  return std::find(std::begin(kSpellings), std::end(kSpellings), word) != std::end(kSpellings);
}

bool begins_like_number(const char* place, const char* end) {
  const char* word_end = place;
  while (word_end != end && !is_blank(*word_end)) ++word_end;
  if (names_non_finite({place, static_cast<std::size_t>(word_end - place)})) return true;
  const char* at = place;
  if (at != word_end && *at == '"') ++at;
  if (at == word_end) return false;
  // "33 ,28" is a row of a table, whatever stands behind the comma.
  if (*at == ',' || *at == ';' || is_digit(*at)) return true;
  if (*at != '-' && *at != '+' && *at != '.') return false;
  ++at;
  return at == word_end || is_digit(*at) || *at == '.';
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 40;  // a message is one line
  std::string shown(text.substr(0, kLongest));
  for (char& letter : shown) {
    if (std::isprint(static_cast<unsigned char>(letter)) == 0) letter = '?';
  }
  return text.size() > kLongest ? shown + "..." : shown;
}

const char* parse_number(const char* place, const char* end, double& value) {
  // fast_float follows std::from_chars, which takes no plus sign.
  if (place != end && *place == '+' && place + 1 != end && (is_digit(place[1]) || place[1] == '.')) ++place;
  const auto result = fast_float::from_chars(place, end, value);
  // Underflow to zero or a denormal is rounding; overflow gives infinity, whatever the error code says.
  if (result.ec == std::errc::invalid_argument || !std::isfinite(value)) return nullptr;
  return result.ptr;
}

const char* parse_count(const char* place, const char* end, std::size_t& value) {
  const auto [stop, error] = std::from_chars(place, end, value);
  return error == std::errc{} ? stop : nullptr;
}

std::size_t read_number_line(const TextSource& source, const char*& place, std::vector<double>& values,
                             const char** comment) {
  const char* const end = source.line_end(place);
  std::size_t count = 0;
  const char* at = skip_blanks(place, end);
  while (at != end && *at != '#') {
    double value = 0.0;
    const char* stop = parse_number(at, end, value);
    if (stop == nullptr || (stop != end && !is_blank(*stop))) {
      if (comment == nullptr || begins_like_number(at, end)) source.fail_number(at, count + 1);
      *comment = at;
      break;
    }
    values.push_back(value);
    ++count;
    at = skip_blanks(stop, end);
  }
  place = end == source.end() ? end : end + 1;
  return count;
}

}  // namespace ndhull
