// One pass over the lines. The first line that is neither empty nor a comment settles separator, header and
// number of columns; every other line is compared with it.
#include "tools/io/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <utility>

#include "tools/io/qhull_text_reader.h"

namespace ndhull {
namespace {

constexpr char kBlanks = ' ';  // any run of blanks and tabs separates

/// Fields of a line, unquoted and trimmed. Good enough for headers, too slow for a million rows.
std::vector<std::string> split(std::string_view line, char separator) {
  std::vector<std::string> fields;
  std::string field;
  bool quoted = false;
  bool pending = false;  // the field has begun: with kBlanks a run of blanks ends no empty field
  const auto finish = [&] {
    while (!field.empty() && is_blank(field.back())) field.pop_back();
    fields.push_back(std::move(field));
    field.clear();
    pending = false;
  };
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
      pending = true;
    } else if (quoted) {
      field += letter;
    } else if (separator == kBlanks ? is_blank(letter) : letter == separator) {
      if (separator != kBlanks || pending) finish();
    } else if (pending || !is_blank(letter)) {
      field += letter;
      pending = true;
    }
  }
  if (separator != kBlanks || pending) finish();
  return fields;
}

bool is_number(const std::string& field) {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  return parse_number(field.data(), end, value) == end;
}

bool is_header(const std::vector<std::string>& fields) {
  for (const std::string& field : fields) {
    // "1.2abc" is a damaged number rather than a name.
    if (!field.empty() && (is_digit(field[0]) || is_number(field) || names_non_finite(field))) return false;
  }
  return true;
}

/// Rows may begin with one in which every value is missing: no names, though no numbers either.
bool is_missing_row(std::span<const std::string> fields) {
  const auto is_absent = [](const std::string& field) { return field.empty() || names_missing_value(field); };
  return std::all_of(fields.begin(), fields.end(), is_absent) &&
         std::any_of(fields.begin(), fields.end(), names_missing_value);
}

char find_separator(std::string_view line) {
  bool quoted = false;
  bool comma = false;
  bool tab = false;
  for (const char letter : line) {
    if (letter == '"') quoted = !quoted;
    if (quoted) continue;
    // Before the comma: where semicolons and tabs separate, commas may be decimal commas.
    if (letter == ';') return ';';
    tab = tab || letter == '\t';
    comma = comma || letter == ',';
  }
  if (tab) {
    // Tabs that only align numbers are blanks; between names, a blank belongs to the name.
    const bool names = is_header(split(line, kBlanks));
    return comma || names ? '\t' : kBlanks;
  }
  return comma ? ',' : kBlanks;
}

/// The text of one line of a table, field after field.
struct FieldLine {
  const TextSource& source;
  const char* end;
  char separator;

  /// A tab that separates is not among the blanks that are skipped.
  const char* skip(const char* at) const {
    while (at != end && is_blank(*at) && (separator == kBlanks || *at != separator)) ++at;
    return at;
  }
  bool separates(char letter) const { return separator == kBlanks ? is_blank(letter) : letter == separator; }
  /// Where the next field begins, `at` being behind one: null when there is none. A comment is no field of
  /// a line that blanks separate.
  const char* next_field(const char* at) const {
    at = skip(at);
    if (at == end || (separator == kBlanks && *at == '#')) return nullptr;
    return separator == kBlanks ? at : skip(at + 1);
  }
};

/// Reads the number at `at`, field `column` of its line from 1; returns the place behind it, the end of the
/// line where a comment follows.
const char* read_field(const FieldLine& line, const char* at, std::size_t column, double& value) {
  const TextSource& source = line.source;
  const bool quoted = at != line.end && *at == '"';
  const char* const first = quoted ? line.skip(at + 1) : at;
  if (first == line.end || *first == line.separator) {
    source.fail(
        ErrorCode::kBadNumber, at,
        fmt::format("column {}: found an empty field, expected a number; fill in the value or remove the row",
                    column));
  }
  const char* stop = parse_number(first, line.end, value);
  if (stop == nullptr) source.fail_number(first, column);
  if (quoted && (stop == line.end || *stop++ != '"')) source.fail_number(at, column);
  const char* const next = line.skip(stop);
  // 1.#INF is not a number with a comment.
  if (next == line.end || (*next == '#' && next != stop)) return line.end;
  if (line.separator == kBlanks ? next == stop : *next != line.separator) source.fail_number(first, column);
  return next;
}

/// The place behind the field at `at`, whatever it holds.
const char* skip_field(const FieldLine& line, const char* at) {
  for (bool quoted = false; at != line.end && (quoted || !line.separates(*at)); ++at) {
    if (*at == '"') quoted = !quoted;
  }
  return at;
}

/// Reads the fields of one line to the back of `values`; returns their number.
std::size_t read_fields(const FieldLine& line, const char* place, std::vector<double>& values) {
  std::size_t count = 0;
  for (const char* at = line.skip(place); at != nullptr;) {
    double value = 0.0;
    const char* const stop = read_field(line, at, ++count, value);
    values.push_back(value);
    at = line.next_field(stop);
  }
  return count;
}

