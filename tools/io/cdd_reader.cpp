// Line by line: comments and options up to `begin`, its header line, the entries up to `end`, options.
// Source: Fukuda. cddlib Reference Manual, section on polyhedra format; Avis. User's guide for lrs.
#include "tools/io/cdd_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/io/rational.h"

namespace ndhull {
namespace {

struct Line {
  const char* start = nullptr;
  const char* next = nullptr;
  std::string_view text;  // trimmed
};

Line line_at(const TextSource& source, const char* place) {
  const char* end = source.line_end(place);
  const char* const next = end == source.end() ? end : end + 1;
  const char* const text = skip_blanks(place, end);
  while (end != text && is_blank(end[-1])) --end;
  return {place, next, std::string_view(text, static_cast<std::size_t>(end - text))};
}

bool is_comment(std::string_view text) { return text.empty() || text[0] == '*' || text[0] == '#'; }

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || is_blank(text[word.size()]));
}

[[noreturn]] void fail_quotient(const TextSource& source, const char* at, std::size_t column) {
  source.fail(
      ErrorCode::kBadNumber, at,
      fmt::format("column {}: found a quotient that is not finite, expected p/q with q != 0; correct it",
                  column));
}

/// Reads p/q of whole numbers with more digits than doubles hold: these are divided first and rounded once.
/// Null for anything else.
const char* read_long_rational(const TextSource& source, const char* at, const char* end, std::size_t column,
                               double& value) {
  constexpr std::ptrdiff_t kDigitsOfDoubles = 15;
  const auto is_of_number = [](char letter) { return is_digit(letter) || letter == '+' || letter == '-'; };
  const char* const slash = std::find_if_not(at, end, is_of_number);
  if (slash == end || *slash != '/') return nullptr;
  const char* const stop = std::find_if_not(slash + 1, end, is_of_number);
  if (stop != end && !is_blank(*stop)) return nullptr;
  if (slash - at <= kDigitsOfDoubles && stop - slash - 1 <= kDigitsOfDoubles) return nullptr;
  const auto found = nearest_quotient({at, static_cast<std::size_t>(slash - at)},
                                      {slash + 1, static_cast<std::size_t>(stop - slash - 1)});
  if (!found) return nullptr;
  if (!std::isfinite(*found)) fail_quotient(source, at, column);
  value = *found;
  return stop;
}

/// An entry: a number or p/q. Returns the place behind it.
const char* read_entry(const TextSource& source, const char* at, const char* end, std::size_t column,
                       double& value) {
  if (const char* const behind = read_long_rational(source, at, end, column, value)) return behind;
  const char* stop = parse_number(at, end, value);
  if (stop == nullptr) source.fail_number(at, column);
  if (stop != end && *stop == '/') {
    double denominator = 0.0;
    stop = parse_number(stop + 1, end, denominator);
    if (stop == nullptr || (stop != end && !is_blank(*stop))) source.fail_number(at, column);
    value /= denominator;
    if (!std::isfinite(value)) fail_quotient(source, at, column);
  }
  if (stop != end && !is_blank(*stop)) source.fail_number(at, column);
  return stop;
}

struct MatrixHeader {
  std::size_t rows = 0;
  bool rows_are_open = false;  // *****
  std::size_t columns = 0;
};

MatrixHeader read_matrix_header(const TextSource& source, const Line& line, bool may_be_empty) {
  const char* const end = line.text.data() + line.text.size();
  const char* at = line.text.data();
  MatrixHeader header;
  if (line.text.starts_with("*****")) {
    header.rows_are_open = true;
    while (at != end && *at == '*') ++at;
    at = skip_blanks(at, end);
  } else {
    at = parse_count(at, end, header.rows);
  }
  if (at != nullptr) at = parse_count(skip_blanks(at, end), end, header.columns);
  std::string_view type;
  if (at != nullptr) {
    at = skip_blanks(at, end);
    type = std::string_view(at, static_cast<std::size_t>(end - at));
    type = type.substr(0, type.find_first_of(" \t"));
  }
  if (type != "integer" && type != "rational" && type != "real") {
    source.fail(ErrorCode::kBadHeader, line.start,
                fmt::format("found \"{}\" below begin, expected rows, columns and integer, rational or real; "
                            "correct the line",
                            printable(line.text)));
  }
  if (header.columns < 2) {
    source.fail(ErrorCode::kDimensionTooLow, line.start,
                fmt::format("found {} columns, expected dimension + 1, at least 2; correct the line",
                            header.columns));
  }
  if (header.rows == 0 && !header.rows_are_open && !may_be_empty) {
    source.fail(ErrorCode::kEmptyInput, line.start, "found 0 rows, expected 1 or more; correct the line");
  }
  return header;
}

