#include "bench/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ndhull {

std::string Table::as_text() const {
  std::vector<std::size_t> widths(columns.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t column = 0; column < row.size(); ++column) {
      widths[column] = std::max(widths[column], row[column].size());
    }
  };
  widen(columns);
  for (const auto& row : rows) widen(row);

  std::string text = title + "\n";
  if (!note.empty()) text += note + "\n";
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t column = 0; column < row.size(); ++column) {
      if (column > 0) line += "  ";
      line += column < left_columns ? fmt::format("{:<{}}", row[column], widths[column])
                                    : fmt::format("{:>{}}", row[column], widths[column]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add(columns);
  for (const auto& row : rows) add(row);
  return text;
}

std::string Table::as_markdown() const {
  std::string text = fmt::format("### {}\n\n", title);
  if (!note.empty()) text += note + "\n\n";
  return text + markdown_rows();
}

std::string Table::markdown_rows() const {
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    for (const std::string& cell : row) text += "| " + (cell.empty() ? "" : cell + " ");
    text += "|\n";
  };
  add(columns);
  for (std::size_t column = 0; column < columns.size(); ++column) {
    text += column < left_columns ? "| --- " : "| ---: ";
  }
  text += "|\n";
  for (const auto& row : rows) add(row);
  return text;
}

std::string Table::as_html() const {
  std::string text = fmt::format("<h3>{}</h3>\n", html_escaped(title));
  if (!note.empty()) text += fmt::format("<p>{}</p>\n", html_escaped(note));
  text += "<table>\n";
  const auto add = [&](const std::vector<std::string>& row, const char* element) {
    text += "<tr>";
    for (std::size_t column = 0; column < row.size(); ++column) {
      text += fmt::format("<{}{}>{}</{}>", element, column < left_columns ? " class=\"left\"" : "",
                          html_escaped(row[column]), element);
    }
    text += "</tr>\n";
  };
  add(columns, "th");
  for (const auto& row : rows) add(row, "td");
  return text + "</table>\n";
}

std::string html_escaped(const std::string& text) {
  std::string escaped;
  for (const char letter : text) {
    switch (letter) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      default: escaped += letter;
    }
  }
  return escaped;
}

std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  if (size < 1e-3 || size >= 1e6) return fmt::format("{:.1e}", value);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 5);
  return fmt::format("{:.{}f}", value, decimals);
}

std::string grouped_number(std::uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (std::ptrdiff_t place = std::ssize(digits) - 3; place > 0; place -= 3) {
    digits.insert(static_cast<std::size_t>(place), ",");
  }
  return digits;
}

}  // namespace ndhull
