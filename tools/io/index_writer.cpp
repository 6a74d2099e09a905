#include "tools/io/index_writer.h"

#include <cstdint>

#include "tools/io/file_bytes.h"
#include "tools/io/npy_header.h"
#include "tools/io/output_file.h"

namespace ndhull {

void write_indices(const std::string& path, std::span<const PointId> indices) {
  OutputFile file(path);
  if (extension_of(path) == "npy") {
    file.write(make_npy_header("<i8", {indices.size()}));
    for (const PointId point : indices) {
      const std::int64_t index = point.value;
      file.write({reinterpret_cast<const char*>(&index), sizeof index});
    }
  } else {
    // Qhull's form begins with their number, a table does not.
    if (table_separator(extension_of(path)) == '\0') file.print("{}\n", indices.size());
    for (const PointId point : indices) file.print("{}\n", point.value);
  }
  file.commit();
}

}  // namespace ndhull
