// Header, shape, type, size; then one pass over the data: a test for NaN and infinity where they stand,
// or the conversion.
#include "tools/io/npy_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/machine/blocks.h"
#include "tools/io/npy_header.h"

namespace ndhull {
namespace {

static_assert(std::endian::native == std::endian::little, ".npy data are used as they stand in the file");

/// Place of the first NaN or infinity, or `count`.
///
/// Adding one to the exponent field carries into the sign bit exactly when the field is all ones. The or of
/// a block says whether one is in it: no branch for each element, and compilers vectorize it.
template <class Bits, int MantissaBits>
std::size_t find_non_finite(const char* data, std::size_t count) {
  constexpr int kSignBit = static_cast<int>(sizeof(Bits)) * 8 - 1;
  constexpr Bits kOne = Bits{1} << MantissaBits;
  constexpr Bits kExponent = (Bits{1} << kSignBit) - kOne;
  constexpr std::size_t kBlock = 4096;  // elements: well inside the first-level cache
  const auto carry = [data](std::size_t index) {
    Bits bits;
    std::memcpy(&bits, data + index * sizeof(Bits), sizeof(Bits));
    return static_cast<Bits>((bits & kExponent) + kOne);
  };
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t end = std::min(count, begin + kBlock);
    Bits carries = 0;
    for (std::size_t k = begin; k < end; ++k) carries |= carry(k);
    if (carries >> kSignBit == 0) continue;
    for (std::size_t k = begin; k < end; ++k) {
      if (carry(k) >> kSignBit != 0) return k;
    }
  }
  return count;
}

/// The same, by all threads. `size`: bytes of an element, 4 or 8.
std::size_t find_non_finite(const char* data, std::size_t count, std::size_t size) {
  constexpr std::size_t kPart = std::size_t{1} << 17;
  std::vector<std::size_t> places((count + kPart - 1) / kPart);
  for_each_block(count, kPart, [&](std::size_t begin, std::size_t end) {
    const char* const from = data + begin * size;
    places[begin / kPart] = begin + (size == 4 ? find_non_finite<std::uint32_t, 23>(from, end - begin)
                                               : find_non_finite<std::uint64_t, 52>(from, end - begin));
  });
  for (std::size_t part = 0; part < places.size(); ++part)
    if (places[part] != std::min(count, (part + 1) * kPart)) return places[part];
  return count;
}

/// The numbers of a file, or of its chosen columns, and where they stand there.
struct Numbers {
  std::string name;  ///< of the file
  std::string type;  ///< NumPy's spelling
  const char* data;
  std::size_t rows, columns;
  bool fortran_order;
  std::vector<std::size_t> chosen;  ///< the columns' places in the file; empty: as they are

  std::size_t count() const { return rows * columns; }
  /// "[row, column]" of element `index`, counted from 0.
  std::string place_of(std::size_t index) const {
    const std::size_t row = fortran_order ? index % rows : index / columns,
                      column = fortran_order ? index / rows : index % columns;
    return fmt::format("[{}, {}]", row, chosen.empty() ? column : chosen[column]);
  }
};

[[noreturn]] void fail_not_finite(const Numbers& numbers, std::size_t index, double value) {
  throw Error(
      ErrorCode::kNotFinite,
      fmt::format("{}, element {}: found {}, expected a finite number; remove the row or replace the value",
                  numbers.name, numbers.place_of(index), value));
}

/// IEEE binary16 to double, exactly.
double half_to_double(std::uint16_t bits) {
  const int exponent = bits >> 10 & 0x1F;
  const double mantissa = bits & 0x3FF;
  double value = 0.0;
  if (exponent == 0) {
    value = std::ldexp(mantissa, -24);
  } else if (exponent == 0x1F) {
    value = mantissa == 0.0 ? HUGE_VAL : std::nan("");
  } else {
    value = std::ldexp(mantissa + 1024.0, exponent - 25);
  }
  return (bits & 0x8000) != 0 ? -value : value;
}

template <class Integer>
void convert_integers(const Numbers& numbers, std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    Integer element;
    std::memcpy(&element, numbers.data + k * sizeof(Integer), sizeof(Integer));
    values[k] = static_cast<double>(element);
    if constexpr (sizeof(Integer) == 8) {
      // 2^63 and 2^64 are what the largest integers round to; converting them back would overflow.
      const bool in_range = values[k] < std::ldexp(1.0, std::is_signed_v<Integer> ? 63 : 64);
      if (!in_range || static_cast<Integer>(values[k]) != element) {
        throw Error(ErrorCode::kBadNumber,
                    fmt::format("{}, element {}: found {}, expected an integer that a double holds exactly; "
                                "scale or shift the data",
                                numbers.name, numbers.place_of(k), element));
      }
    }
  }
}

