// Point sets of known families, the same bits for the same options on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/points.h"
#include "tools/points/point_set.h"

namespace ndhull {

/// A family of point sets; `to_string` gives the name used on the command line.
enum class PointFamily {
  kSphere,         ///< uniform on the unit sphere
  kBall,           ///< uniform in the unit ball
  kGaussian,       ///< independent normal coordinates, variance 1
  kCube,           ///< uniform in [-1, 1]^d
  kCubeSurface,    ///< uniform on the surface of [-1, 1]^d
  kCubeCorners,    ///< corners of [-1, 1]^d: all 2^d with count 0, else drawn with repetition
  kCrossPolytope,  ///< sum |x_i| <= 1: its 2d vertices with count 0, else uniform in it
  kSimplex,        ///< x_i >= 0, sum x_i <= 1: its d+1 vertices with count 0, else uniform in it
  kCyclic,         ///< the vertices of a cyclic polytope, in the order of the curve
  kLattice,        ///< {0, .., side-1}^d, first coordinate fastest: all with count 0, else the first ones
  kLens,           ///< on two caps of radius lens_radius that meet in the unit sphere of the first d-1 axes
  kCone,       ///< uniform on the side of the cone from (0,..,0,1) to the unit sphere of the first d-1 axes
  kEllipsoid,  ///< the unit sphere with axis k stretched by axes[k]
  kClusters,   ///< normal clouds about centres that are uniform in [-1, 1]^d
};
std::string_view to_string(PointFamily family);
/// All families, in the order of the enumeration.
std::span<const PointFamily> all_point_families();
/// The family called `name`. Throws Error kUsage listing the names.
PointFamily point_family(std::string_view name);

/// The curve whose points are the vertices of a cyclic polytope.
enum class CyclicCurve {
  kAuto,           ///< trigonometric in even dimensions, moment in odd ones
  kMoment,         ///< (t, t^2, .., t^d) at equal steps of t in [-1, 1]
  kTrigonometric,  ///< (cos t, sin t, cos 2t, sin 2t, ..) at equal steps of t over a turn; all norms equal
};

/// What to generate. Defaults give 1000 points on the sphere in 5-d.
struct GenerateOptions {
  PointFamily family = PointFamily::kSphere;
  std::size_t dimension = 5;
  std::size_t count = 1000;  ///< rows; 0: the whole of a finite family (see PointFamily)
  std::uint64_t seed = 1;
  ScalarType scalar = ScalarType::kFloat64;  ///< of the blocks; float32 rounds the same points

  CyclicCurve curve = CyclicCurve::kAuto;  ///< kCyclic
  std::size_t side = 3;                    ///< kLattice: points along each axis
  double lens_radius = 10.0;               ///< [distance] kLens: > 1
  std::vector<double> axes = {};           ///< [distance] kEllipsoid: d values; empty: 1, 1/2, .., 1/d
  std::size_t cluster_count = 10;          ///< kClusters
  double spread = 0.01;                    ///< [distance] kClusters: standard deviation of a cloud
};

/// How many rows `generate` makes. Throws as generate.
std::size_t row_count(const GenerateOptions& options);

/// Generates the rows in order and gives them away in blocks.
///
/// Shapes    each block: some rows x options.dimension, row-major, of options.scalar; the view is valid
///           during the call only. The blocks together have row_count(options) rows.
/// Throws    Error kDimensionTooLow dimension 0; kUsage count 0 for a family without an end, more rows than
///           a lattice has, a parameter outside its range, kTrigonometric in odd dimensions; kTooManyPoints
///           2^d or side^d is above 2^40.
/// Not promised  distinct rows, or rows exactly on a surface: coordinates are rounded.
/// Cost      O(rows x dimension) time; one block of about a megabyte of memory.
/// Source    uniform on the sphere: Muller. Comm. ACM 2(4), 1959. Uniform in the ball: the
///           first d coordinates of a uniform point of the sphere in d+2 dimensions; Barthe et al. A
///           probabilistic approach to the geometry of the l_p^n-ball. Ann. Probab. 33(2), 2005.
void generate(const GenerateOptions& options, const std::function<void(const PointView&)>& take_block);

/// The command that makes the same points, without an output.
std::string generate_command(const GenerateOptions& options);

/// All rows at once, as doubles (with float32: rounded to float). `header` is the command.
PointSet generate_points(const GenerateOptions& options);

}  // namespace ndhull
