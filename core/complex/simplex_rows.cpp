#include "core/complex/simplex_rows.h"

#include <algorithm>

#include "core/ids.h"

namespace ndhull {

void SimplexRows::set_part(std::uint32_t first, std::size_t at, std::span<const std::uint16_t> others) {
  const std::size_t width = rank_ - 1;
  std::copy(others.begin(), others.end(), others_.data() + at * width);
  Part& part = parts_[first];
  part.at = at;
  const auto rows = static_cast<std::uint32_t>(others.size() / width);
  for (std::uint32_t row = 0; row < rows; ++row) {
    const std::uint32_t second = others[row * width];
    if (part.runs.empty() || part.runs.back().second != second) part.runs.push_back({second, row});
  }
  part.runs.push_back({static_cast<std::uint32_t>(kMostVertices), rows});
  part.runs.shrink_to_fit();
}

void SimplexRows::number() {
  for (std::size_t first = 0; first < parts_.size(); ++first)
    begin_[first + 1] = narrow_id(std::size_t{begin_[first]} +
                                  (parts_[first].runs.empty() ? 0 : parts_[first].runs.back().begin));
}

void SimplexRows::vertices_of(std::uint32_t row, std::uint32_t* vertices) const {
  const auto after = std::upper_bound(begin_.begin(), begin_.end(), row);
  const auto first = static_cast<std::size_t>(after - begin_.begin() - 1);
  vertices[0] = static_cast<std::uint32_t>(first);
  const std::size_t place = parts_[first].at + (row - begin_[first]);
  std::copy_n(others_.data() + place * (rank_ - 1), rank_ - 1, vertices + 1);
}

}  // namespace ndhull
