// The faces of a polytope that pulling its vertices meets: its triangulation without the simplices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ndhull {

struct FacetIncidence;

/// Faces as a graph. The pulling triangulation of a face is the cones from its first vertex, the apex, over
/// the triangulations of those of its facets that do not hold the apex; so faces in common are divided alike.
/// An 8-d cube has 80,640 simplices and 1,270 such faces.
struct PulledFaces {
  struct Face {
    std::uint32_t begin = 0;  ///< in `entries`
    std::uint32_t count = 0;
    bool is_simplex = false;      ///< its entries are its vertices; else the apex, then faces
    double measure = 0.0;         ///< k-dimensional volume of the face times k!
    std::uint64_t simplices = 0;  ///< of its triangulation; saturates
  };
  std::size_t rank = 0;
  std::vector<Face> faces;
  std::vector<std::uint32_t> entries;
  std::vector<std::uint32_t> facets;  ///< the face of each facet of the hull

  std::span<const std::uint32_t> entries_of(const Face& face) const {
    return {entries.data() + face.begin, face.count};
  }
};

/// Simplices of the facets' triangulations; saturates.
std::uint64_t count_simplices(const PulledFaces& faces);

/// Vertex i is now ids[i].
void rename_vertices(PulledFaces& faces, std::span<const std::uint32_t> ids);

/// Pulls the vertices of a hull in the order of their numbers.
///
/// Method  The facets of a face are the largest of its intersections with its neighbours' facets. Faces are
///         known by their vertices and looked at once. Heights come from the facets' planes, within an
///         orthonormal basis of the face, so a volume is a sum of positive products.
/// Shapes  hull: bits of vertices alone, no other points; points: as there, in the frame.
/// Returns fewer facets than the hull has when all would take more than about `work` elementary steps.
/// Source  Lee. Subdivisions and triangulations of polytopes. Handbook of Discrete and Computational
///         Geometry, ch. 16 (pulling). Bueler, Enge, Fukuda. Exact volume computation for polytopes. 2000
///         (faces met again).
PulledFaces pull_faces(const FacetIncidence& hull, const double* points, std::uint64_t work);

}  // namespace ndhull
