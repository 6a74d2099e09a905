#include "approx/slabs/facet_parts.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "approx/slabs/slab_growth.h"
#include "core/dimension_switch.h"
#include "core/ids.h"
#include "core/machine/blocks.h"
#include "core/machine/prefetch.h"

namespace ndhull {
namespace {

/// A part of a facet that hangs together with none of its others.
struct Stray {
  std::uint32_t facet;
  std::vector<std::uint32_t> simplices;
};

/// How far the simplices reach below the height of the plane, which is measured if it was not yet.
double depth_below(const SimplicialComplex& complex, const WidthSpace& space,
                   std::span<const std::uint32_t> simplices, FittedPlane& plane, PlaneFitWork& work) {
  if (!is_measured(plane)) plane = measure_plane(space, plane.normal, {}, work);
  double low = HUGE_VAL;
  const double* normal = plane.normal.data();
  for (const std::uint32_t simplex : simplices) {
    for (const PointId id : complex.vertices(SimplexId{simplex})) {
      const double* z = space.row(space.row_of(id));
      double dot = 0.0;
      for (std::size_t k = 0; k < complex.rank; ++k) dot += normal[k] * z[k];
      low = std::min(low, dot);
    }
  }
  return plane.height - low;
}

/// Finds the connected parts of some facets, one after the other. One thread's.
class PartFinder {
 public:
  /// is_met: per row of the complex, 0 for those of the facets to come. Several finders may share it: what
  /// each reads of rows of other facets than its own counts for nothing.
  PartFinder(const SimplicialComplex& complex, const Covering& covering, std::vector<std::uint8_t>& is_met)
      : complex_(complex), covering_(covering), is_met_(is_met) {}

  /// Adds all parts but the largest of a facet, the first of several; each in ascending order.
  void add_strays(std::uint32_t facet, std::span<const std::uint32_t> members, std::vector<Stray>& strays) {
    met_.clear();
    flood(members.front(), facet);
    if (met_.size() == members.size()) return;
    std::vector<std::size_t> begin{0, met_.size()};  // of the parts
    for (const std::uint32_t row : members) {
      if (is_met(row)) continue;
      flood(row, facet);
      begin.push_back(met_.size());
    }
    std::size_t largest = 0;
    for (std::size_t part = 1; part + 1 < begin.size(); ++part)
      if (begin[part + 1] - begin[part] > begin[largest + 1] - begin[largest]) largest = part;
    for (std::size_t part = 0; part + 1 < begin.size(); ++part) {
      if (part == largest) continue;
      Stray stray{facet, {met_.data() + begin[part], met_.data() + begin[part + 1]}};
      std::sort(stray.simplices.begin(), stray.simplices.end());
      strays.push_back(std::move(stray));
    }
  }

 private:
  /// met_: what a row reaches within its facet, itself first. Which neighbours these are is not to be
  /// foreseen: they are listed without a branch for each.
  void flood(std::uint32_t start, std::uint32_t facet) {
    constexpr std::size_t kRowsAhead = 4;
    std::size_t next = met_.size();
    met_.push_back(start);
    meet(start);
    for (; next < met_.size(); ++next) {
      prefetch(complex_.neighbours(SimplexId{met_[std::min(next + kRowsAhead, met_.size() - 1)]}).data(),
               complex_.rank);
      std::array<std::uint32_t, kMaxRank> open;
      std::size_t count = 0;
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{met_[next]})) {
        open[count] = neighbour.value;
        count += static_cast<std::size_t>(covering_.facet_of[neighbour.value] == facet) &
                 static_cast<std::size_t>(!is_met(neighbour.value));
      }
      for (std::size_t i = 0; i < count; ++i) meet(open[i]);
      met_.insert(met_.end(), open.begin(), open.begin() + count);
    }
  }

  bool is_met(std::uint32_t row) const {
    return std::atomic_ref<std::uint8_t>(is_met_[row]).load(std::memory_order_relaxed) != 0;
  }
  void meet(std::uint32_t row) {
    std::atomic_ref<std::uint8_t>(is_met_[row]).store(1, std::memory_order_relaxed);
  }

  const SimplicialComplex& complex_;
  const Covering& covering_;
  std::vector<std::uint8_t>& is_met_;
  std::vector<std::uint32_t> met_;
};

/// All connected parts of the facets but the largest of each, in the order of their first simplex.
std::vector<Stray> find_strays(const SimplicialComplex& complex, const Covering& covering,
                               std::span<const std::uint8_t> is_asked) {
  constexpr std::size_t kFacetsAtATime = 16;
  const FacetMembers members_of(covering);
  std::vector<std::uint8_t> is_met(complex.row_count, 0);
  std::vector<std::vector<Stray>> of_block((covering.planes.size() + kFacetsAtATime - 1) / kFacetsAtATime);
  tbb::enumerable_thread_specific<PartFinder> finders([&] { return PartFinder(complex, covering, is_met); });
  for_each_block(covering.planes.size(), kFacetsAtATime, [&](std::size_t begin, std::size_t end) {
    PartFinder& finder = finders.local();
    for (auto facet = static_cast<std::uint32_t>(begin); facet < end; ++facet) {
      const std::span<const std::uint32_t> members = members_of.of(facet);
      if (members.size() > 1 && (is_asked.empty() || is_asked[facet] != 0))
        finder.add_strays(facet, members, of_block[begin / kFacetsAtATime]);
    }
  });
  std::vector<Stray> strays;
  for (std::vector<Stray>& some : of_block) std::move(some.begin(), some.end(), std::back_inserter(strays));
  std::sort(strays.begin(), strays.end(),
            [](const Stray& a, const Stray& b) { return a.simplices.front() < b.simplices.front(); });
  return strays;
}

}  // namespace

void gather_strays(const SimplicialComplex& complex, const WidthSpace& space, double width,
                   Covering& covering, std::vector<float>& depth_of, PlaneFitWork& work,
                   std::span<const std::uint8_t> is_asked) {
  const std::vector<Stray> strays = find_strays(complex, covering, is_asked);
  std::vector<std::uint32_t> hosts;
  for (const Stray& stray : strays) {
    hosts.clear();
    for (const std::uint32_t simplex : stray.simplices) {
      for (const SimplexId neighbour : complex.neighbours(SimplexId{simplex}))
        if (covering.facet_of[neighbour.value] != stray.facet)
          hosts.push_back(covering.facet_of[neighbour.value]);
    }
    std::sort(hosts.begin(), hosts.end());
    hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
    double best_depth = kDepthRoom * width;
    std::uint32_t best = kNone;
    for (const std::uint32_t host : hosts) {
      const double depth = depth_below(complex, space, stray.simplices, covering.planes[host], work);
      if (depth >= best_depth) continue;
      best_depth = depth;
      best = host;
    }
    if (best == kNone) continue;
    for (const std::uint32_t simplex : stray.simplices) {
      covering.facet_of[simplex] = best;
      depth_of[simplex] = rounded_up_depth(best_depth);
    }
  }
}

}  // namespace ndhull
