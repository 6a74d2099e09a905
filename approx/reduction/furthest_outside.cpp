#include "approx/reduction/furthest_outside.h"

#include <algorithm>
#include <cstddef>

namespace ndhull {

void keep_furthest(std::vector<OutsidePoint>& points) {
  constexpr std::size_t kNamed = 4096;
  std::sort(points.begin(), points.end(), [](const OutsidePoint& a, const OutsidePoint& b) {
    return a.simplex != b.simplex ? a.simplex < b.simplex : a < b;
  });
  const auto is_same = [](const OutsidePoint& a, const OutsidePoint& b) { return a.simplex == b.simplex; };
  points.erase(std::unique(points.begin(), points.end(), is_same), points.end());
  std::sort(points.begin(), points.end());
  if (points.size() > kNamed) points.resize(kNamed);
}

}  // namespace ndhull
