#include "tools/io/point_writer.h"

#include "tools/io/file_bytes.h"
#include "tools/io/npy_header.h"

namespace ndhull {

PointWriter::PointWriter(const std::string& path, const PointFileHead& head) : file_(path) {
  const std::string extension = extension_of(path);
  if (extension == "npy") {
    is_npy_ = true;
    const bool is_float = head.scalar == ScalarType::kFloat32;
    file_.write(make_npy_header(is_float ? "<f4" : "<f8", {head.rows, head.dimension}));
  } else if (const char separator = table_separator(extension); separator != '\0') {
    separator_ = separator;
  } else if (extension == "ext") {
    is_ext_ = true;
    file_.print("V-representation\nbegin\n{} {} real\n", head.rows, head.dimension + 1);
  } else {
    file_.print("{} {}\n{}\n", head.dimension, head.comment, head.rows);
  }
}

void PointWriter::write(const PointView& block) {
  if (is_npy_) {
    const std::size_t size = block.type == ScalarType::kFloat32 ? sizeof(float) : sizeof(double);
    file_.write({static_cast<const char*>(block.data), block.rows * block.dimension * size});
    return;
  }
  for (std::size_t row = 0; row < block.rows; ++row) {
    if (is_ext_) file_.write("1 ");
    for (std::size_t k = 0; k < block.dimension; ++k) {
      if (k > 0) file_.write({&separator_, 1});
      file_.print("{}", block.at(row, k));
    }
    file_.write("\n");
  }
}

void PointWriter::commit() {
  if (is_ext_) file_.write("end\n");
  file_.commit();
}

}  // namespace ndhull
