// The readers for points do the work: halfspaces are rows of dimension + 1 numbers.
#include "tools/io/halfspace_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "tools/io/cdd_reader.h"
#include "tools/io/npy_header.h"
#include "tools/io/npy_reader.h"
#include "tools/io/qhull_text_reader.h"

namespace ndhull {
namespace {

/// Rows that hold everywhere are left out, and the reverse of an equation follows the others.
/// b0 + a'.x >= 0 is -a'.x - b0 <= 0. Subtracting from zero instead of negating leaves no minus zeros.
HalfspaceFile read_cdd_halfspaces(const TextSource& source, const std::string& extension) {
  CddMatrix matrix = read_cdd(source, true);
  const bool is_h = matrix.representation_is_stated ? matrix.h_representation : extension != "ext";
  if (!is_h) {
    throw Error(
        ErrorCode::kBadHeader,
        fmt::format("{}: found points (V-representation), expected halfspaces (H-representation); use ndhull "
                    "hull, or state H-representation before begin",
                    source.name()));
  }
  HalfspaceFile file;
  const NumberTable& table = matrix.table;
  file.dimension = table.columns - 1;
  file.file_row_count = table.rows;
  file.rows.reserve(table.values.size());
  std::vector<std::uint32_t> halfspace_rows, equation_rows;
  for (std::size_t at = 0; at < table.rows; ++at) {
    const auto row = static_cast<std::uint32_t>(at);
    const double* const from = table.values.data() + row * table.columns;
    const bool is_equation = std::binary_search(matrix.equations.begin(), matrix.equations.end(), row);
    if (std::all_of(from + 1, from + table.columns, [](double component) { return component == 0.0; })) {
      // cdd and lrs write 1 0 .. 0, the halfspace at infinity.
      const bool holds = is_equation ? from[0] == 0.0 : from[0] >= 0.0;
      if (!holds && !file.impossible) file.impossible = {row, 0.0 - from[0]};
      continue;
    }
    halfspace_rows.push_back(row);
    if (is_equation) equation_rows.push_back(row);
  }
  const auto add = [&](std::uint32_t row, double sign) {
    const double* const from = table.values.data() + row * table.columns;
    for (std::size_t k = 1; k < table.columns; ++k) file.rows.push_back(0.0 - sign * from[k]);
    file.rows.push_back(0.0 - sign * from[0]);
    file.file_row.push_back(row);
    file.is_reversed.push_back(sign < 0.0);
  };
  for (const std::uint32_t row : halfspace_rows) add(row, 1.0);
  for (const std::uint32_t row : equation_rows) add(row, -1.0);
  file.count = file.file_row.size();
  if (equation_rows.empty() && file.count == table.rows) {
    file.file_row.clear();
    file.is_reversed.clear();
  }
  return file;
}

/// A point in front of the halfspaces: d and 1, d numbers, and more behind them. Returns the place behind the
/// point, or null when there is none.
const char* read_interior_point(const TextSource& source, TextKind kind, std::vector<double>& point) {
  const QhullHeader header = read_qhull_header(source);
  if (header.count != std::size_t{1}) return nullptr;
  // A row of a table may begin with these.
  if (kind == TextKind::kByContent && header.data != source.end() && header.data[-1] != '\n') return nullptr;
  const std::size_t dimension = *header.dimension;
  const char* place = header.data;
  while (point.size() < dimension && (place = skip_comment_lines(source, place)) != source.end()) {
    const char* comment = nullptr;
    read_number_line(source, place, point, &comment);
  }
  const bool has_more = skip_comment_lines(source, place) != source.end();
  // "5 1" and five numbers alone are one halfspace in dimension 4.
  return point.size() == dimension && has_more ? place : nullptr;
}

HalfspaceFile read_text_halfspaces(const TextSource& source, const std::string& extension, TextKind kind) {
  HalfspaceFile file;
  std::vector<double> point;
  const char* const rest = read_interior_point(source, kind, point);
  NumberTable table;
  if (rest == nullptr) {
    table = read_number_text(source, extension, kind);
  } else {
    // Line numbers in messages count from the start of the file, so the point becomes blank lines.
    std::string text(source.begin(), rest);
    std::replace_if(
        text.begin(), text.end(), [](char letter) { return letter != '\n'; }, ' ');
    text.append(rest, source.end());
    table = read_number_text(TextSource(source.name(), text), extension, kind);
    if (kind == TextKind::kByContent && point.size() == 2 && table.columns == 2) {
      // A table of 1-d halfspaces, whose first row looks like the header of a point.
      table = read_number_text(source, extension, kind);
      point.clear();
    } else if (point.size() + 1 != table.columns) {
      source.fail(
          ErrorCode::kBadHeader, skip_comment_lines(source, source.begin()),
          fmt::format(
              "found a point in dimension {} before halfspaces of {} columns, expected {}; correct one",
              point.size(), table.columns, point.size() + 1));
    }
    if (!point.empty()) file.interior_point = std::move(point);
  }
  file.dimension = table.columns - 1;
  file.count = table.rows;
  file.rows = std::move(table.values);
  return file;
}

HalfspaceFile read_npy_halfspaces(FileBytes bytes, const std::string& name) {
  if (const NpyHeader header = read_npy_header(bytes.view(), name);
      header.shape.size() == 2 && header.shape[0] == 0 && header.shape[1] > 0) {
    HalfspaceFile none;
    none.dimension = header.shape[1] - 1;
    return none;
  }
  const PointFile points = read_npy(std::move(bytes), name, {}, kKeptFileBytes);
  const PointView view = points.view();
  HalfspaceFile file;
  file.dimension = view.dimension - 1;
  file.count = view.rows;
  file.rows.resize(view.rows * view.dimension);
  for (std::size_t row = 0; row < view.rows; ++row)
    view.copy_row(row, file.rows.data() + row * view.dimension);
  return file;
}

void check(const HalfspaceFile& file) {
  if (file.dimension == 0) {
    throw Error(ErrorCode::kDimensionTooLow,
                fmt::format("{}: found 1 column, expected the normal and the offset; write rows a_1 .. a_d b",
                            file.path));
  }
  const std::size_t columns = file.dimension + 1;
  for (std::size_t row = 0; row < file.count; ++row) {
    const auto normal = file.rows.begin() + static_cast<std::ptrdiff_t>(row * columns);
    const bool is_zero = std::all_of(normal, normal + static_cast<std::ptrdiff_t>(file.dimension),
                                     [](double component) { return component == 0.0; });
    if (!is_zero) continue;
    throw Error(ErrorCode::kBadHalfspace,
                fmt::format("{}, halfspace {} (counted from 0): found a zero normal, expected one component "
                            "other than 0; remove the row",
                            file.path, row));
  }
}

}  // namespace

void HalfspaceFile::require_possible() const {
  if (!impossible) return;
  throw Error(
      ErrorCode::kBadHalfspace,
      fmt::format("{}, row {} (counted from 0): found a zero normal with the offset {}, expected a row "
                  "that holds somewhere; remove it",
                  path, impossible->row, impossible->offset));
}

HalfspaceFile read_halfspaces(const std::string& path) {
  return parse_halfspaces(FileBytes::read(path), path);
}

HalfspaceFile parse_halfspaces(FileBytes bytes, const std::string& path, TextKind kind) {
  const std::string name = display_name(path);
  const std::string extension = extension_of(path);
  HalfspaceFile file;
  if (extension == "npy" || looks_like_npy(bytes.view())) {
    file = read_npy_halfspaces(std::move(bytes), name);
  } else {
    const TextSource source = text_source_of(bytes, name);
    source.require_content();
    const bool is_cdd = extension == "ine" || extension == "ext" || looks_like_cdd(source);
    file = is_cdd ? read_cdd_halfspaces(source, extension) : read_text_halfspaces(source, extension, kind);
  }
  file.path = name;
  if (file.file_row_count == 0) file.file_row_count = file.count;
  check(file);
  return file;
}

}  // namespace ndhull
