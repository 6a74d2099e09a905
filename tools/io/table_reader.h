// CSV, TSV, semicolon- and blank-separated tables of numbers.
#pragma once

#include "tools/io/column_choice.h"
#include "tools/io/text_source.h"

namespace ndhull {

/// Reads a table: one row a line, the same number of columns in each.
///
/// Format    Separators are told from the first line: semicolon, tab, comma, else blanks. Fields may be
///           quoted. The first line is a header when none of its fields is a number, or all are quoted
///           and those of the next line are not; a line of missing values (NA) is none. A header that is
///           one name shorter than rows that begin with text or quotes, as R writes it, begins with the
///           second column. Empty lines and lines that start with # are skipped.
/// Columns   `choice` says which are read, and in which order; what stands in the others is not looked at.
/// Throws    kUsage           a column that the table does not have
///           kEmptyInput      nothing, or nothing but a header
///           kBadHeader       a header where a column that is read has no name: it is an index, not a
///                            coordinate
///           kBadNumber, kNotFinite, kRaggedRow, with line and column
/// Empty     with `may_be_empty` a header alone is a table of no rows.
/// Cost      one pass.
NumberTable read_table(const TextSource& source, const ColumnChoice& choice = {}, bool may_be_empty = false);

}  // namespace ndhull