/// The columns that are read: for each column of the file its place in a row of the result, or kLeftOut.
constexpr std::size_t kLeftOut = static_cast<std::size_t>(-1);

/// Reads the fields that have a place to the back of `values`; returns the number of all.
std::size_t read_chosen(const FieldLine& line, const char* place, std::span<const std::size_t> places,
                        std::size_t chosen, std::vector<double>& values) {
  const std::size_t row = values.size();
  values.resize(row + chosen);
  std::size_t count = 0;
  for (const char* at = line.skip(place); at != nullptr;) {
    const bool is_read = count < places.size() && places[count] != kLeftOut;
    const char* const stop =
        is_read ? read_field(line, at, count + 1, values[row + places[count]]) : skip_field(line, at);
    ++count;
    at = line.next_field(stop);
  }
  return count;
}

/// What the first line settles for all.
struct TableLayout {
  char separator = kBlanks;
  std::size_t columns = 0;          ///< of the file; 0 until a row is read where all are read
  std::vector<std::size_t> chosen;  ///< columns from 0, in the order of the choice; empty: all
  std::vector<std::size_t> places;  ///< of each column of the file: kLeftOut, or its place among the chosen
  std::vector<std::string> names;   ///< of the columns that are read
  bool has_header = false;
};

std::size_t count_fields(const FieldLine& line, const char* place) {
  std::size_t count = 0;
  for (const char* at = line.skip(place); at != nullptr; at = line.next_field(skip_field(line, at))) ++count;
  return count;
}

bool are_all_quoted(const FieldLine& line, const char* place) {
  for (const char* at = line.skip(place); at != nullptr; at = line.next_field(skip_field(line, at)))
    if (at == line.end || *at != '"') return false;
  return true;
}

/// Numbers in quotes above rows that are not all in quotes: programs quote the names of columns, whatever they
/// are, and the values as they are of a kind.
bool is_header_by_quotes(const TextSource& source, const FieldLine& line, const char* place) {
  if (!are_all_quoted(line, place)) return false;
  const char* const below = line.end == source.end() ? line.end : skip_empty_lines(source, line.end + 1);
  return below != source.end() && !are_all_quoted({source, source.line_end(below), line.separator}, below);
}

/// A word without digits, and no way to say that a value is missing.
bool is_name(const std::string& field) {
  const auto is_part = [](unsigned char letter) {
    return letter != '.' && !is_digit(static_cast<char>(letter));
  };
  return !field.empty() && !names_missing_value(field) && !names_non_finite(field) &&
         std::ranges::all_of(field, is_part);
}

/// Two or more whole numbers that go up by one: years, or what pandas counts columns by.
bool are_counted(std::span<const std::string> numbers) {
  if (numbers.size() < 2) return false;
  std::size_t last = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const std::string& field = numbers[k];
    std::size_t value = 0;
    const char* const end = field.data() + field.size();
    if (parse_count(field.data(), end, value) != end || (k > 0 && value != last + 1)) return false;
    last = value;
  }
  return true;
}

/// Fields of the first row under a line; none: there is none.
std::vector<std::string> fields_below(const TextSource& source, const FieldLine& line) {
  const char* const below = line.end == source.end() ? line.end : skip_empty_lines(source, line.end + 1);
  if (below == source.end()) return {};
  std::vector<std::string> values =
      split({below, static_cast<std::size_t>(source.line_end(below) - below)}, line.separator);
  while (!values.empty() && !values.back().empty() && values.back().back() == '\r') values.back().pop_back();
  return values;
}

/// R writes no name above the names of rows, which are text or quoted.
bool lacks_name_of_rows(std::span<const std::string> fields, const TextSource& source,
                        const FieldLine& line) {
  const std::vector<std::string> values = fields_below(source, line);
  if (values.size() != fields.size() + 1 || !is_number(values.back())) return false;
  return !is_number(values.front()) || *skip_empty_lines(source, line.end + 1) == '"';
}

/// Columns that are counted behind others with names, or behind one without: a point whose other values are
/// text looks like that as well, but the rows below have numbers there.
bool is_header_by_column(std::span<const std::string> fields, const TextSource& source,
                         const FieldLine& line) {
  if (line.separator == kBlanks) return false;
  const std::vector<std::string> values = fields_below(source, line);
  if (values.size() != fields.size()) return false;
  const auto first = std::ranges::find_if(fields, is_number);
  const auto named = static_cast<std::size_t>(first - fields.begin());
  if (named == 0 || !are_counted(fields.subspan(named))) return false;
  for (std::size_t k = 0; k < named; ++k)
    if (!is_number(values[k]) || !(is_name(fields[k]) || (fields[k].empty() && *first == "0"))) return false;
  return true;
}

