// Points from a file or standard input, whatever their format.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/points.h"
#include "tools/io/column_choice.h"
#include "tools/io/file_bytes.h"
#include "tools/io/qhull_text_reader.h"
#include "tools/io/text_source.h"

namespace ndhull {

/// Points and the memory they stand in: a mapped .npy file, or numbers that were text or integers.
/// Moving the object does not move the points.
class PointFile {
 public:
  PointFile() = default;
  /// Numbers that were read from text.
  PointFile(std::string name, NumberTable table);
  /// `view` points into `bytes`.
  PointFile(std::string name, FileBytes bytes, const PointView& view);
  /// `view` points into `values`.
  PointFile(std::string name, std::vector<double> values, const PointView& view);

  /// Valid as long as this object, or the one it was moved to, lives.
  PointView view() const { return view_; }

  std::string path;                       ///< as given, "standard input" for "-"
  std::vector<std::string> column_names;  ///< dimension names, or empty

 private:
  FileBytes bytes_;
  std::vector<double> values_;
  PointView view_;
};

/// A mapped file of up to so many bytes stays in memory: to map its pages again for each pass over it took a
/// tenth of the time of a hull of 10^6 points.
inline constexpr std::size_t kKeptFileBytes = std::size_t{1} << 26;

/// Reads points; all coordinates of the result are finite. The memory of mapped files of more than
/// `kept_bytes` is given back to the system when it was read (PointView::is_file_mapping).
///
/// Formats   .npy (float32 and float64 in place, C or Fortran order; integers and float16 become
///           float64), .ext (V-representation of cdd and lrs), .csv, .tsv (tables). Any other name, and
///           "-" for standard input: told by content, Qhull text included.
/// Columns   `columns` says which are coordinates, and in which order. In a table others may hold anything.
/// Throws    Error with the name, line and column or element, what was found, what was expected and a
///           remedy: kFileMissing, kEmptyInput, kBadHeader, kBadNumber, kNotFinite, kRaggedRow,
///           kWrongCount, kTruncated, kUnknownType, kDimensionTooLow; kUsage for columns it does not have.
/// Cost      text: 8 bytes a number and about 50 ns; .npy: one pass that looks for NaN and infinity, and a
///           copy as float64 of chosen columns.
PointFile read_points(const std::string& path, const ColumnChoice& columns = {},
                      std::size_t kept_bytes = kKeptFileBytes);

/// The same for bytes at hand; `path` tells the extension and the name in messages, `kind` what text is that
/// neither tells.
PointFile parse_points(FileBytes bytes, const std::string& path, const ColumnChoice& columns = {},
                       std::size_t kept_bytes = kKeptFileBytes, TextKind kind = TextKind::kByContent);

/// Points of a cdd file that says V-representation or nothing, whatever its name (Qhull's option Fd).
/// Throws as read_points; kBadHeader where there is no line "begin".
PointFile parse_cdd_points(const FileBytes& bytes, const std::string& path);

/// Reads any text that is one table of numbers: Qhull text, or columns. Throws as read_points does, but a
/// count of 0, or a table of names alone, is no error.
NumberTable read_number_text(const TextSource& source, const std::string& extension, TextKind kind);

/// The bytes as text, without a byte order mark; carriage returns that end lines alone become newlines.
/// Throws kBadHeader for UTF-16, compressed and other binary files, with what they are.
TextSource text_source_of(const FileBytes& bytes, const std::string& name);

}  // namespace ndhull
