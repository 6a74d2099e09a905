// Which reader: by extension where that settles it, else by content.
#include "tools/io/point_reader.h"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <utility>

#include "core/error.h"
#include "tools/io/cdd_reader.h"
#include "tools/io/npy_header.h"
#include "tools/io/npy_reader.h"
#include "tools/io/qhull_text_reader.h"
#include "tools/io/table_reader.h"

namespace ndhull {
namespace {

/// Points of a V-representation: the leading 1 of every row goes.
NumberTable read_cdd_points(const TextSource& source, const std::string& extension) {
  CddMatrix matrix = read_cdd(source);
  const bool is_v = matrix.representation_is_stated ? !matrix.h_representation : extension == "ext";
  if (!is_v) {
    throw Error(
        ErrorCode::kBadHeader,
        fmt::format("{}: found halfspaces (H-representation), expected points (V-representation); use ndhull "
                    "intersect, or state V-representation before begin",
                    source.name()));
  }
  if (matrix.linearity != nullptr) {
    source.fail(
        ErrorCode::kBadHeader, matrix.linearity,
        "found the option linearity, expected points only; remove it and give points instead of lines");
  }
  NumberTable& table = matrix.table;
  const std::size_t columns = table.columns;
  for (std::size_t row = 0; row < table.rows; ++row) {
    const double kind = table.values[row * columns];
    if (kind == 1.0) continue;
    source.fail(ErrorCode::kBadHeader, matrix.row_place[row],
                fmt::format("column 1: found {}, expected 1 (a point); {}", kind,
                            kind == 0.0 ? "a ray makes the hull unbounded: replace it by a far point"
                                        : "divide the row by it"));
  }
  // In place: every number moves towards the front.
  for (std::size_t row = 0; row < table.rows; ++row) {
    const double* const from = table.values.data() + row * columns + 1;
    std::memmove(table.values.data() + row * (columns - 1), from, (columns - 1) * sizeof(double));
  }
  table.columns = columns - 1;
  table.values.resize(table.rows * table.columns);
  return std::move(table);
}

/// Does this text, neither cdd's nor binary, begin with Qhull's dimension and count?
bool is_qhull_text(const TextSource& source, const std::string& extension, TextKind kind) {
  if (table_separator(extension) != '\0') return false;
  if (kind == TextKind::kQhull && read_qhull_header(source).dimension) return true;
  return looks_like_qhull_text(source);
}

/// These columns of points that were read as a whole.
PointFile choose(PointFile points, const ColumnChoice& columns) {
  if (columns.is_all()) return points;
  const PointView view = points.view();
  const std::vector<std::size_t> chosen = columns.resolve(points.column_names, view.dimension, points.path);
  NumberTable table;
  table.rows = view.rows;
  table.columns = chosen.size();
  table.values.reserve(table.rows * table.columns);
  for (std::size_t row = 0; row < view.rows; ++row)
    for (const std::size_t column : chosen) table.values.push_back(view.at(row, column));
  return {points.path, std::move(table)};
}

/// What a binary file is, by its first bytes; null for text.
const char* binary_kind(std::string_view bytes) {
  const auto begins = [bytes](std::string_view magic) { return bytes.starts_with(magic); };
  if (begins("\xFF\xFE") || begins("\xFE\xFF")) return "UTF-16 text; save it as UTF-8";
  if (begins("\x1F\x8B")) return "a gzip archive; unpack it with gunzip";
  if (begins("PK\x03\x04")) return "a zip archive (.npz?); save one array with numpy.save";
  if (begins("\x89HDF")) return "an HDF5 file; save the array with numpy.save";
  if (begins("PAR1")) return "a Parquet file; save the columns as CSV or .npy";
  // A zero byte is in no text; the head of a file is enough to see one.
  if (bytes.substr(0, 4096).find('\0') != std::string_view::npos)
    return "binary data; save them as CSV or .npy";
  return nullptr;
}

/// Does a carriage return alone end lines, as it did before Unix? The first line tells.
bool has_lone_returns(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  const std::size_t last = first.find_last_not_of('\r');
  return last != std::string_view::npos && first.find('\r') < last;
}

/// The same text in lines that end with newlines.
std::string with_newlines(std::string_view text) {
  std::string lines(text);
  for (std::size_t at = 0; at < lines.size(); ++at)
    if (lines[at] == '\r' && (at + 1 == lines.size() || lines[at + 1] != '\n')) lines[at] = '\n';
  return lines;
}

}  // namespace

PointFile::PointFile(std::string name, NumberTable table)
    : path(std::move(name)),
      column_names(std::move(table.names)),
      values_(std::move(table.values)),
      view_(PointView::row_major(values_.data(), table.rows, table.columns)) {}

PointFile::PointFile(std::string name, FileBytes bytes, const PointView& view)
    : path(std::move(name)), bytes_(std::move(bytes)), view_(view) {}

PointFile::PointFile(std::string name, std::vector<double> values, const PointView& view)
    : path(std::move(name)), values_(std::move(values)), view_(view) {}

TextSource text_source_of(const FileBytes& bytes, const std::string& name) {
  std::string_view text = bytes.view();
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (const char* const kind = binary_kind(text); kind != nullptr) {
    throw Error(ErrorCode::kBadHeader, fmt::format("{}: expected text or .npy, found {}", name, kind));
  }
  if (has_lone_returns(text)) return {name, std::make_shared<const std::string>(with_newlines(text))};
  return {name, text};
}

NumberTable read_number_text(const TextSource& source, const std::string& extension, TextKind kind) {
  constexpr bool kMayBeEmpty = true;
  source.require_content();
  return is_qhull_text(source, extension, kind) ? read_qhull_text(source, kMayBeEmpty)
                                                : read_table(source, {}, kMayBeEmpty);
}

PointFile read_points(const std::string& path, const ColumnChoice& columns, std::size_t kept_bytes) {
  FileBytes bytes = FileBytes::read(path);
  try {
    return parse_points(std::move(bytes), path, columns, kept_bytes);
  } catch (const Error& error) {
    const bool may_be_names = error.code() == ErrorCode::kBadNumber || error.code() == ErrorCode::kBadHeader;
    if (!may_be_names || !columns.is_all() || table_separator(extension_of(path)) == '\0') throw;
    throw Error(error.code(),
                fmt::format("{}; or say with --columns which columns are coordinates", error.what()));
  }
}

PointFile parse_cdd_points(const FileBytes& bytes, const std::string& path) {
  const std::string name = display_name(path);
  const TextSource source = text_source_of(bytes, name);
  source.require_content();
  require_cdd(source);
  return {name, read_cdd_points(source, "ext")};
}

PointFile parse_points(FileBytes bytes, const std::string& path, const ColumnChoice& columns,
                       std::size_t kept_bytes, TextKind kind) {
  const std::string name = display_name(path);
  const std::string extension = extension_of(path);
  if (extension == "npy" || looks_like_npy(bytes.view()))
    return read_npy(std::move(bytes), name, columns, kept_bytes);
  const TextSource source = text_source_of(bytes, name);
  source.require_content();
  if (extension == "ext" || extension == "ine" || looks_like_cdd(source))
    return choose({name, read_cdd_points(source, extension)}, columns);
  if (is_qhull_text(source, extension, kind)) return choose({name, read_qhull_text(source)}, columns);
  return {name, read_table(source, columns)};
}

}  // namespace ndhull