void convert_halves(const Numbers& numbers, std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    std::uint16_t element = 0;
    std::memcpy(&element, numbers.data + k * sizeof element, sizeof element);
    values[k] = half_to_double(element);
    if (!std::isfinite(values[k])) fail_not_finite(numbers, k, values[k]);
  }
}

/// Bytes of one element, 0 for a type that is not read.
std::size_t element_size(const std::string& type) {
  if (type.size() != 3 || (type[0] != '<' && type[0] != '|' && type[0] != '=')) return 0;
  const auto size = static_cast<std::size_t>(type[2] - '0');
  if (type[1] == 'f') return size == 2 || size == 4 || size == 8 ? size : 0;
  if (type[1] == 'i' || type[1] == 'u') return size == 1 || size == 2 || size == 4 || size == 8 ? size : 0;
  return 0;
}

void convert(const Numbers& numbers, std::vector<double>& values) {
  const std::string kind = numbers.type.substr(1);
  if (kind == "f2") return convert_halves(numbers, values);
  if (kind == "i1") return convert_integers<std::int8_t>(numbers, values);
  if (kind == "i2") return convert_integers<std::int16_t>(numbers, values);
  if (kind == "i4") return convert_integers<std::int32_t>(numbers, values);
  if (kind == "i8") return convert_integers<std::int64_t>(numbers, values);
  if (kind == "u1") return convert_integers<std::uint8_t>(numbers, values);
  if (kind == "u2") return convert_integers<std::uint16_t>(numbers, values);
  if (kind == "u4") return convert_integers<std::uint32_t>(numbers, values);
  convert_integers<std::uint64_t>(numbers, values);
}

/// Checks axes, type and size of the file.
void check_header(const NpyHeader& header, std::size_t file_size, const std::string& name) {
  if (header.shape.size() != 2) {
    throw Error(ErrorCode::kBadHeader,
                fmt::format("{}: found an array with {} axes, expected 2 (points, coordinates); save "
                            "array.reshape(-1, d)",
                            name, header.shape.size()));
  }
  const std::size_t size = element_size(header.type);
  if (size == 0) {
    throw Error(
        ErrorCode::kUnknownType,
        fmt::format("{}: found elements of type {}, expected <f4, <f8, <f2 or little-endian integers; save "
                    "array.astype('<f8')",
                    name, printable(header.type)));
  }
  if (header.shape[1] == 0) {
    throw Error(
        ErrorCode::kDimensionTooLow,
        fmt::format("{}: found shape ({}, 0), expected 1 or more columns; save the coordinates as columns",
                    name, header.shape[0]));
  }
  if (header.shape[0] == 0) {
    throw Error(ErrorCode::kEmptyInput,
                fmt::format("{}: found shape (0, {}), expected 1 or more rows; check what "
                            "wrote the file",
                            name, header.shape[1]));
  }
  std::size_t count = 0;
  std::size_t bytes = 0;
  const bool too_large = __builtin_mul_overflow(header.shape[0], header.shape[1], &count) ||
                         __builtin_mul_overflow(count, size, &bytes);
  const std::size_t found = file_size - header.data_offset;
  if (too_large || found < bytes) {
    throw Error(ErrorCode::kTruncated,
                fmt::format("{}: found {} bytes of data, expected {} x {} elements of {} bytes; "
                            "copy or save the file again",
                            name, found, header.shape[0], header.shape[1], size));
  }
  if (found > bytes) {
    throw Error(
        ErrorCode::kWrongCount,
        fmt::format(
            "{}: found {} bytes of data, expected {} ({} x {} elements of {} bytes); save one array a "
            "file",
            name, found, bytes, header.shape[0], header.shape[1], size));
  }
}