/// Reads the entries up to `end`. `place` moves behind that line.
void read_matrix(const TextSource& source, const MatrixHeader& header, const char*& place,
                 CddMatrix& matrix) {
  NumberTable& table = matrix.table;
  table.columns = header.columns;
  bool ended = false;
  const char* ragged = nullptr;  // the first line that is not one row
  std::size_t ragged_length = 0;
  std::size_t lines = 0;
  while (place != source.end() && !ended) {
    const Line line = line_at(source, place);
    place = line.next;
    if (is_comment(line.text)) continue;
    if (starts_with_word(line.text, "end")) {
      ended = true;
      break;
    }
    const char* const end = line.text.data() + line.text.size();
    std::size_t length = 0;
    for (const char* at = line.text.data(); at != end && *at != '#'; at = skip_blanks(at, end)) {
      if (table.values.size() % header.columns == 0) matrix.row_place.push_back(at);
      double value = 0.0;
      at = read_entry(source, at, end, length + 1, value);
      table.values.push_back(value);
      ++length;
    }
    ++lines;
    if (length != header.columns && ragged == nullptr) {
      ragged = line.start;
      ragged_length = length;
    }
  }
  const std::size_t found = table.values.size();
  const bool whole_rows = found % header.columns == 0;
  table.rows = found / header.columns;
  if (!whole_rows || (!header.rows_are_open && table.rows != header.rows)) {
    // One row a line is the custom: as many lines as rows means that one of them is damaged.
    if (ragged != nullptr && (header.rows_are_open || lines == header.rows)) {
      source.fail(ErrorCode::kRaggedRow, ragged,
                  fmt::format("found {} columns, expected {} as the line below begin says; complete the row",
                              ragged_length, header.columns));
    }
    source.fail(
        ErrorCode::kWrongCount, place == source.begin() ? place : place - 1,
        fmt::format("found {} numbers up to {}, expected {} x {}; correct the line below begin or the rows",
                    found, ended ? "end" : "the end of the file", header.rows, header.columns));
  }
  if (!ended) {
    source.fail(ErrorCode::kWrongCount, source.end(),
                "found the end of the file, expected a line \"end\" behind the rows; append it");
  }
}

/// The rows that "linearity k i1 .. ik" names, counted from 1 in the file.
void read_linearity(const TextSource& source, CddMatrix& matrix) {
  const Line line = line_at(source, matrix.linearity);
  const char* const end = line.text.data() + line.text.size();
  const char* at = std::find_if(line.text.data(), end, is_blank);
  std::vector<std::size_t> numbers;
  for (at = skip_blanks(at, end); at != end && *at != '#'; at = skip_blanks(at, end)) {
    std::size_t number = 0;
    const char* const stop = parse_count(at, end, number);
    if (stop == nullptr || (stop != end && !is_blank(*stop))) source.fail_number(at, numbers.size() + 2);
    numbers.push_back(number);
    at = stop;
  }
  if (numbers.empty() || numbers[0] != numbers.size() - 1) {
    source.fail(
        ErrorCode::kBadHeader, line.start,
        fmt::format("found {} numbers, expected how many rows are equations and then these rows, from 1; "
                    "correct the line",
                    numbers.size()));
  }
  for (std::size_t k = 1; k < numbers.size(); ++k) {
    if (numbers[k] == 0 || numbers[k] > matrix.table.rows) {
      source.fail(
          ErrorCode::kBadHeader, line.start,
          fmt::format("found row {}, expected 1 to {}; correct the line", numbers[k], matrix.table.rows));
    }
    matrix.equations.push_back(numbers[k] - 1);
  }
  std::sort(matrix.equations.begin(), matrix.equations.end());
  matrix.equations.erase(std::unique(matrix.equations.begin(), matrix.equations.end()),
                         matrix.equations.end());
}

}  // namespace

bool looks_like_cdd(const TextSource& source) {
  for (const char* place = source.begin(); place != source.end();) {
    const Line line = line_at(source, place);
    if (line.text == "begin") return true;
    if (!line.text.empty() && (is_digit(line.text[0]) || line.text[0] == '-' || line.text[0] == '.'))
      return false;
    place = line.next;
  }
  return false;
}

void require_cdd(const TextSource& source) {
  if (looks_like_cdd(source)) return;
  throw Error(ErrorCode::kBadHeader,
              fmt::format("{}: found no line \"begin\", expected a cdd file as Fd says; leave Fd out",
                          source.name()));
}

CddMatrix read_cdd(const TextSource& source, bool may_be_empty) {
  source.require_content();
  CddMatrix matrix;
  const auto note_option = [&](const Line& line) {
    if (starts_with_word(line.text, "strict_inequality")) {
      source.fail(
          ErrorCode::kBadHeader, line.start,
          "found the option strict_inequality, expected halfspaces with their planes; remove the line");
    }
    for (const std::string_view name : {"linearity", "equality"}) {
      if (!starts_with_word(line.text, name)) continue;
      if (matrix.linearity != nullptr) {
        source.fail(ErrorCode::kBadHeader, line.start,
                    "found a second list of equations, expected one; join the lines");
      }
      matrix.linearity = line.start;
    }
  };

  const char* place = source.begin();
  bool begun = false;
  while (place != source.end() && !begun) {
    const Line line = line_at(source, place);
    place = line.next;
    begun = line.text == "begin";
    if (starts_with_word(line.text, "V-representation") || starts_with_word(line.text, "H-representation")) {
      matrix.h_representation = line.text[0] == 'H';
      matrix.representation_is_stated = true;
    }
    note_option(line);
  }
  if (!begun) {
    source.fail(
        ErrorCode::kBadHeader, source.end(),
        "found no line \"begin\", expected it before the rows; check that this is a file for cdd or lrs");
  }
  while (place != source.end()) {
    const Line line = line_at(source, place);
    // ***** is a count here, not a comment.
    if (!is_comment(line.text) || line.text.starts_with("*****")) break;
    place = line.next;
  }
  const Line header_line = line_at(source, place);
  const MatrixHeader header = read_matrix_header(source, header_line, may_be_empty);
  place = header_line.next;
  read_matrix(source, header, place, matrix);
  if (matrix.table.rows == 0 && !may_be_empty)
    source.fail(ErrorCode::kEmptyInput, place, "found 0 rows, expected 1 or more");
  while (place != source.end()) {
    const Line line = line_at(source, place);
    note_option(line);
    place = line.next;
  }
  if (matrix.linearity != nullptr) read_linearity(source, matrix);
  return matrix;
}

}  // namespace ndhull
