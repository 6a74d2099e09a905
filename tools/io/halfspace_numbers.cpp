#include "tools/io/halfspace_numbers.h"

#include <algorithm>
#include <utility>

namespace ndhull {
namespace {

/// Ascending rows of the file, each once.
std::vector<std::uint32_t> rows_of(std::span<const std::uint32_t> halfspaces, const HalfspaceFile& file) {
  std::vector<std::uint32_t> rows;
  rows.reserve(halfspaces.size());
  for (const std::uint32_t halfspace : halfspaces) rows.push_back(file.row_of(halfspace));
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

}  // namespace

void number_as_in_file(HalfspaceIntersection& intersection, const HalfspaceFile& file) {
  intersection.halfspace_count = file.file_row_count;
  if (file.file_row.empty()) return;
  intersection.equalities = rows_of(intersection.equalities, file);
  intersection.non_redundant = rows_of(intersection.non_redundant, file);
  IdRows renumbered;
  for (std::size_t vertex = 0; vertex + 1 < intersection.halfspaces_of.begin.size(); ++vertex)
    renumbered.append(rows_of(intersection.halfspaces_of.row(vertex), file));
  if (!intersection.halfspaces_of.begin.empty()) intersection.halfspaces_of = std::move(renumbered);
  for (HalfspaceWeight& term : intersection.proof) {
    if (file.is_reversed[term.halfspace]) term.weight = -term.weight;
    term.halfspace = file.row_of(term.halfspace);
  }
}

}  // namespace ndhull
