#include "approx/slab_cover.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

namespace ndhull {
namespace {

constexpr std::uint32_t kNone = 0xFFFF'FFFFu;

bool is_measured(const FittedPlane& plane) { return plane.height > 0.0; }

void count_up(std::uint8_t& count) {
  if (count < 255) ++count;
}

}  // namespace

SlabCover::Scratch::Scratch(const SlabCover& cover)
    : point_in_slab(cover.point_count_, 0),
      stamp(cover.complex_.row_count, 0),
      vertex_stamp(cover.space_.table().count(), 0) {}

SlabCover::SlabCover(const SimplicialComplex& complex, const WidthSpace& space, const SimplexRule* rule)
    : complex_(complex),
      space_(space),
      rule_(rule),
      scratch_([this] { return Scratch(*this); }),
      hits_(complex.row_count, 0) {
  for (std::uint32_t row = 0; row < space.vertex_count(); ++row)
    point_count_ = std::max<std::size_t>(point_count_, space.point_of(row).value + 1u);
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    live_count_ += complex.state[row] == SimplexState::kLive ? 1u : 0u;
}

Covering SlabCover::cover(double width, const CoverEffort& effort) {
  slabs_.clear();
  members_.clear();
  std::fill(hits_.begin(), hits_.end(), std::uint8_t{0});
  const auto count = static_cast<std::uint64_t>(complex_.row_count);
  // Seeds in an order that jumps over the whole hull: neighbouring rows are often neighbours on it.
  auto step =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(0.6180339887 * static_cast<double>(count)));
  while (std::gcd(step, count) != 1) ++step;
  // Seeds are taken in batches: what one slab of a batch holds can still seed another one. They are far
  // apart.
  std::vector<GrownSlab> batch(std::clamp<std::size_t>(count / 512, 1, 64));
  for (unsigned round = 1; round <= effort.choices; ++round) {
    std::uint64_t row = 0;
    std::size_t used = 0;
    for (std::uint64_t i = 0; i < count; ++i, row = row + step >= count ? row + step - count : row + step) {
      if (hits_[row] < round && complex_.state[row] == SimplexState::kLive)
        batch[used++].seed = static_cast<std::uint32_t>(row);
      if (used < batch.size() && i + 1 < count) continue;
      add_slabs(std::span<GrownSlab>(batch).first(used), width, effort);
      used = 0;
    }
  }
  return assign(choose_slabs(), width, effort);
}

void SlabCover::add_slabs(std::span<GrownSlab> batch, double width, const CoverEffort& effort) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batch.size()), [&](const auto& range) {
    Scratch& scratch = scratch_.local();
    for (std::size_t i = range.begin(); i != range.end(); ++i) grow_slab(batch[i], width, effort, scratch);
  });
  for (GrownSlab& slab : batch) {
    for (const std::uint32_t member : slab.members) count_up(hits_[member]);
    slabs_.push_back({std::move(slab.plane), members_.size(), members_.size() + slab.members.size()});
    members_.insert(members_.end(), slab.members.begin(), slab.members.end());
  }
}

// Is a neighbour's own vertex so near below the plane of the seed that a turned plane may hold both? Fitting
// turns a plane by about half the depth at most, so 2.5 widths are generous. Most simplices of a fine hull
// stay alone, and this is all they cost.
bool SlabCover::may_extend(std::uint32_t seed, const double* normal, double width) const {
  const double* on_plane = space_.row(space_.row_of(complex_.vertices(SimplexId{seed})[0]));
  for (const SimplexId neighbour : complex_.neighbours(SimplexId{seed})) {
    const auto back = complex_.neighbours(neighbour);
    const auto slot =
        static_cast<std::size_t>(std::find(back.begin(), back.end(), SimplexId{seed}) - back.begin());
    const double* apex = space_.row(space_.row_of(complex_.vertices(neighbour)[slot]));
    double depth = 0.0;
    for (std::size_t k = 0; k < complex_.rank; ++k) depth += normal[k] * (on_plane[k] - apex[k]);
    if (depth < 2.5 * width) return true;
  }
  return false;
}

