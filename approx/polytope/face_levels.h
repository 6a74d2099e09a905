// The faces of all dimensions of a simple polytope, as the sets of planes that meet in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "approx/polytope/plane_polytope.h"
#include "approx/work_end.h"

namespace ndhull {

/// Faces of one dimension: those planes meet in face f that stand in row f, ascending.
struct FaceLevel {
  std::size_t width = 0;              ///< planes of a face: rank less its dimension
  std::vector<std::uint32_t> planes;  ///< faces x width
  std::vector<std::uint32_t> base;    ///< the vertex of the face with the lowest number

  std::size_t size() const { return base.size(); }
  const std::uint32_t* row(std::size_t face) const { return planes.data() + face * width; }
};

/// Climbs from the vertices of a polytope to the whole of it, one dimension at a time.
class FaceLevels {
 public:
  FaceLevels(const PlanesAboutOrigin& planes, const PlanePolytope& polytope, const WorkEnd& end);

  /// Faces of dimension 0: the simplices of the dual hull, in their order.
  FaceLevel vertices() const;

  /// The faces one dimension higher. Row f of `level` without its plane k is face parents[f * width + k].
  ///
  /// Limits  at the end of work what is found is returned; it is of no use.
  FaceLevel above(const FaceLevel& level, std::vector<std::uint32_t>& parents) const;

  bool has_ended() const { return end_.is_here(); }
  HullStatus end_status() const { return end_.is_late() ? HullStatus::kTimeLimit : HullStatus::kInterrupted; }

 private:
  const PlanePolytope& polytope_;
  const WorkEnd& end_;
  std::size_t rank_;
  std::vector<std::uint64_t> plane_hash_;
};

}  // namespace ndhull
