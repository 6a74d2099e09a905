#include "tools/command_line/warnings.h"

#include <fmt/format.h>

#include <cstdio>

namespace ndhull {

void warn_of_open_subspace(std::size_t rank, std::size_t dimension) {
  fmt::print(stderr,
             "ndhull: warning: the points lie in a {}-d subspace of {}-d, and the planes written bound them "
             "within it only; --equations adds the planes that bound them off it\n",
             rank, dimension);
}

void warn_of_flat_volume(std::size_t rank, std::size_t dimension) {
  fmt::print(stderr,
             "ndhull: warning: the points span {0} of {1} dimensions: the hull is the one in that subspace, "
             "its volume {0}-dimensional and its areas {2}-dimensional\n",
             rank, dimension, rank == 0 ? 0 : rank - 1);
}

void warn_of_missing_vertices(HullStatus status) {
  if (status == HullStatus::kComplete) return;
  fmt::print(stderr, "ndhull: warning: {}: vertices are missing, the intersection is inside those written\n",
             to_string(status));
}

}  // namespace ndhull
