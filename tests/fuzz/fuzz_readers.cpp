// The readers of points and halfspaces: any bytes, read as every format.
//
// A reader either returns what its header promises (rows, columns, finite numbers) or throws ndhull::Error
// with one line that begins with the input's name. Everything else, an allocation beyond the input's size
// included, is a crash.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "tools/io/file_bytes.h"
#include "tools/io/halfspace_reader.h"
#include "tools/io/point_reader.h"

namespace {

constexpr const char* kPaths[] = {"input", "input.csv", "input.tsv", "input.npy", "input.ext", "input.ine"};

void check_message(const ndhull::Error& error) {
  const std::string_view message = error.what();
  NDHULL_CHECK(message.starts_with("input") || message.starts_with("--columns"));
  NDHULL_CHECK(message.find('\n') == std::string_view::npos);
}

void try_points(std::string_view content, const char* path, const ndhull::ColumnChoice& columns) {
  try {
    const ndhull::PointFile file = ndhull::parse_points(ndhull::FileBytes::copy_of(content), path, columns);
    const ndhull::PointView points = file.view();
    NDHULL_CHECK(points.rows > 0 && points.dimension > 0);
    for (std::size_t row = 0; row < points.rows; ++row) {
      for (std::size_t column = 0; column < points.dimension; ++column) {
        NDHULL_CHECK(std::isfinite(points.at(row, column)));
      }
    }
  } catch (const ndhull::Error& error) {
    check_message(error);
  }
}

void try_halfspaces(std::string_view content, const char* path) {
  try {
    const ndhull::HalfspaceFile file = ndhull::parse_halfspaces(ndhull::FileBytes::copy_of(content), path);
    NDHULL_CHECK(file.dimension > 0);
    NDHULL_CHECK(file.rows.size() == file.count * (file.dimension + 1));
    for (const double value : file.rows) NDHULL_CHECK(std::isfinite(value));
    NDHULL_CHECK(!file.interior_point || file.interior_point->size() == file.dimension);
  } catch (const ndhull::Error& error) {
    check_message(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  for (const char* path : kPaths) {
    try_points(content, path, {});
    try_points(content, path, ndhull::ColumnChoice("2,1"));
    try_halfspaces(content, path);
  }
  return 0;
}
