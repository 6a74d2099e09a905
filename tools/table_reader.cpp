// One pass over the lines. The first line that is neither empty nor a comment settles separator, header and
// number of columns; every other line is compared with it.
#include "tools/table_reader.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

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

/// Reads the fields of one line to the back of `values`; returns their number.
std::size_t read_fields(const TextSource& source, const char* place, const char* end, char separator,
                        std::vector<double>& values) {
  // A tab separates here, so it is not among the blanks that are skipped.
  const auto skip = [=](const char* at) {
    while (at != end && is_blank(*at) && *at != separator) ++at;
    return at;
  };
  std::size_t count = 0;
  for (const char* at = skip(place);; at = skip(at + 1)) {
    ++count;
    const bool quoted = at != end && *at == '"';
    const char* const first = quoted ? skip(at + 1) : at;
    double value = 0.0;
    if (first == end || *first == separator) {
      source.fail(
          ErrorCode::kBadNumber, place,
          fmt::format(
              "column {}: found an empty field, expected a number; fill in the value or remove the row",
              count));
    }
    const char* stop = parse_number(first, end, value);
    if (stop == nullptr) source.fail_number(first, count);
    if (quoted && (stop == end || *stop++ != '"')) source.fail_number(at, count);
    values.push_back(value);
    const char* const next = skip(stop);
    // 1.#INF is not a number with a comment.
    if (next == end || (*next == '#' && next != stop)) return count;
    if (*next != separator) source.fail_number(first, count);
    at = next;
  }
}

void check_names(const TextSource& source, const char* place, const std::vector<std::string>& names) {
  for (std::size_t column = 0; column < names.size(); ++column) {
    if (!names[column].empty()) continue;
    source.fail(
        ErrorCode::kBadHeader, place,
        fmt::format("column {}: found no name in the header, expected one; name the column, or write the "
                    "table without its index column",
                    column + 1));
  }
}

}  // namespace

NumberTable read_table(const TextSource& source) {
  source.require_content();
  NumberTable table;
  char separator = kBlanks;
  bool first_line = true;
  const char* header = nullptr;  // place of the line that fixed the number of columns
  for (const char* place = source.begin(); place != source.end();) {
    const char* const line = place;
    const char* const end = source.line_end(line);
    const char* const text = skip_blanks(line, end);
    if (text == end || *text == '#') {
      place = end == source.end() ? end : end + 1;
      continue;
    }
    if (first_line) {
      first_line = false;
      header = line;
      const std::string_view view(line, static_cast<std::size_t>(end - line));
      separator = find_separator(view);
      std::string_view content = view;
      while (!content.empty() && content.back() == '\r') content.remove_suffix(1);
      std::vector<std::string> fields = split(content, separator);
      if (is_header(fields)) {
        check_names(source, line, fields);
        table.columns = fields.size();
        table.names = std::move(fields);
        place = end == source.end() ? end : end + 1;
        continue;
      }
    }
    std::size_t count = 0;
    if (separator == kBlanks) {
      count = read_number_line(source, place, table.values);
    } else {
      count = read_fields(source, line, end, separator, table.values);
      place = end == source.end() ? end : end + 1;
    }
    if (table.columns == 0) table.columns = count;
    if (count != table.columns) {
      // A lone integer above may be the beginning of a Qhull file whose count is missing.
      const bool lone = table.columns == 1 && separator == kBlanks;
      source.fail(ErrorCode::kRaggedRow, line,
                  fmt::format("found {} columns, expected {} as in line {}; {}", count, table.columns,
                              source.line_of(header),
                              lone ? "if that line is Qhull's dimension, the number of points must follow it"
                                   : "complete the row or remove it"));
    }
    if (table.rows == 0) {
      // The first row tells the length of the others; 1/8 for rows that are shorter.
      const auto length = static_cast<std::size_t>(end - line) + 1;
      const auto left = static_cast<std::size_t>(source.end() - line);
      table.values.reserve((left / length + left / length / 8 + 1) * table.columns);
    }
    ++table.rows;
  }
  if (table.rows == 0) {
    throw Error(ErrorCode::kEmptyInput,
                fmt::format("{}: found {} and no rows, expected numbers below; append the points",
                            source.name(), table.names.empty() ? "comments" : "a header line"));
  }
  return table;
}

}  // namespace ndhull
