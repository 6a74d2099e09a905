#include "tools/io/plane_writer.h"

#include <vector>

#include "tools/io/file_bytes.h"
#include "tools/io/npy_header.h"
#include "tools/io/output_file.h"

namespace ndhull {
namespace {

void write_ine(OutputFile& file, std::size_t count, std::size_t dimension, const FillPlane& planes) {
  file.print("H-representation\nbegin\n{} {} real\n", count, dimension + 1);
  std::vector<double> row(dimension + 1);
  for (std::size_t index = 0; index < count; ++index) {
    planes(index, row.data());
    // n.x + b <= 0 is -b - n.x >= 0. Subtracting from zero leaves no minus zeros.
    file.print("{:.17g}", 0.0 - row[dimension]);
    for (std::size_t k = 0; k < dimension; ++k) file.print(" {:.17g}", 0.0 - row[k]);
    file.write("\n");
  }
  file.write("end\n");
}

void write_npy(OutputFile& file, std::size_t count, std::size_t dimension, const FillPlane& planes) {
  file.write(make_npy_header("<f8", {count, dimension + 1}));
  std::vector<double> row(dimension + 1);
  for (std::size_t index = 0; index < count; ++index) {
    planes(index, row.data());
    file.write({reinterpret_cast<const char*>(row.data()), row.size() * sizeof(double)});
  }
}

/// A row a line, without names: a table that `intersect`, `contains` and `verify` read. Names alone where
/// there is no row: they tell the dimension.
void write_table(OutputFile& file, std::size_t count, std::size_t dimension, char separator,
                 const FillPlane& planes) {
  if (count == 0) {
    for (std::size_t k = 1; k <= dimension; ++k) file.print("n{}{}", k, separator);
    file.write("offset\n");
  }
  std::vector<double> row(dimension + 1);
  for (std::size_t index = 0; index < count; ++index) {
    planes(index, row.data());
    for (std::size_t k = 0; k <= dimension; ++k)
      file.print("{:.17g}{}", row[k], k == dimension ? '\n' : separator);
  }
}

void write_qhull_text(OutputFile& file, std::size_t count, std::size_t dimension, const FillPlane& planes) {
  file.print("{}\n{}\n", dimension + 1, count);
  std::vector<double> row(dimension + 1);
  for (std::size_t index = 0; index < count; ++index) {
    planes(index, row.data());
    for (const double number : row) file.print("{:6.17g} ", number);
    file.write("\n");
  }
}

}  // namespace

void write_planes(const std::string& path, std::size_t count, std::size_t dimension,
                  const FillPlane& planes) {
  OutputFile file(path);
  const std::string extension = extension_of(path);
  if (extension == "ine") {
    write_ine(file, count, dimension, planes);
  } else if (extension == "npy") {
    write_npy(file, count, dimension, planes);
  } else if (const char separator = table_separator(extension); separator != '\0') {
    write_table(file, count, dimension, separator, planes);
  } else {
    write_qhull_text(file, count, dimension, planes);
  }
  file.commit();
}

}  // namespace ndhull
