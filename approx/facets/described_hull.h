// The exact hull by whole facets, where the simplices of a triangulation would be far more than the facets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/frame.h"
#include "core/id_rows.h"
#include "core/ids.h"
#include "core/whole_facets/double_description.h"
#include "core/whole_facets/face_pulling.h"

namespace ndhull {

/// Facets that are simplices come first.
struct DescribedHull {
  std::size_t facets = 0, simplicial = 0;
  std::vector<PointId> vertices;     ///< ascending; of equal points the first
  std::vector<double> planes;        ///< facets x rank, in the frame, fitted to all points in them
  std::vector<double> determinants;  ///< per facet: rank! times the volume of its cone from the centre
  std::vector<double>
      area_vectors;       ///< facets x rank: determinant times plane, summed where facets are joined
  IdRows facet_vertices;  ///< sorted; of a simplicial facet in the order that orients them alike
  IdRows neighbours;      ///< facets, sorted; of a simplicial facet number k is opposite vertex k
  PulledFaces faces;      ///< vertices are numbers of points
  /// Of facets that are several of the hull's own: where those of each begin among the faces' facets, and the
  /// end. Empty: each is one.
  std::vector<std::uint32_t> parts_begin;

  bool is_joined() const { return !parts_begin.empty(); }
};

/// The search for it, in pieces. It ends without a hull when decisions are not clear.
///
/// Checks  of what is found: every point is in the plane of exactly its facets, to kInPlane, and below all
///         others by half of kClear; the facets' areas close the surface (Minkowski); else there is no hull.
class HullDescription {
 public:
  /// More points than this are not tried.
  static constexpr std::size_t kMostPoints = 8192;

  /// Shapes  coordinates: count x rank, in the frame; must outlive this. most_words: of all facets' bits.
  HullDescription(const double* coordinates, std::size_t count, const Frame& frame, std::uint64_t most_words);

  /// Goes on for about `work` elementary steps, for an eighth of that while it does not look as if it would
  /// come to an end soon. Returns true once, with the hull in take().
  bool advance(std::uint64_t work);
  /// Of the hull that was found.
  std::uint64_t simplex_count() const;
  std::uint64_t created_facets() const { return growth_.created(); }
  DescribedHull take() { return std::move(hull_); }

 private:
  bool grow(std::uint64_t work);
  bool settle();
  bool find_vertices();
  void name_by_vertices();
  bool measure(std::uint64_t work);
  bool closes();
  bool list_facets();
  void orient(std::vector<std::uint32_t>& vertices) const;
  bool put_opposite(const std::vector<std::uint32_t>& vertices, std::vector<std::uint32_t>& neighbours) const;
  std::vector<PointId> points_of(std::size_t facet) const;

  const double* points_;
  std::size_t count_, rank_;
  DoubleDescription growth_;
  bool is_settled_ = false, is_hopeless_ = false, is_promising_ = true;
  FacetIncidence incidence_;  // of all points
  FacetIncidence by_vertex_;  // in the order of the result
  std::vector<double> vertex_coordinates_;
  DescribedHull hull_;
};

}  // namespace ndhull
