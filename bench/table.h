// A table of text, for a terminal, for Markdown and for a page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ndhull {

/// Cells are text already; the first `left_columns` are aligned left, the others right.
struct Table {
  std::string title;
  std::string note;  ///< what the columns mean; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< each of columns.size() cells
  std::size_t left_columns = 1;

  /// Columns as wide as their widest cell.
  std::string as_text() const;
  std::string as_markdown() const;
  std::string markdown_rows() const;  ///< without title and note
  std::string as_html() const;
};

/// The text with what HTML reserves replaced.
std::string html_escaped(const std::string& text);

/// 3 significant digits, without an exponent from 0.001 to a million: "0.182", "1.2e-14", "56.6".
std::string short_number(double value);
/// "56,576".
std::string grouped_number(std::uint64_t value);

}  // namespace ndhull