/// Gathers in scratch.grown the simplices around the seed whose vertices are all less than `width` below the
/// plane, whose products scratch.fit.dots are. None when the seed is not among them.
void SlabCover::flood(std::uint32_t seed, const FittedPlane& plane, double width, Scratch& scratch) const {
  scratch.marked.clear();
  space_.table().rows_above(scratch.fit.dots.data(), plane.height - width, scratch.marked);
  for (const std::uint32_t row : scratch.marked) {
    if (row < space_.vertex_count()) scratch.point_in_slab[space_.point_of(row).value] = 1;
  }
  const auto is_in_slab = [&](std::uint32_t simplex) {
    std::uint8_t all = 1;
    for (const PointId id : complex_.vertices(SimplexId{simplex})) all &= scratch.point_in_slab[id.value];
    return all != 0;
  };
  std::vector<double> seed_centre;
  if (rule_ != nullptr) seed_centre = rule_->centrum_on(SimplexId{seed}, plane);
  std::vector<std::uint32_t>& grown = scratch.grown;
  grown.clear();
  ++scratch.flood;
  scratch.stamp[seed] = scratch.flood;
  if (is_in_slab(seed)) grown.push_back(seed);
  for (std::size_t i = 0; i < grown.size(); ++i) {
    for (const SimplexId neighbour : complex_.neighbours(SimplexId{grown[i]})) {
      if (scratch.stamp[neighbour.value] == scratch.flood) continue;
      scratch.stamp[neighbour.value] = scratch.flood;
      if (!is_in_slab(neighbour.value)) continue;
      if (rule_ == nullptr || rule_->wants(neighbour, plane, seed_centre)) grown.push_back(neighbour.value);
    }
  }
  for (const std::uint32_t row : scratch.marked) {
    if (row < space_.vertex_count()) scratch.point_in_slab[space_.point_of(row).value] = 0;
  }
}

/// The different vertices, as rows of the space.
std::span<const std::uint32_t> SlabCover::vertices_of(std::span<const std::uint32_t> members,
                                                      Scratch& scratch) const {
  scratch.vertices.clear();
  ++scratch.vertex_pass;
  for (const std::uint32_t simplex : members) {
    for (const PointId id : complex_.vertices(SimplexId{simplex})) {
      const std::uint32_t row = space_.row_of(id);
      if (scratch.vertex_stamp[row] == scratch.vertex_pass) continue;
      scratch.vertex_stamp[row] = scratch.vertex_pass;
      scratch.vertices.push_back(row);
    }
  }
  return scratch.vertices;
}

void SlabCover::grow_slab(GrownSlab& slab, double width, const CoverEffort& effort, Scratch& scratch) const {
  const std::uint32_t alone[] = {slab.seed};
  std::vector<double> normal(complex_.rank);
  space_.normal_of(complex_.plane(SimplexId{slab.seed}), normal.data());
  slab.members.assign(1, slab.seed);
  if (!may_extend(slab.seed, normal.data(), width)) {
    slab.plane = {std::move(normal), 0.0, 0.0};
    return;
  }
  std::span<const std::uint32_t> vertices = vertices_of(alone, scratch);
  slab.plane = measure_plane(space_, normal, vertices, scratch.fit);
  if (slab.plane.width() > width)
    slab.plane = narrow_plane(space_, slab.plane, vertices, 4 * effort.fit_steps, scratch.fit);
  flood(slab.seed, slab.plane, width, scratch);
  if (!scratch.grown.empty()) slab.members = scratch.grown;
  for (unsigned refit = 0; refit < effort.refits; ++refit) {
    vertices = vertices_of(slab.members, scratch);
    FittedPlane turned = slab.plane;
    turned.low = HUGE_VAL;
    for (const std::uint32_t row : vertices) turned.low = std::min(turned.low, scratch.fit.dots[row]);
    turned = narrow_plane(space_, turned, vertices, effort.fit_steps, scratch.fit);
    flood(slab.seed, turned, width, scratch);
    if (scratch.grown.size() <= slab.members.size()) break;
    slab.plane = std::move(turned);
    slab.members = scratch.grown;
  }
}

