// A header of two integers is also how a table of integers may begin. The lines decide: Qhull's integers
// stand alone on their lines, or the numbers that follow are as many as they announce.
#include "tools/io/qhull_text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace ndhull {
namespace {

/// Numbers separated by blanks behind `place`, unread.
std::size_t count_words(const TextSource& source, const char* place) {
  std::size_t words = 0;
  while (place != source.end()) {
    const char* const end = source.line_end(place);
    for (const char* at = skip_blanks(place, end); at != end && *at != '#'; at = skip_blanks(at, end)) {
      ++words;
      while (at != end && !is_blank(*at)) ++at;
    }
    place = end == source.end() ? end : end + 1;
  }
  return words;
}

std::optional<std::size_t> product(std::size_t a, std::size_t b) {
  std::size_t result = 0;
  if (__builtin_mul_overflow(a, b, &result)) return std::nullopt;
  return result;
}

/// What the lines of coordinates look like: they say which header number is the dimension, and where a
/// number is missing.
struct LineShape {
  std::size_t lines = 0;
  std::size_t first_length = 0;
  bool uniform = true;
};

/// The first line of coordinates with another number of them than `columns`.
struct OddLine {
  const char* place = nullptr;
  std::size_t length = 0;
};

OddLine find_odd_line(const TextSource& source, const char* place, std::size_t columns) {
  std::vector<double> values;
  while ((place = skip_empty_lines(source, place)) != source.end()) {
    const char* const line = place;
    values.clear();
    const std::size_t length = read_number_line(source, place, values);
    if (length != columns) return {line, length};
  }
  return {};
}

[[noreturn]] void fail_count(const TextSource& source, const char* data, const LineShape& shape,
                             std::size_t dimension, std::size_t count, std::size_t found) {
  const OddLine odd = find_odd_line(source, data, dimension);
  if (odd.place != nullptr && shape.lines == count) {
    source.fail(
        ErrorCode::kRaggedRow, odd.place,
        fmt::format(
            "found {} columns, expected {} as the header says; complete the row or correct the header",
            odd.length, dimension));
  }
  throw Error(
      ErrorCode::kWrongCount,
      fmt::format("{}, line {}: found {} numbers, expected {} x {} = {} as the header says; {}",
                  source.name(), source.line_of(source.end()), found, count, dimension, count * dimension,
                  found < count * dimension ? "append the missing points or correct the count"
                                            : "correct the count or remove the surplus"));
}

}  // namespace

const char* skip_empty_lines(const TextSource& source, const char* place) {
  while (place != source.end()) {
    const char* const end = source.line_end(place);
    const char* const text = skip_blanks(place, end);
    if (text != end && *text != '#') return place;
    place = end == source.end() ? end : end + 1;
  }
  return place;
}

IntegerLine read_integer_line(const TextSource& source, const char* place) {
  IntegerLine line;
  const char* const end = source.line_end(place);
  const char* at = skip_blanks(place, end);
  while (at != end && *at != '#') {
    std::size_t value = 0;
    const char* const stop = parse_count(at, end, value);
    if (stop == nullptr || (stop != end && !is_blank(*stop))) {
      line.has_text = true;
      const char* word_end = at;
      while (word_end != end && !is_blank(*word_end)) ++word_end;
      // "33 ,28" is a row of a table, whatever stands behind the comma.
      const bool separates = *at == ',' || *at == ';';
      line.text_is_number = separates || is_digit(*at) || *at == '-' || *at == '+' || *at == '.' ||
                            names_non_finite({at, static_cast<std::size_t>(word_end - at)});
      break;
    }
    if (line.count < 2) line.value[line.count] = value;
    line.count = std::min<std::size_t>(line.count + 1, 3);
    at = skip_blanks(stop, end);
  }
  line.next = end == source.end() ? end : end + 1;
  return line;
}

bool looks_like_qhull_text(const TextSource& source) {
  const char* const start = skip_empty_lines(source, source.begin());
  if (start == source.end()) return false;
  const IntegerLine first = read_integer_line(source, start);
  if (first.text_is_number) return false;
  if (first.count == 1 && first.has_text) return true;  // "5 rbox 1000 D5"
  if (first.count == 1) {
    const char* const second_start = skip_empty_lines(source, first.next);
    if (second_start == source.end())
      return true;  // a dimension and no more: the reader says what is missing
    const IntegerLine second = read_integer_line(source, second_start);
    return second.count == 1 && !second.text_is_number;
  }
  if (first.count != 2) return false;
  if (first.has_text) return true;
  const auto announced = product(first.value[0], first.value[1]);
  return announced.has_value() && *announced > 0 && *announced == count_words(source, first.next);
}

NumberTable read_qhull_text(const TextSource& source) {
  source.require_content();
  const char* const start = skip_empty_lines(source, source.begin());
  const IntegerLine first = read_integer_line(source, start);
  if (first.count == 0) {
    source.fail(ErrorCode::kBadHeader, start,
                "found no dimension, expected an integer; begin with lines for the dimension and the number "
                "of points");
  }
  std::size_t dimension = first.value[0];
  std::size_t count = first.value[1];
  const char* data = first.next;
  if (first.count == 1) {
    const char* const second_start = skip_empty_lines(source, data);
    const IntegerLine second = read_integer_line(source, second_start);
    if (second.count != 1) {
      source.fail(ErrorCode::kBadHeader, second_start,
                  fmt::format("found {}, expected the number of points alone on its line; insert it",
                              second_start == source.end() ? "the end of the file" : "no integer"));
    }
    count = second.value[0];
    data = second.next;
  }
  if (dimension == 0) {
    source.fail(ErrorCode::kDimensionTooLow, start,
                "found dimension 0, expected 1 or more; correct the header");
  }
  if (count == 0)
    source.fail(ErrorCode::kEmptyInput, start, "found 0 points, expected 1 or more; correct the count");
  const auto announced = product(dimension, count);
  if (!announced) {
    source.fail(
        ErrorCode::kBadHeader, start,
        fmt::format(
            "found {} points in dimension {}, expected a number that fits in memory; correct the header",
            count, dimension));
  }

  NumberTable table;
  // A number takes two characters at least: a wrong header reserves no more than the file can hold.
  table.values.reserve(std::min(*announced, static_cast<std::size_t>(source.end() - data) / 2 + 1));
  LineShape shape;
  for (const char* place = data; (place = skip_empty_lines(source, place)) != source.end();) {
    const std::size_t length = read_number_line(source, place, table.values);
    if (shape.lines++ == 0) shape.first_length = length;
    shape.uniform = shape.uniform && length == shape.first_length;
  }
  // Only a first number that is the larger one may be the count: points are more than their dimension, and
  // lines of as many numbers as there are points may be points wrapped.
  const bool swapped = shape.uniform && shape.lines > 0 && shape.first_length == count && count < dimension &&
                       shape.lines == dimension;
  if (swapped) std::swap(dimension, count);
  if (table.values.size() != *announced)
    fail_count(source, data, shape, dimension, count, table.values.size());
  table.rows = count;
  table.columns = dimension;
  return table;
}

}  // namespace ndhull
