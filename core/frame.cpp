#include "core/frame.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/linear/dense_solve.h"
#include "core/linear/greedy_simplex.h"

namespace ndhull {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

constexpr double kRoundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// The scaling is the frame while no dual vertex of the simplex times a point is longer than this: growth
/// then loses at most three of sixteen digits, and the frame keeps exact input exact.
constexpr double kWellShaped = 1000.0;

template <class Scalar>
void find_column_ranges(const PointView& points, Frame& frame) {
  const Scalar* data = static_cast<const Scalar*>(points.data);
  for (std::size_t row = 0; row < points.rows; ++row) {
    for (std::size_t column = 0; column < points.dimension; ++column) {
      const double x = static_cast<double>(data[row * points.row_stride + column * points.column_stride]);
      if (!std::isfinite(x)) {
        throw Error(ErrorCode::kNotFinite, "element [" + std::to_string(row) + ", " + std::to_string(column) +
                                               "]: found " + std::to_string(x) +
                                               ", expected a finite number; remove or repair the row");
      }
      frame.column_min[column] = std::min(frame.column_min[column], x);
      frame.column_max[column] = std::max(frame.column_max[column], x);
    }
  }
}

/// Throws Error kNotFinite with row and column.
void set_column_ranges(const PointView& points, Frame& frame) {
  frame.column_min.assign(points.dimension, std::numeric_limits<double>::infinity());
  frame.column_max.assign(points.dimension, -std::numeric_limits<double>::infinity());
  if (points.type == ScalarType::kFloat64) {
    find_column_ranges<double>(points, frame);
  } else {
    find_column_ranges<float>(points, frame);
  }
}

/// Power of two near 1 / extent; 0 for a constant column.
double column_scale(double low, double high) {
  // Half extents: high - low itself may overflow.
  const double half = 0.5 * high - 0.5 * low;
  if (half == 0.0) return 0.0;
  int exponent = 0;
  std::frexp(half, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -1022, 1022));
}

/// Of more points than this some are enough for a simplex, if no dual vertex of it times any point is longer
/// than that.
constexpr std::size_t kManyPoints = 1 << 15, kFrameSample = 1 << 12;
constexpr double kSampleShape = 200.0;

/// Largest product of a dual vertex of the simplex with a point of it, or of length `reach` if that is more.
/// Of its own points: 1 / relative height of the worst facet.
///
/// About the mean the vertices sum to 0, so the dual vertex of the facet opposite vertex i takes -rank there and
/// 1 at the others: one inverse of all vertices but the first has all of them.
double worst_shape(const Matrix& vertices, double reach = 0.0) {
  const Eigen::Index rank = vertices.cols();
  const Eigen::RowVectorXd mean = vertices.colwise().mean();
  const Matrix centred = vertices.rowwise() - mean;
  reach = std::max(reach, centred.rowwise().norm().maxCoeff());
  const Matrix inverse = SquareFactors(centred.bottomRows(rank)).inverse();
  const Vector first = inverse.rowwise().sum();
  double worst = first.norm() * reach;
  for (Eigen::Index omitted = 0; omitted < rank; ++omitted) {
    const Vector dual = first - static_cast<double>(rank + 1) * inverse.col(omitted);
    worst = std::max(worst, dual.norm() * reach);
  }
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

/// Independent directions of length 1, in input units, that span what `directions` (rank x dimension,
/// orthonormal in scaled coordinates) span; nearly orthogonal.
///
/// Where axes differ by many orders of magnitude all directions are nearly parallel to the longest axis in
/// input units, and orthogonalising them would lose the rest. Elimination first, in scaled coordinates: each
/// direction keeps one pivot column, a long axis of good size, and differs from that axis by shorter ones
/// only.
Matrix directions_in_input_units(Matrix directions, const Vector& scale) {
  constexpr double kGoodPivot = 1e-2;  // of the largest entry left: bounds what the others are multiplied by
  const Eigen::Index rank = directions.rows(), columns = directions.cols();
  std::vector<bool> row_used(static_cast<std::size_t>(rank), false);
  for (Eigen::Index step = 0; step < rank; ++step) {
    double largest = 0.0, longest = -1.0;
    Eigen::Index pivot_row = 0, pivot_column = 0;
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index row = 0; row < rank; ++row) {
        if (row_used[static_cast<std::size_t>(row)]) continue;
        for (Eigen::Index column = 0; column < columns; ++column) {
          const double size = scale[column] == 0.0 ? 0.0 : std::abs(directions(row, column));
          if (pass == 0) largest = std::max(largest, size);
          if (pass == 0 || size < kGoodPivot * largest || size == 0.0) continue;
          if (1.0 / scale[column] < longest) continue;
          if (1.0 / scale[column] == longest && size <= std::abs(directions(pivot_row, pivot_column)))
            continue;
          longest = 1.0 / scale[column];
          pivot_row = row;
          pivot_column = column;
        }
      }
    }
    row_used[static_cast<std::size_t>(pivot_row)] = true;
    directions.row(pivot_row) /= directions(pivot_row, pivot_column);
    for (Eigen::Index row = 0; row < rank; ++row) {
      if (row == pivot_row) continue;
      const double factor = directions(row, pivot_column);
      directions.row(row) -= factor * directions.row(pivot_row);
      directions(row, pivot_column) = 0.0;
    }
  }
  for (Eigen::Index column = 0; column < columns; ++column) {
    directions.col(column) *= scale[column] == 0.0 ? 0.0 : 1.0 / scale[column];
  }
  for (Eigen::Index row = 0; row < rank; ++row) {
    int exponent = 0;  // squares of tiny and of huge entries are no doubles
    std::frexp(directions.row(row).cwiseAbs().maxCoeff(), &exponent);
    for (double& entry : directions.row(row)) entry = std::ldexp(entry, -exponent);
    directions.row(row).normalize();
  }
  return directions;
}

