// A header of two integers is also how a table of integers may begin. The lines decide: Qhull's integers
// stand alone on their lines, or the numbers that follow are as many as they announce. As for Qhull, a word
// that begins like no number makes the rest of its line a comment: only the count tells that none is missing.
#include "tools/io/qhull_text_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace ndhull {
namespace {

/// An integer that is a word of its own at `at`, which moves behind it.
std::optional<std::size_t> take_integer(const char*& at, const char* end) {
  std::size_t value = 0;
  const char* const stop = parse_count(at, end, value);
  if (stop == nullptr || (stop != end && !is_blank(*stop))) return std::nullopt;
  at = skip_blanks(stop, end);
  return value;
}

/// The leading integers of a line and whether other text stands behind them.
struct IntegerLine {
  std::size_t count = 0;  // 0, 1, 2, or 3 for "more"
  std::size_t value[2] = {};
  bool has_text = false;        // something that is not an unsigned integer follows
  bool text_is_number = false;  // and it begins like a number
  const char* next = nullptr;   // the line after it
};

IntegerLine read_integer_line(const TextSource& source, const char* place) {
  IntegerLine line;
  const char* const end = source.line_end(place);
  const char* at = skip_blanks(place, end);
  while (at != end && *at != '#') {
    const std::optional<std::size_t> value = take_integer(at, end);
    if (!value) {
      line.has_text = true;
      line.text_is_number = begins_like_number(at, end);
      break;
    }
    if (line.count < 2) line.value[line.count] = *value;
    line.count = std::min<std::size_t>(line.count + 1, 3);
  }
  line.next = end == source.end() ? end : end + 1;
  return line;
}

/// Numbers separated by blanks behind `place`, unread.
std::size_t count_words(const TextSource& source, const char* place) {
  std::size_t words = 0;
  while (place != source.end()) {
    const char* const end = source.line_end(place);
    for (const char* at = skip_blanks(place, end); at != end && *at != '#'; at = skip_blanks(at, end)) {
      if (!begins_like_number(at, end)) break;
      ++words;
      while (at != end && !is_blank(*at)) ++at;
    }
    place = end == source.end() ? end : end + 1;
  }
  return words;
}

/// Lines of text before a header, which could also be the names of a table's columns.
struct Preface {
  std::size_t lines = 0;
  std::size_t words = 0;  ///< of its last line
};

Preface read_preface(const TextSource& source, const char* header) {
  Preface preface;
  for (const char* at = source.begin(); (at = skip_empty_lines(source, at)) != header;) {
    const char* const end = source.line_end(at);
    ++preface.lines;
    preface.words = 0;
    for (at = skip_blanks(at, end); at != end; at = skip_blanks(at, end)) {
      ++preface.words;
      while (at != end && !is_blank(*at)) ++at;
    }
    if (end != source.end()) at = end + 1;
  }
  return preface;
}

/// Numbers of the first line behind `place` that has some.
std::size_t first_length(const TextSource& source, const char* place) {
  place = skip_comment_lines(source, place);
  return count_words(
      TextSource(source.name(), {place, static_cast<std::size_t>(source.line_end(place) - place)}), place);
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
  std::size_t comment_lines = 0;
  std::size_t first_length = 0;
  bool uniform = true;
};

/// The first line of coordinates with another number of them than `columns`.
struct OddLine {
  const char* place = nullptr;
  std::size_t length = 0;
  const char* text = nullptr;  ///< the comment in it
};

OddLine find_odd_line(const TextSource& source, const char* place, std::size_t columns) {
  std::vector<double> values;
  while ((place = skip_comment_lines(source, place)) != source.end()) {
    OddLine line{.place = place};
    values.clear();
    line.length = read_number_line(source, place, values, &line.text);
    if (line.length != columns) return line;
  }
  return {};
}

/// The first line that is a comment and no empty one.
const char* find_comment_line(const TextSource& source, const char* place) {
  while ((place = skip_empty_lines(source, place)) != source.end()) {
    const char* const end = source.line_end(place);
    const char* const text = skip_blanks(place, end);
    if (!begins_like_number(text, end)) return text;
    place = end == source.end() ? end : end + 1;
  }
  return nullptr;
}

[[noreturn]] void fail_count(const TextSource& source, const char* data, const LineShape& shape,
                             std::size_t dimension, std::size_t count, std::size_t found) {
  const OddLine odd = find_odd_line(source, data, dimension);
  // The comment may have been meant as a number.
  if (odd.text != nullptr) source.fail_number(odd.text, odd.length + 1);
  if (shape.comment_lines > 0 && shape.lines + shape.comment_lines == count && found < dimension * count)
    source.fail_number(find_comment_line(source, data), 1);
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

const char* skip_comment_lines(const TextSource& source, const char* place) {
  while ((place = skip_empty_lines(source, place)) != source.end()) {
    const char* const end = source.line_end(place);
    if (begins_like_number(skip_blanks(place, end), end)) return place;
    place = end == source.end() ? end : end + 1;
  }
  return place;
}

QhullHeader read_qhull_header(const TextSource& source) {
  QhullHeader header;
  header.place = skip_comment_lines(source, source.begin());
  const char* end = source.line_end(header.place);
  const char* at = skip_blanks(header.place, end);
  header.dimension = take_integer(at, end);
  if (!header.dimension) return header;
  if (!begins_like_number(at, end)) {
    at = skip_comment_lines(source, end == source.end() ? end : end + 1);
    end = source.line_end(at);
    at = skip_blanks(at, end);
  }
  const char* const second = at;
  header.count = take_integer(at, end);
  if (!header.count) {
    header.place = second;
    return header;
  }
  header.data = begins_like_number(at, end) || end == source.end() ? at : end + 1;
  return header;
}

bool looks_like_qhull_text(const TextSource& source) {
  const char* const start = skip_comment_lines(source, source.begin());
  if (start == source.end()) return false;
  const Preface preface = read_preface(source, start);
  const IntegerLine first = read_integer_line(source, start);
  if (first.text_is_number) return false;
  const auto is_announced = [&source](std::size_t dimension, std::size_t count, const char* data) {
    const auto announced = product(dimension, count);
    return announced.has_value() && *announced > 0 && *announced == count_words(source, data);
  };
  if (first.count == 1) {
    if (first.has_text && preface.lines == 0) return true;  // "5 rbox 1000 D5"
    const char* const below = skip_empty_lines(source, first.next);
    const char* const second_start = skip_comment_lines(source, below);
    // A dimension and no more: the reader says what is missing.
    if (second_start == source.end()) return preface.lines == 0 && below == second_start;
    const IntegerLine second = read_integer_line(source, second_start);
    if (second.count != 1 || second.text_is_number) return false;
    if (preface.lines == 0 && below == second_start) return true;
    // Text may also be what a table has in another column, or the name of its only one.
    const std::size_t length = first_length(source, second.next);
    if (preface.lines == 1 && preface.words == 1 && length <= 1) return false;
    const bool alone = !first.has_text && !second.has_text;
    return (alone && length > 1) || is_announced(first.value[0], second.value[0], second.next);
  }
  if (first.count != 2) return false;
  if (preface.lines == 0) return first.has_text || is_announced(first.value[0], first.value[1], first.next);
  const bool is_table = preface.lines == 1 && preface.words == 2 && first_length(source, first.next) == 2;
  return !is_table && !first.has_text && is_announced(first.value[0], first.value[1], first.next);
}

NumberTable read_qhull_text(const TextSource& source, bool may_be_empty) {
  source.require_content();
  const QhullHeader header = read_qhull_header(source);
  const char* const start = header.place;
  if (!header.dimension) {
    source.fail(ErrorCode::kBadHeader, start,
                "found no dimension, expected an integer; begin with lines for the dimension and the number "
                "of points");
  }
  if (!header.count) {
    source.fail(ErrorCode::kBadHeader, start,
                fmt::format("found {}, expected the number of points; insert it behind the dimension",
                            start == source.end() ? "the end of the file" : "no integer"));
  }
  std::size_t dimension = *header.dimension, count = *header.count;
  if (dimension == 0) {
    source.fail(ErrorCode::kDimensionTooLow, start,
                "found dimension 0, expected 1 or more; correct the header");
  }
  if (count == 0 && !may_be_empty)
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
  table.values.reserve(std::min(*announced, static_cast<std::size_t>(source.end() - header.data) / 2 + 1));
  LineShape shape;
  for (const char* place = header.data; (place = skip_empty_lines(source, place)) != source.end();) {
    const char* comment = nullptr;
    const std::size_t length = read_number_line(source, place, table.values, &comment);
    if (length == 0 && comment != nullptr) {
      ++shape.comment_lines;
      continue;
    }
    if (shape.lines++ == 0) shape.first_length = length;
    shape.uniform = shape.uniform && length == shape.first_length;
  }
  // Only a first number that is the larger one may be the count: points are more than their dimension, and
  // lines of as many numbers as there are points may be points wrapped.
  const bool swapped = shape.uniform && shape.lines > 0 && shape.first_length == count && count < dimension &&
                       shape.lines == dimension;
  if (swapped) std::swap(dimension, count);
  if (table.values.size() != *announced)
    fail_count(source, header.data, shape, dimension, count, table.values.size());
  table.rows = count;
  table.columns = dimension;
  return table;
}

}  // namespace ndhull