/// The chosen columns alone, row by row; `numbers` are these from then on.
FileBytes copy_chosen(Numbers& numbers, std::size_t size) {
  FileBytes copy = FileBytes::of_size(numbers.rows * numbers.chosen.size() * size);
  char* to = copy.writable();
  for (std::size_t row = 0; row < numbers.rows; ++row) {
    for (const std::size_t column : numbers.chosen) {
      const std::size_t index =
          numbers.fortran_order ? column * numbers.rows + row : row * numbers.columns + column;
      std::memcpy(to, numbers.data + index * size, size);
      to += size;
    }
  }
  numbers.data = copy.view().data();
  numbers.columns = numbers.chosen.size();
  numbers.fortran_order = false;
  return copy;
}

}  // namespace

PointFile read_npy(FileBytes bytes, const std::string& name, const ColumnChoice& columns,
                   std::size_t kept_bytes) {
  const NpyHeader header = read_npy_header(bytes.view(), name);
  check_header(header, bytes.view().size(), name);
  Numbers numbers{name,
                  header.type,
                  bytes.view().data() + header.data_offset,
                  header.shape[0],
                  header.shape[1],
                  header.fortran_order,
                  {}};
  const std::size_t size = element_size(header.type);
  if (!columns.is_all()) {
    numbers.chosen = columns.resolve({}, numbers.columns, name);
    bytes = copy_chosen(numbers, size);
  }

  PointView view;
  view.rows = numbers.rows;
  view.dimension = numbers.columns;
  view.row_stride = numbers.fortran_order ? 1 : view.dimension;
  view.column_stride = numbers.fortran_order ? view.rows : 1;

  const std::size_t count = numbers.count();
  const bool is_float = header.type.ends_with("f4");
  const bool is_double = header.type.ends_with("f8");
  if (!is_float && !is_double) {
    std::vector<double> values(count);
    convert(numbers, values);
    view.data = values.data();
    return {name, std::move(values), view};
  }
  const auto value_at = [&](std::size_t index) {
    float single = 0.0F;
    double value = 0.0;
    std::memcpy(is_float ? static_cast<void*>(&single) : &value, numbers.data + index * size, size);
    return is_float ? static_cast<double>(single) : value;
  };

  const bool gives_back = bytes.is_mapping() && bytes.view().size() > kept_bytes;
  constexpr std::size_t kChunk = std::size_t{1} << 22;  // elements: a file need not fit into memory
  std::size_t bad = 0;
  for (std::size_t chunk = 0; chunk < count && bad == chunk; chunk += kChunk) {
    const std::size_t used = std::min(kChunk, count - chunk);
    bad = chunk + find_non_finite(numbers.data + chunk * size, used, size);
    if (gives_back) bytes.give_back(header.data_offset + (chunk + used) * size);
  }
  if (bad != count) fail_not_finite(numbers, bad, value_at(bad));
  // NumPy aligns to 64 bytes (16 before 1.14), other writers need not.
  if (reinterpret_cast<std::uintptr_t>(numbers.data) % size == 0) {
    view.type = is_float ? ScalarType::kFloat32 : ScalarType::kFloat64;
    view.data = numbers.data;
    view.is_file_mapping = gives_back;
    return {name, std::move(bytes), view};
  }
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = value_at(k);
  view.data = values.data();
  return {name, std::move(values), view};
}

}  // namespace ndhull