/// Vertices of a regular simplex around 0 with circumradius 1: (rank + 1) x rank.
Matrix regular_simplex(Eigen::Index rank) {
  Matrix vertices = Matrix::Zero(rank + 1, rank);
  for (Eigen::Index column = 0; column < rank; ++column) {
    const double rest = 1.0 - vertices.row(column).squaredNorm();
    vertices(column, column) = std::sqrt(std::max(rest, 0.0));
    for (Eigen::Index row = column + 1; row <= rank; ++row) {
      const double dot = vertices.row(row).dot(vertices.row(column));
      vertices(row, column) = (-1.0 / static_cast<double>(rank) - dot) / vertices(column, column);
    }
  }
  return vertices;
}

/// Columns about their middles, times powers of two: extents near 1, or less of columns that are much rougher
/// than others.
struct ScaledColumns {
  Vector scale, middle;
  double tolerance = 0.0;  // what is nearer to an affine span is so by the rounding of the input
};

ScaledColumns scale_columns(const Frame& frame) {
  constexpr double kRough = 1e-6;  // tolerance beyond which a column would hide others thinner than that
  ScaledColumns columns{Vector(frame.dimension), Vector(frame.dimension)};
  Vector largest = Vector::Ones(columns.scale.size());  // coordinates, in scaled units
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const double low = frame.column_min[k], high = frame.column_max[k];
    columns.scale[at] = column_scale(low, high);
    columns.middle[at] = 0.5 * low + 0.5 * high;
    largest[at] = std::max(1.0, columns.scale[at] * std::max(std::abs(low), std::abs(high)));
  }
  const double roundings = 8.0 * static_cast<double>(frame.dimension) * kRoundoff;
  columns.tolerance = roundings * (1.0 + largest.maxCoeff());
  if (columns.tolerance <= kRough) return columns;
  // As rough as the finest of those that vary.
  const double finest = (columns.scale.array() != 0.0).select(largest.array(), HUGE_VAL).minCoeff();
  for (Eigen::Index k = 0; k < largest.size(); ++k)
    columns.scale[k] = std::ldexp(columns.scale[k], -std::ilogb(largest[k] / finest));
  columns.tolerance = 2.0 * roundings * (1.0 + finest);
  return columns;
}

/// Greedily of every step-th point.
GreedySimplex simplex_of_some(const PointView& points, std::size_t step, const ScaledColumns& columns) {
  PointView some = points;
  some.rows = (points.rows + step - 1) / step;
  some.row_stride *= step;
  GreedySimplex chosen = choose_simplex(some, {columns.middle.data(), points.dimension},
                                        {columns.scale.data(), points.dimension}, columns.tolerance);
  for (PointId& id : chosen.points) id.value *= static_cast<std::uint32_t>(step);
  return chosen;
}

/// Spans the whole space, and is well shaped beside the extent of all points.
bool is_good_simplex(const PointView& points, const GreedySimplex& simplex, const ScaledColumns& columns) {
  const std::size_t dimension = points.dimension;
  if (simplex.points.size() <= dimension) return false;
  Matrix vertices(dimension + 1, dimension);
  for (std::size_t row = 0; row <= dimension; ++row) {
    for (std::size_t k = 0; k < dimension; ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      vertices(static_cast<Eigen::Index>(row), at) =
          (points.at(simplex.points[row].value, k) - columns.middle[at]) * columns.scale[at];
    }
  }
  // No scaled coordinate is more than 1 from the middle.
  return worst_shape(vertices, 2.0 * std::sqrt(static_cast<double>(dimension))) <= kSampleShape;
}

GreedySimplex choose_frame_simplex(const PointView& points, const ScaledColumns& columns) {
  GreedySimplex simplex;
  if (points.rows > kManyPoints) simplex = simplex_of_some(points, points.rows / kFrameSample, columns);
  if (!is_good_simplex(points, simplex, columns)) simplex = simplex_of_some(points, 1, columns);
  return simplex;
}

