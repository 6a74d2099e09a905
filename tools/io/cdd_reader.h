// The polyhedra format of cdd and lrs: .ext (V-representation) and .ine (H-representation).
#pragma once

#include <vector>

#include "tools/io/text_source.h"

namespace ndhull {

/// The matrix between `begin` and `end`, with what the lines around it say.
struct CddMatrix {
  bool h_representation = true;  ///< what the file says, or cdd's default when it says nothing
  bool representation_is_stated = false;
  NumberTable table;                   ///< columns = dimension + 1, the first column still in front
  std::vector<const char*> row_place;  ///< where each row begins, for messages
  const char* linearity = nullptr;     ///< place of a linearity (or equality) option, or null
  std::vector<std::size_t> equations;  ///< rows from 0 that it names, ascending
};

/// Is there a line `begin` before the first line of numbers?
bool looks_like_cdd(const TextSource& source);

/// Throws kBadHeader where there is none, though Qhull's option Fd says that the file is cdd's.
void require_cdd(const TextSource& source);

/// Reads the matrix; the entries are integers, reals or quotients p/q (numerator and denominator are
/// rounded to double, then divided). The count may be ***** as lrs writes it: the rows up to `end`.
///
/// Throws  kEmptyInput   nothing at all, or 0 rows
///         kBadHeader    no `begin`, or not "rows columns type" below it
///         kDimensionTooLow  fewer than 2 columns
///         kBadHeader    linearity without the numbers of rows, or strict_inequality
///         kBadNumber, kNotFinite, kRaggedRow, kWrongCount (`end` too early, too late or missing)
/// `may_be_empty`: 0 rows are no error.
CddMatrix read_cdd(const TextSource& source, bool may_be_empty = false);

}  // namespace ndhull
