// Points to a file that read_points and other programs read.
#pragma once

#include <cstddef>
#include <string>

#include "core/points.h"
#include "tools/io/output_file.h"

namespace ndhull {

/// What stands in front of the points of a file.
struct PointFileHead {
  std::size_t rows;
  std::size_t dimension;
  ScalarType scalar = ScalarType::kFloat64;
  std::string comment = {};  ///< for Qhull text: behind the dimension
};

/// Writes points in the format that the path's extension names: .npy, .csv, .tsv, .ext (V-representation of
/// cdd and lrs), otherwise Qhull text. Numbers in text read back as the same doubles.
///
/// Target  as OutputFile; nothing is written before `commit`.
/// Throws  Error kFileWrite.
class PointWriter {
 public:
  PointWriter(const std::string& path, const PointFileHead& head);
  /// `block`: contiguous rows of the head's type; may be called several times.
  void write(const PointView& block);
  void commit();

 private:
  OutputFile file_;
  bool is_npy_ = false;
  bool is_ext_ = false;
  char separator_ = ' ';
};

}  // namespace ndhull