void set_centre(const PointView& points, Frame& frame) {
  frame.centre.assign(points.dimension, 0.0);
  for (const PointId id : frame.simplex) {
    const double weight = 1.0 / static_cast<double>(frame.simplex.size());
    for (std::size_t k = 0; k < points.dimension; ++k) frame.centre[k] += weight * points.at(id.value, k);
  }
  if (frame.rank == 0) points.copy_row(0, frame.centre.data());
}

/// The scaling alone, of columns that vary or along the simplex' directions.
Matrix map_of_scaling(const Vector& scale, const Eigen::Map<const Matrix>& directions, Frame& frame) {
  const auto varying = static_cast<Eigen::Index>((scale.array() != 0.0).count());
  if (varying != directions.rows()) return directions * scale.asDiagonal();
  frame.is_diagonal = true;
  Matrix map = Matrix::Zero(directions.rows(), directions.cols());
  for (Eigen::Index column = 0, row = 0; column < map.cols(); ++column)
    if (scale[column] != 0.0) map(row++, column) = scale[column];
  return map;
}

/// The map that makes the frame's simplex regular instead, where it is not well shaped.
void make_regular(const PointView& points, Matrix& map, Frame& frame) {
  const Eigen::Index rank = map.rows();
  Matrix vertices(rank + 1, map.cols());
  for (Eigen::Index row = 0; row <= rank; ++row) {
    for (Eigen::Index k = 0; k < map.cols(); ++k) {
      vertices(row, k) =
          points.at(frame.simplex[static_cast<std::size_t>(row)].value, static_cast<std::size_t>(k)) -
          frame.centre[static_cast<std::size_t>(k)];
    }
  }
  const Matrix mapped = vertices * map.transpose();
  if (worst_shape(mapped) <= kWellShaped) return;
  // Edges of the simplex to those of the regular one: y = T z with T edges = regular edges.
  const Matrix regular = regular_simplex(rank);
  Matrix edges(rank, rank), regular_edges(rank, rank);
  for (Eigen::Index row = 0; row < rank; ++row) {
    edges.row(row) = mapped.row(row + 1) - mapped.row(0);
    regular_edges.row(row) = regular.row(row + 1) - regular.row(0);
  }
  const Matrix transposed = edges.fullPivLu().solve(regular_edges);
  map = (transposed.transpose() * map).eval();
  frame.is_diagonal = false;
}

}  // namespace

void check_shape(const PointView& points) {
  if (points.dimension == 0) {
    throw Error(ErrorCode::kDimensionTooLow, "points have 0 columns, expected at least 1; add coordinates");
  }
  if (points.rows == 0) {
    throw Error(ErrorCode::kEmptyInput, "found no points, expected at least 1; give a file with rows");
  }
  if (points.rows >= (std::size_t{1} << 31)) {
    throw Error(ErrorCode::kTooManyPoints, "found " + std::to_string(points.rows) +
                                               " points, expected fewer than 2147483648; thin them out");
  }
}

void check_finite(const PointView& points) {
  Frame frame;
  set_column_ranges(points, frame);
}

void check_extents(const Frame& frame) {
  constexpr double kLeastExtent = 1e-300;
  for (std::size_t k = 0; k < frame.dimension; ++k) {
    const double extent = frame.column_max[k] - frame.column_min[k];
    if (extent == 0.0 || (extent >= kLeastExtent && std::isfinite(extent))) continue;
    char found[32];
    std::snprintf(found, sizeof found, "%.3g", extent);
    const bool is_small = extent < kLeastExtent;
    throw Error(ErrorCode::kOutOfRange,
                "points: found an extent of " + std::string(found) + " in column " + std::to_string(k + 1) +
                    ", expected " + (is_small ? "at least 1e-300, or 0; multiply" : "a finite one; divide") +
                    " the coordinates by a power of two");
  }
}

Frame fit_frame(const PointView& points) {
  check_shape(points);
  Frame frame;
  frame.dimension = points.dimension;
  set_column_ranges(points, frame);
  const ScaledColumns columns = scale_columns(frame);
  const GreedySimplex simplex = choose_frame_simplex(points, columns);
  frame.simplex = simplex.points;
  frame.rank = simplex.points.size() - 1;
  set_centre(points, frame);
  if (frame.rank == 0) return frame;
  const Eigen::Map<const Matrix> directions(simplex.directions.data(), static_cast<Eigen::Index>(frame.rank),
                                            static_cast<Eigen::Index>(frame.dimension));
  Matrix map = map_of_scaling(columns.scale, directions, frame);
  make_regular(points, map, frame);
  frame.map.assign(map.data(), map.data() + map.size());
  if (frame.rank < frame.dimension) {
    const Matrix basis = directions_in_input_units(directions, columns.scale);
    frame.basis.assign(basis.data(), basis.data() + basis.size());
  }
  return frame;
}

}  // namespace ndhull
