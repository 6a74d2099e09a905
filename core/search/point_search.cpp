// Searches in a tree of points, compiled for each instruction set and chosen at run time.
#include "core/search/point_tree.h"

#include "core/machine/simd_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/search/point_search.cpp"
#include <hwy/foreach_target.h>
// foreach_target first.
#include <hwy/highway.h>

#include "core/machine/blocks.h"
#include "core/search/tree_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace ndhull {
namespace HWY_NAMESPACE {

void find_furthest_any(const PointTree& tree, std::span<const double> normals,
                       std::span<FurthestPoint> furthest) {
  with_tree_dimension(tree, [&](auto d) {
    TreeSearch<d> search(tree);
    for (std::size_t i = 0; i < furthest.size(); ++i)
      furthest[i] = search.run(normals.data() + i * tree.dimension(), furthest[i].dot);
  });
}

void find_above_any(const PointTree& tree, const double* normal, double least,
                    std::vector<FurthestPoint>& found) {
  with_tree_dimension(tree, [&](auto d) { TreeSearch<d>(tree).collect(normal, least, found); });
}

}  // namespace HWY_NAMESPACE
}  // namespace ndhull
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ndhull {

void find_furthest(const PointTree& tree, std::span<const double> normals,
                   std::span<FurthestPoint> furthest) {
  constexpr std::size_t kDirectionsAtATime = 64;
  for_each_block(furthest.size(), kDirectionsAtATime, [&](std::size_t begin, std::size_t end) {
    NDHULL_BEST_OF(find_furthest_any)
    (tree, normals.subspan(begin * tree.dimension(), (end - begin) * tree.dimension()),
     furthest.subspan(begin, end - begin));
  });
}

void find_above(const PointTree& tree, std::span<const double> normal, double least,
                std::vector<FurthestPoint>& found) {
  NDHULL_BEST_OF(find_above_any)(tree, normal.data(), least, found);
}

}  // namespace ndhull
#endif
