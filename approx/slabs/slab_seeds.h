// Which simplices slabs are grown from next: of a few that too few slabs hold, the one whose slab gains most.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "approx/slabs/plane_fit.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

/// Simplices that a slab could be grown from; the first has waited longest.
using SeedChoice = std::vector<std::uint32_t>;

/// Counts the slabs that hold each simplex, and says where to grow the next ones.
///
/// Slabs of a batch can be grown at the same time: what one of them holds can still seed another. So their
/// seeds are far apart, each from a stretch of rows of its own, which are often neighbours on the hull.
class SlabSeeds {
 public:
  /// `may_choose`: false to take seeds as they come. All must outlive this.
  SlabSeeds(const SimplicialComplex& complex, const WidthSpace& space, bool may_choose);

  /// No slab holds anything yet. One live simplex in `stride` takes part; hits() of all other rows is 255.
  void clear(std::size_t stride = 1);
  /// One more takes part, which so many slabs hold.
  void take_part(std::uint32_t row, std::size_t slabs);
  /// Simplices in fewer than `round` slabs, 1 to 255, are open from now on.
  void open(unsigned round);
  /// Seeds of the next slabs, all open; none when no simplex is open. Valid until the next call. The choice
  /// is the larger the larger slabs have been, so that it takes a small part of what growing them does.
  std::span<const SeedChoice> next_batch();
  /// The seed below whose plane most open simplices have vertices. Threads may ask at the same time.
  /// Cost  for each of several seeds a product of a direction with all points.
  std::uint32_t best_of(const SeedChoice& seeds, double width, PlaneFitWork& work) const;
  /// These are in one more slab.
  void add_slab(std::span<const std::uint32_t> members);

  std::size_t live_count() const { return live_count_; }
  /// Per row: slabs that hold it, at most 255.
  std::span<const std::uint8_t> hits() const { return hits_; }

 private:
  struct Stretch {
    std::uint32_t next, end;  // rows; those before `next` are not open
  };
  bool is_open(std::uint32_t row) const { return hits_[row] < round_; }
  void count_open_at_vertices();
  void choose_among(const Stretch& stretch, std::size_t count, SeedChoice& seeds);

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  bool may_choose_;
  std::size_t live_count_ = 0, part_count_ = 0;  // all; those that take part
  std::size_t stride_ = 1;                       // of those that take part
  unsigned round_ = 1;
  std::vector<std::uint8_t> hits_;
  std::vector<std::uint32_t> open_at_;  // per vertex: open simplices that have it; empty until it is needed
  std::vector<Stretch> stretches_;
  std::size_t next_stretch_ = 0;
  std::size_t slab_count_ = 0, member_count_ = 0;  // of all slabs so far
  std::uint64_t random_ = 0;
  std::vector<SeedChoice> batch_;
};

}  // namespace ndhull
