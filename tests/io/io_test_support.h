// What the tests of readers and writers share: files of a test, arrays as NumPy saves them, error codes.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/points.h"
#include "tools/io/npy_header.h"
#include "tools/io/point_reader.h"

namespace ndhull {

/// A folder of its own for each test, gone when the test ends.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "ndhull-io-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) ADD_FAILURE() << "no scratch folder";
    folder_ = pattern;
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, std::string_view content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

 private:
  std::filesystem::path folder_;
};

inline PointFile parse(std::string_view content, const std::string& path = "points.txt",
                       const ColumnChoice& columns = {}) {
  return parse_points(FileBytes::copy_of(content), path, columns);
}

/// All coordinates, row after row.
inline std::vector<double> rows_of(const PointView& view) {
  std::vector<double> values;
  for (std::size_t row = 0; row < view.rows; ++row) {
    for (std::size_t column = 0; column < view.dimension; ++column) values.push_back(view.at(row, column));
  }
  return values;
}

/// Bytes of an array whose elements are given in the order of the file.
template <class T>
std::string npy_bytes(std::string_view type, const std::vector<std::size_t>& shape,
                      const std::vector<T>& elements, bool fortran_order = false) {
  std::string bytes = make_npy_header(type, shape);
  if (fortran_order) bytes.replace(bytes.find("False"), 5, "True ");
  return bytes.append(reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(T));
}

/// Runs `action`, which must throw an Error of one line that names its place with `mention`.
template <class Action>
void expect_error(ErrorCode code, std::string_view mention, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "nothing was thrown, expected " << to_string(code);
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(to_string(error.code()), to_string(code)) << message;
    EXPECT_NE(message.find(mention), std::string::npos) << message << "\ndoes not mention " << mention;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
  }
}

/// The content, read as points from `path`, is refused.
inline void expect_refused(ErrorCode code, std::string_view mention, std::string_view content,
                           const std::string& path = "points.txt") {
  SCOPED_TRACE(std::string(content.substr(0, 60)));
  expect_error(code, mention, [&] { parse(content, path); });
}

}  // namespace ndhull
