// Coverings by slabs that hold hundreds of simplices: by the vertices that are in a slab, without a walk over
// its simplices.
//
// A simplex is in a slab when all its vertices are. With a bit for each slab at each vertex, the slabs that
// hold a simplex are the bits that all its vertices have: one pass over the simplices finds what all slabs
// hold, where walks would meet each simplex once in every slab that holds it, with its neighbours. Slabs are
// grown from and chosen by a sample of the simplices. Simplices that are in none of the chosen ones join the
// sample, and the choice is made again; what is still outside then gets slabs of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "approx/slabs/covering.h"
#include "approx/slabs/slab_choice.h"
#include "approx/slabs/slab_growth.h"
#include "approx/slabs/slab_seeds.h"
#include "approx/slabs/width_space.h"
#include "core/complex/simplicial_complex.h"

namespace ndhull {

class WideCover {
 public:
  /// `scratch`: that of the calling thread. At most 65,536 vertices. All must outlive this.
  WideCover(const SimplicialComplex& complex, const WidthSpace& space, const SlabGrower& grower,
            SlabSeeds& seeds, std::function<SlabScratch&()> scratch);

  /// A facet for each simplex. Where facets are few, or it is worth looking harder, that in which it lies
  /// highest to a 254th of the width. Facets may be empty, and the planes' lows are not known yet. Nothing
  /// where slabs are too small for that to be quick.
  ///
  /// Cost  some three products of a direction with all points for each slab; some passes over the simplices.
  ///       2 rank bytes for each of these, a byte for each vertex and facet.
  std::optional<Covering> cover(double width, const CoverEffort& effort);

  /// May facets of the last covering have parts that do not hang together, and that a neighbour could hold?
  bool has_strays() const { return by_height_; }

  /// Of each simplex the depth of its facet, rounded up: that of the lowest vertex of all its simplices.
  ///
  /// Shapes  depth_of: one a row.
  void find_depths(const Covering& covering, std::span<float> depth_of) const;

 private:
  double members_at_first(double width, const CoverEffort& effort);
  void list_vertices();
  void start(std::size_t stride);
  void grow_until_held(unsigned times, std::size_t most, double width, const CoverEffort& effort);
  void add_slabs(std::span<const SeedChoice> seeds, unsigned round, double width, const CoverEffort& effort);
  void grow_slabs(std::span<const SeedChoice> seeds, double width, const CoverEffort& effort);
  std::vector<std::uint32_t> choose(std::span<const std::uint32_t> rows) const;
  void take_part(std::span<const std::uint32_t> rows);
  std::vector<std::uint32_t> rows_outside(std::span<const std::uint32_t> chosen) const;
  std::vector<std::uint8_t> depths_in(std::span<const std::uint32_t> chosen, double width) const;
  std::vector<std::uint32_t> assign(std::span<const std::uint32_t> chosen,
                                    std::span<const std::uint32_t> rows, double width, Covering& covering);
  template <std::size_t D>
  std::vector<std::uint32_t> assign_in(std::span<const std::uint32_t> chosen,
                                       std::span<const std::uint32_t> rows,
                                       const std::vector<std::uint8_t>& depths, Covering& covering);
  std::vector<std::uint64_t> bits_of(std::span<const std::uint32_t> slabs) const;
  template <std::size_t D>
  void find_held(std::size_t first, unsigned round, std::vector<std::vector<std::uint32_t>>& found);
  const std::uint16_t* vertices_of(std::uint32_t row) const { return vertices_.data() + row * complex_.rank; }

  const SimplicialComplex& complex_;
  const WidthSpace& space_;
  const SlabGrower& grower_;
  SlabSeeds& seeds_;
  std::function<SlabScratch&()> scratch_;
  std::vector<std::uint16_t> vertices_;  // of each row of the complex: rows of the space; empty at first
  std::vector<VertexSlab> slabs_;
  std::vector<std::uint64_t> bits_;    // word w of vertex v: bits_[w * vertices + v]
  std::vector<std::uint32_t> sample_;  // rows of the complex
  bool by_height_ = true;
  std::vector<std::uint32_t> open_;  // those of the sample that more slabs are to hold
};

}  // namespace ndhull