// Greedy: the slab with the largest gain first, where a simplex counts the more the fewer slabs hold it; then
// those are dropped, last chosen first, that others have made superfluous.
std::vector<std::uint32_t> SlabCover::choose_slabs() {
  std::vector<std::uint8_t>& times = hits_;  // before: slabs that hold it; from here on: chosen slabs
  std::vector<float> weight(complex_.row_count);
  for (std::size_t row = 0; row < complex_.row_count; ++row)
    weight[row] = 1.0f / static_cast<float>(std::max<int>(1, times[row]));
  std::fill(times.begin(), times.end(), std::uint8_t{0});
  const auto gain_of = [&](std::uint32_t slab) {
    float gain = 0.0f;
    for (std::size_t i = slabs_[slab].begin; i < slabs_[slab].end; ++i)
      gain += times[members_[i]] == 0 ? weight[members_[i]] : 0.0f;
    return gain;
  };
  struct Offer {
    float gain;
    std::uint32_t slab;
    bool operator<(const Offer& other) const {
      return gain != other.gain ? gain < other.gain : slab > other.slab;
    }
  };
  std::priority_queue<Offer> offers;
  for (std::uint32_t slab = 0; slab < slabs_.size(); ++slab) offers.push({gain_of(slab), slab});
  std::vector<std::uint32_t> chosen;
  while (!offers.empty()) {
    const Offer best = offers.top();
    offers.pop();
    const float gain = gain_of(best.slab);  // gains only fall: an old one is an upper bound
    if (gain <= 0.0f) continue;
    if (!offers.empty() && Offer{gain, best.slab} < offers.top()) {
      offers.push({gain, best.slab});
      continue;
    }
    chosen.push_back(best.slab);
    for (std::size_t i = slabs_[best.slab].begin; i < slabs_[best.slab].end; ++i)
      count_up(times[members_[i]]);
  }
  std::vector<std::uint32_t> kept;
  for (std::size_t c = chosen.size(); c-- > 0;) {
    const Slab& slab = slabs_[chosen[c]];
    const auto begin = members_.begin() + static_cast<std::ptrdiff_t>(slab.begin);
    const auto end = members_.begin() + static_cast<std::ptrdiff_t>(slab.end);
    // A simplex in 255 slabs or more counts as in just so many: a slab too many may stay.
    if (std::any_of(begin, end, [&](std::uint32_t row) { return times[row] == 1; })) {
      kept.push_back(chosen[c]);
    } else {
      std::for_each(begin, end, [&](std::uint32_t row) { --times[row]; });
    }
  }
  std::reverse(kept.begin(), kept.end());
  return kept;
}

double SlabCover::low_of(std::span<const std::uint32_t> simplices, const double* dots) const {
  double low = HUGE_VAL;
  for (const std::uint32_t simplex : simplices) {
    for (const PointId id : complex_.vertices(SimplexId{simplex}))
      low = std::min(low, dots[space_.row_of(id)]);
  }
  return low;
}

// Each simplex goes to the slab in which it lies highest; then every plane is fitted to what it has.
Covering SlabCover::assign(const std::vector<std::uint32_t>& chosen, double width,
                           const CoverEffort& effort) {
  Covering covering;
  covering.facet_of.assign(complex_.row_count, kNone);
  std::vector<float> depth_of(complex_.row_count, HUGE_VALF);
  std::vector<double>& dots = scratch_.local().fit.dots;
  dots.resize(space_.table().padded_count());
  for (const std::uint32_t index : chosen) {
    Slab& slab = slabs_[index];
    const std::span<const std::uint32_t> members = members_of(slab);
    const auto facet = static_cast<std::uint32_t>(covering.planes.size());
    if (members.size() == 1) {
      if (covering.facet_of[members[0]] == kNone) {
        covering.facet_of[members[0]] = facet;
        depth_of[members[0]] = 0.0f;
      }
    } else {
      const double height = dots[space_.table().find(slab.plane.normal.data(), dots.data())];
      for (const std::uint32_t simplex : members) {
        const auto depth = static_cast<float>(height - low_of({&simplex, 1}, dots.data()));
        if (depth >= depth_of[simplex]) continue;
        depth_of[simplex] = depth;
        covering.facet_of[simplex] = facet;
      }
    }
    covering.planes.push_back(std::move(slab.plane));
  }
  gather_strays(covering, width);
  fit_facets(covering, width, effort);
  return covering;
}

