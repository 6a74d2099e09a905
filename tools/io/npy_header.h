// The header of a .npy file, read and written.
// Source: NumPy Enhancement Proposal 1, "A Simple File Format for NumPy Arrays"; numpy.lib.format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ndhull {

/// What the header says about the bytes behind it.
struct NpyHeader {
  std::string type;            ///< NumPy's spelling, like <f8; [...] for a record type
  bool fortran_order = false;  ///< the first index runs fastest
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;  ///< [bytes] from the start of the file
};

/// Do the bytes begin as a .npy file does?
bool looks_like_npy(std::string_view bytes);

/// Reads the header, versions 1 to 3. `name` is for messages.
/// Throws  Error kBadHeader: not a .npy file, another version, or a header that is not NumPy's.
///         Error kTruncated: the file ends inside the header.
NpyHeader read_npy_header(std::string_view bytes, const std::string& name);

/// The bytes in front of the data of a C-order array; a multiple of 64, as NumPy aligns.
std::string make_npy_header(std::string_view type, const std::vector<std::size_t>& shape);

}  // namespace ndhull
