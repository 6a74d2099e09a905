#include "approx/slabs/slab_seeds.h"

#include <algorithm>

namespace ndhull {
namespace {

/// Stretches are no shorter than this, and slabs of a batch no more.
constexpr std::size_t kShortest = 512, kMostAtATime = 64;
/// Slabs of a batch: at least so many, and of those that are still to come one in so many. More are grown
/// without knowing of each other.
constexpr std::size_t kFewestAtATime = 4, kBatches = 32;
/// Members of a slab that are worth looking at one more seed, and seeds looked at at most.
constexpr std::size_t kMembersPerSeed = 64, kMostSeeds = 8;
/// Rows from a random one on that are looked at for an open one: so many that take part.
constexpr std::uint32_t kLook = 32;

}  // namespace

SlabSeeds::SlabSeeds(const SimplicialComplex& complex, const WidthSpace& space, bool may_choose)
    : complex_(complex), space_(space), may_choose_(may_choose), hits_(complex.row_count) {
  for (std::uint32_t row = 0; row < complex.row_count; ++row)
    live_count_ += complex.state[row] == SimplexState::kLive ? 1u : 0u;
  clear();
}

void SlabSeeds::clear(std::size_t stride) {
  part_count_ = 0;
  stride_ = stride;
  for (std::size_t row = 0, live = 0; row < hits_.size(); ++row) {
    const bool takes_part = complex_.state[row] == SimplexState::kLive && live++ % stride == 0;
    hits_[row] = takes_part ? 0 : 255;
    part_count_ += takes_part ? 1u : 0u;
  }
  slab_count_ = member_count_ = 0;
  random_ = 0;
}

void SlabSeeds::take_part(std::uint32_t row, std::size_t slabs) {
  hits_[row] = static_cast<std::uint8_t>(std::min<std::size_t>(slabs, 255));
  ++part_count_;
}

void SlabSeeds::open(unsigned round) {
  round_ = round;
  open_at_.clear();
  stretches_.clear();
  const auto count = static_cast<std::uint32_t>(complex_.row_count);
  const std::size_t stretches = std::clamp<std::size_t>(count / kShortest, 1, kMostAtATime);
  const auto length = static_cast<std::uint32_t>((count + stretches - 1) / stretches);
  for (std::uint32_t begin = 0; begin < count; begin += length)
    stretches_.push_back({begin, std::min(count, begin + length)});
  next_stretch_ = 0;
}

void SlabSeeds::count_open_at_vertices() {
  open_at_.assign(space_.vertex_count(), 0);
  for (std::uint32_t row = 0; row < complex_.row_count; ++row) {
    if (!is_open(row)) continue;
    for (const PointId id : complex_.vertices(SimplexId{row})) ++open_at_[space_.row_of(id)];
  }
}

void SlabSeeds::choose_among(const Stretch& stretch, std::size_t count, SeedChoice& seeds) {
  const std::uint32_t look = kLook * static_cast<std::uint32_t>(stride_);
  for (std::size_t i = 1; i < count; ++i) {
    // Knuth's linear congruence; the high bits are the random ones.
    random_ = random_ * 6364136223846793005u + 1442695040888963407u;
    std::uint32_t row =
        stretch.next + static_cast<std::uint32_t>((random_ >> 33) % (stretch.end - stretch.next));
    const std::uint32_t end = std::min(stretch.end, row + look);
    while (row < end && !is_open(row)) ++row;
    if (row < end) seeds.push_back(row);
  }
}

std::span<const SeedChoice> SlabSeeds::next_batch() {
  const std::size_t members = slab_count_ > 0 ? std::max<std::size_t>(1, member_count_ / slab_count_) : 1;
  const std::size_t seeds =
      may_choose_ ? std::clamp<std::size_t>(stride_ * members / kMembersPerSeed, 1, kMostSeeds) : 1;
  const std::size_t most = slab_count_ == 0
                               ? kFewestAtATime
                               : std::clamp(part_count_ / members / kBatches, kFewestAtATime, kMostAtATime);
  if (seeds > 1 && open_at_.empty()) count_open_at_vertices();
  batch_.resize(most);
  std::size_t used = 0;
  for (std::size_t tried = 0; tried < stretches_.size() && used < most; ++tried) {
    Stretch& stretch = stretches_[next_stretch_++ % stretches_.size()];
    while (stretch.next < stretch.end && !is_open(stretch.next)) ++stretch.next;
    if (stretch.next == stretch.end) continue;
    SeedChoice& choice = batch_[used++];
    choice.assign(1, stretch.next);
    choose_among(stretch, seeds, choice);
  }
  return std::span(batch_).first(used);
}

std::uint32_t SlabSeeds::best_of(const SeedChoice& seeds, double width, PlaneFitWork& work) const {
  if (seeds.size() == 1) return seeds[0];
  std::uint32_t best = seeds[0];
  std::uint64_t most = 0;
  std::vector<double> normal(space_.rank());
  std::vector<std::uint32_t> rows;
  for (const std::uint32_t seed : seeds) {
    space_.normal_of(complex_.plane(SimplexId{seed}), normal.data());
    double height = 0.0;
    space_.table().find(normal.data(), work.products, height);
    rows.clear();
    space_.table().rows_above(work.products, height - width, open_at_.size(), rows);
    std::uint64_t gain = 0;
    for (const std::uint32_t row : rows) gain += open_at_[row];
    if (gain <= most) continue;
    most = gain;
    best = seed;
  }
  return best;
}

void SlabSeeds::add_slab(std::span<const std::uint32_t> members) {
  ++slab_count_;
  member_count_ += members.size();
  for (const std::uint32_t row : members) {
    if (hits_[row] == 255) continue;
    if (++hits_[row] != round_ || open_at_.empty()) continue;
    for (const PointId id : complex_.vertices(SimplexId{row})) --open_at_[space_.row_of(id)];
  }
}

}  // namespace ndhull
