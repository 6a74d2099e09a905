#include "core/growth/growth_region.h"

#include <algorithm>

namespace ndhull {

void sort_by_height(std::vector<RegionApex>& apexes) {
  std::sort(apexes.begin(), apexes.end(), [](const RegionApex& a, const RegionApex& b) {
    return a.height != b.height ? a.height > b.height : a.point < b.point;
  });
}

}  // namespace ndhull
