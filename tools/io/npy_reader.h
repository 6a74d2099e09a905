// NumPy arrays as points, without a copy where the numbers are float or double.
#pragma once

#include <cstddef>
#include <string>

#include "tools/io/point_reader.h"

namespace ndhull {

/// Makes points of a two-dimensional array, one row a point.
///
/// Types     <f4, <f8: a view of `bytes` (a copy only if they are not aligned). <f2, <i1 .. <i8,
///           <u1 .. <u8: converted to float64; an integer that is no double is an error.
/// Throws    kUnknownType    another type (big-endian, complex, records, ...)
///           kBadHeader      another number of axes
///           kDimensionTooLow, kEmptyInput   no columns, no rows
///           kTruncated, kWrongCount         fewer or more bytes than the shape says
///           kNotFinite, kBadNumber          with row and column counted from 0, as NumPy does
/// `kept_bytes`: as read_points has it.
/// `columns`: which are coordinates, copied; others may hold any number.
PointFile read_npy(FileBytes bytes, const std::string& name, const ColumnChoice& columns,
                   std::size_t kept_bytes);

}  // namespace ndhull
