// Points as rbox writes them and Qhull reads them: dimension, count, coordinates.
#pragma once

#include <cstddef>
#include <optional>

#include "tools/io/text_source.h"

namespace ndhull {

/// What a text without an extension that tells is taken for.
enum class TextKind {
  kByContent,  ///< Qhull text or a table
  kQhull,      ///< Qhull text, if it begins with an integer: what Qhull's own programs read
};

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

/// The two integers that Qhull text begins with: behind the first one a comment may stand, and lines of them
/// before the second; numbers may follow on its line.
struct QhullHeader {
  std::optional<std::size_t> dimension, count;
  const char* place = nullptr;  ///< of the dimension; where there is no count, of what stands in its place
  const char* data = nullptr;   ///< behind the count
};
QhullHeader read_qhull_header(const TextSource& source);

}  // namespace ndhull