/// Fits the planes, and drops the facets that were left without a simplex.
void SlabCover::fit_facets(Covering& covering, double width, const CoverEffort& effort) {
  std::vector<std::uint32_t> count(covering.planes.size() + 1, 0), order(live_count_);
  for (std::uint32_t row = 0; row < complex_.row_count; ++row)
    if (covering.facet_of[row] != kNone) ++count[covering.facet_of[row] + 1];
  std::partial_sum(count.begin(), count.end(), count.begin());
  std::vector<std::uint32_t> at(count.begin(), count.end() - 1);
  for (std::uint32_t row = 0; row < complex_.row_count; ++row)
    if (covering.facet_of[row] != kNone) order[at[covering.facet_of[row]]++] = row;
  const auto members_of_facet = [&](std::size_t facet) {
    return std::span<const std::uint32_t>(order.data() + count[facet], count[facet + 1] - count[facet]);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, covering.planes.size(), 16), [&](const auto& range) {
    Scratch& scratch = scratch_.local();
    for (std::size_t facet = range.begin(); facet != range.end(); ++facet) {
      const std::span<const std::uint32_t> members = members_of_facet(facet);
      FittedPlane& plane = covering.planes[facet];
      if (members.empty() || (members.size() == 1 && !is_measured(plane))) continue;
      const std::span<const std::uint32_t> vertices = vertices_of(members, scratch);
      plane = measure_plane(space_, plane.normal, vertices, scratch.fit);
      const bool may_stay = plane.width() <= width && (members.size() == 1 || effort.final_fit_steps == 0);
      if (!may_stay)
        plane = narrow_plane(space_, plane, vertices, std::max(16u, effort.final_fit_steps), scratch.fit);
    }
  });
  std::uint32_t used = 0;
  for (std::size_t facet = 0; facet < covering.planes.size(); ++facet) {
    const std::span<const std::uint32_t> members = members_of_facet(facet);
    if (members.empty()) continue;
    for (const std::uint32_t row : members) covering.facet_of[row] = used;
    if (used != facet) covering.planes[used] = std::move(covering.planes[facet]);
    covering.widest = std::max(covering.widest, covering.planes[used++].width());
  }
  covering.planes.resize(used);
}

// A facet is connected: of several parts the largest stays, the others go to a neighbour that can hold them
// within the width. Those that none can hold stay where they are.
void SlabCover::gather_strays(Covering& covering, double width) {
  std::vector<double>& dots = scratch_.local().fit.dots;
  std::vector<std::uint32_t> part_of(complex_.row_count, kNone), order, begin;
  for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
    if (covering.facet_of[row] == kNone || part_of[row] != kNone) continue;
    const auto part = static_cast<std::uint32_t>(begin.size());
    begin.push_back(static_cast<std::uint32_t>(order.size()));
    part_of[row] = part;
    order.push_back(row);
    for (std::size_t i = begin.back(); i < order.size(); ++i) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{order[i]})) {
        if (part_of[neighbour.value] != kNone || covering.facet_of[neighbour.value] != covering.facet_of[row])
          continue;
        part_of[neighbour.value] = part;
        order.push_back(neighbour.value);
      }
    }
  }
  if (begin.size() <= covering.planes.size()) return;
  begin.push_back(static_cast<std::uint32_t>(order.size()));
  const auto members = [&](std::uint32_t part) {
    return std::span<const std::uint32_t>(order.data() + begin[part], begin[part + 1] - begin[part]);
  };
  std::vector<std::uint32_t> largest(covering.planes.size(), kNone);
  for (std::uint32_t part = 0; part + 1 < begin.size(); ++part) {
    std::uint32_t& best = largest[covering.facet_of[members(part)[0]]];
    if (best == kNone || members(part).size() > members(best).size()) best = part;
  }
  for (std::uint32_t part = 0; part + 1 < begin.size(); ++part) {
    const std::uint32_t own = covering.facet_of[members(part)[0]];
    if (largest[own] == part) continue;
    std::vector<std::uint32_t> hosts;
    for (const std::uint32_t simplex : members(part)) {
      for (const SimplexId neighbour : complex_.neighbours(SimplexId{simplex}))
        if (covering.facet_of[neighbour.value] != own) hosts.push_back(covering.facet_of[neighbour.value]);
    }
    std::sort(hosts.begin(), hosts.end());
    hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
    double best_depth = width;
    std::uint32_t best = kNone;
    for (const std::uint32_t host : hosts) {
      const double height = dots[space_.table().find(covering.planes[host].normal.data(), dots.data())];
      const double depth = height - low_of(members(part), dots.data());
      if (depth >= best_depth) continue;
      best_depth = depth;
      best = host;
    }
    if (best == kNone) continue;
    for (const std::uint32_t simplex : members(part)) covering.facet_of[simplex] = best;
  }
}

}  // namespace ndhull
