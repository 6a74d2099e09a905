// Points as rbox writes them and Qhull reads them: dimension, count, coordinates.
#pragma once

#include "tools/io/text_source.h"

namespace ndhull {

/// Does the text begin with Qhull's header? Two integers on two lines (or on one, when as many numbers
/// follow as they announce), the first one perhaps with a comment behind it. Lines of text may stand before
/// and between them, as Qhull's option FQ writes one, where they are not the names of a table's columns.
bool looks_like_qhull_text(const TextSource& source);

/// Reads dimension, count and coordinates; the coordinates may be broken into lines in any way.
///
/// Comments   from # or a word that begins like no number to the end of its line, as Qhull takes them.
/// Also read  the count before the dimension, when every line has as many numbers as the second header
///            number says.
/// Throws     kBadHeader, kEmptyInput (count 0), kDimensionTooLow (dimension 0), kNotFinite; kBadNumber also
///            for a comment where a number is missing;
///            kRaggedRow when there are as many lines as points and one has another length;
///            kWrongCount otherwise when the numbers are not as many as announced.
/// `may_be_empty`: count 0 is no error.
NumberTable read_qhull_text(const TextSource& source, bool may_be_empty = false);

/// Skips empty lines and lines that start with #.
const char* skip_empty_lines(const TextSource& source, const char* place);

/// Skips also lines that begin with a word that begins like no number.
const char* skip_comment_lines(const TextSource& source, const char* place);

/// The leading integers of a line and whether other text stands behind them.
struct IntegerLine {
  std::size_t count = 0;  ///< 0, 1, 2, or 3 for "more"
  std::size_t value[2] = {};
  bool has_text = false;        ///< something that is not an unsigned integer follows
  bool text_is_number = false;  ///< and it begins like a number
  const char* next = nullptr;   ///< the line after it
};
IntegerLine read_integer_line(const TextSource& source, const char* place);

}  // namespace ndhull