[[noreturn]] void fail_without_name(const TextSource& source, const char* line, std::size_t column,
                                    const ColumnChoice& choice) {
  source.fail(
      ErrorCode::kBadHeader, line,
      fmt::format("column {}: found no name in the header, expected one; name the column{}", column + 1,
                  choice.is_all() ? ", or write the table without its index column" : ""));
}

TableLayout read_first_line(const TextSource& source, const char* line, const char* end,
                            const ColumnChoice& choice) {
  TableLayout layout;
  std::string_view content(line, static_cast<std::size_t>(end - line));
  layout.separator = find_separator(content);
  while (!content.empty() && content.back() == '\r') content.remove_suffix(1);
  std::vector<std::string> fields = split(content, layout.separator);
  const FieldLine first{source, end, layout.separator};
  layout.has_header = (is_header(fields) || is_header_by_quotes(source, first, line) ||
                       (!choice.is_all() && is_header_by_column(fields, source, first))) &&
                      !(choice.is_all() && is_missing_row(fields));
  if (layout.has_header) {
    if (lacks_name_of_rows(fields, source, first)) fields.insert(fields.begin(), "");
    layout.columns = fields.size();
  } else {
    fields.clear();
  }
  if (!choice.is_all()) {
    if (!layout.has_header) layout.columns = count_fields(first, line);
    layout.chosen = choice.resolve(fields, layout.columns, source.name());
    layout.places.assign(layout.columns, kLeftOut);
    for (std::size_t place = 0; place < layout.chosen.size(); ++place)
      layout.places[layout.chosen[place]] = place;
    std::vector<std::string> read;
    if (layout.has_header)
      for (const std::size_t column : layout.chosen) read.push_back(fields[column]);
    layout.has_header = layout.has_header && !is_missing_row(read);
  }
  if (!layout.has_header) return layout;
  const std::size_t read = choice.is_all() ? fields.size() : layout.chosen.size();
  for (std::size_t place = 0; place < read; ++place) {
    const std::size_t column = choice.is_all() ? place : layout.chosen[place];
    if (fields[column].empty()) fail_without_name(source, line, column, choice);
    layout.names.push_back(std::move(fields[column]));
  }
  return layout;
}

/// Reads the row at `place`, which moves to the next line, to the back of `values`; returns its number of
/// fields.
std::size_t read_row(const TextSource& source, const TableLayout& layout, const char*& place,
                     std::vector<double>& values) {
  if (layout.chosen.empty() && layout.separator == kBlanks) return read_number_line(source, place, values);
  const char* const end = source.line_end(place);
  const FieldLine line{source, end, layout.separator};
  const std::size_t count = layout.chosen.empty()
                                ? read_fields(line, place, values)
                                : read_chosen(line, place, layout.places, layout.chosen.size(), values);
  place = end == source.end() ? end : end + 1;
  return count;
}

}  // namespace

NumberTable read_table(const TextSource& source, const ColumnChoice& choice, bool may_be_empty) {
  source.require_content();
  NumberTable table;
  TableLayout layout;
  const char* header = nullptr;  // place of the line that fixed the number of columns
  for (const char* place = source.begin(); place != source.end();) {
    const char* const line = place;
    const char* const end = source.line_end(line);
    const char* const text = skip_blanks(line, end);
    if (text == end || *text == '#') {
      place = end == source.end() ? end : end + 1;
      continue;
    }
    if (header == nullptr) {
      header = line;
      layout = read_first_line(source, line, end, choice);
      table.names = layout.names;
      if (layout.has_header) {
        place = end == source.end() ? end : end + 1;
        continue;
      }
    }
    const std::size_t count = read_row(source, layout, place, table.values);
    if (layout.columns == 0) layout.columns = count;
    if (count != layout.columns) {
      // A lone integer above may be the beginning of a Qhull file whose count is missing.
      const bool lone = layout.columns == 1 && layout.separator == kBlanks;
      source.fail(ErrorCode::kRaggedRow, line,
                  fmt::format("found {} columns, expected {} as in line {}; {}", count, layout.columns,
                              source.line_of(header),
                              lone ? "if that line is Qhull's dimension, the number of points must follow it"
                                   : "complete the row or remove it"));
    }
    if (table.rows == 0) {
      table.columns = layout.chosen.empty() ? count : layout.chosen.size();
      // The first row tells the length of the others; 1/8 for rows that are shorter.
      const auto length = static_cast<std::size_t>(end - line) + 1;
      const auto left = static_cast<std::size_t>(source.end() - line);
      table.values.reserve((left / length + left / length / 8 + 1) * table.columns);
    }
    ++table.rows;
  }
  if (table.rows == 0 && may_be_empty && !table.names.empty()) {
    table.columns = table.names.size();
    return table;
  }
  if (table.rows == 0) {
    throw Error(ErrorCode::kEmptyInput,
                fmt::format("{}: found {} and no rows, expected numbers below; append the points",
                            source.name(), table.names.empty() ? "comments" : "a header line"));
  }
  return table;
}

}  // namespace ndhull
