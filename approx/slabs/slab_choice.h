// Which of many slabs to take: few that together hold every simplex that any of them holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

/// What a slab holds: places [begin, end) of a list of members.
struct MemberRange {
  std::size_t begin = 0, end = 0;
};

/// Greedy: the slab with the largest gain first, where a simplex counts the more the fewer slabs hold it;
/// then those are dropped, last chosen first, that others have made superfluous. Ascending in the order of
/// choice.
///
/// Shapes  members: rows of the complex, those of each slab in one range; hits: one a row of the complex, how
///         many slabs hold it, at most 255.
/// Cost    some passes over the members.
/// Paper   Chvatal. A greedy heuristic for the set-covering problem. Mathematics of Operations Research 4(3),
///         1979.
std::vector<std::uint32_t> choose_slabs(std::span<const MemberRange> slabs,
                                        std::span<const std::uint32_t> members,
                                        std::span<const std::uint8_t> hits);

}  // namespace ndhull
