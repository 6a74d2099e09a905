// Hulls in Qhull's text formats: counts, orientation, and that the formats agree with each other.
#include "tools/io/qhull_formats.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "tests/io/io_test_support.h"

namespace ndhull {
namespace {

using Lines = std::vector<std::vector<double>>;

/// What `format` prints, as numbers.
Lines printed(std::string_view format, const QhullPrint& print) {
  const Scratch scratch;
  {
    OutputFile file(scratch.path("out"));
    write_qhull_format(file, format, print);
    file.commit();
  }
  Lines lines;
  std::istringstream all(scratch.read("out"));
  for (std::string line; std::getline(all, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (double word = 0.0; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

std::size_t index(double number) { return static_cast<std::size_t>(number); }

/// All corners of the unit cube.
std::vector<double> cube_corners(std::size_t dimension) {
  std::vector<double> values;
  for (std::size_t corner = 0; corner < std::size_t{1} << dimension; ++corner) {
    for (std::size_t k = 0; k < dimension; ++k) values.push_back(static_cast<double>(corner >> k & 1U));
  }
  return values;
}

/// Points on a sphere in general position, from a linear congruential generator.
std::vector<double> sphere(std::size_t count, std::size_t dimension) {
  std::vector<double> values;
  std::uint64_t state = 20240601;
  for (std::size_t point = 0; point < count; ++point) {
    double length_sq = 0.0;
    for (std::size_t k = 0; k < dimension; ++k) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      values.push_back(static_cast<double>(state >> 11) * 0x1p-53 - 0.5);
      length_sq += values.back() * values.back();
    }
    for (std::size_t k = 0; k < dimension; ++k) values[point * dimension + k] /= std::sqrt(length_sq);
  }
  return values;
}

/// Points with their hull and the object that prints it.
struct Case {
  Case(std::vector<double> coordinates, std::size_t dimension)
      : values(std::move(coordinates)),
        points(PointView::row_major(values.data(), values.size() / dimension, dimension)),
        hull(convex_hull(points)),
        print(hull, points) {}
  std::vector<double> values;
  PointView points;
  Hull hull;
  QhullPrint print;
};

/// Determinant by expansion along the first row: small and obviously right.
double determinant(const Lines& rows) {
  if (rows.size() == 1) return rows[0][0];
  double sum = 0.0;
  for (std::size_t column = 0; column < rows.size(); ++column) {
    Lines minor;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      minor.push_back(rows[row]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(column));
    }
    sum += (column % 2 == 0 ? 1.0 : -1.0) * rows[0][column] * determinant(minor);
  }
  return sum;
}

/// det(v1 - v0, ..., normal)
double orientation(const Lines& vertices, const std::vector<double>& plane) {
  Lines rows;
  for (std::size_t vertex = 1; vertex < vertices.size(); ++vertex) {
    rows.push_back(vertices[vertex]);
    for (std::size_t k = 0; k < rows.back().size(); ++k) rows.back()[k] -= vertices[0][k];
  }
  rows.emplace_back(plane.begin(), plane.end() - 1);
  return determinant(rows);
}

TEST(QhullFormatsLaw, SimplicialFacetsAreOrientedAsQhullOrientsThem) {
  for (const std::size_t dimension : {2U, 3U, 4U, 5U}) {
    SCOPED_TRACE(dimension);
    const Case c(sphere(40, dimension), dimension);
    const Lines simplices = printed("i", c.print);
    const Lines planes = printed("n", c.print);
    ASSERT_EQ(index(simplices[0][0]), c.hull.facet_count());
    ASSERT_EQ(planes.size(), simplices.size() + 1);
    for (std::size_t facet = 1; facet < simplices.size(); ++facet) {
      Lines vertices;
      for (const double id : simplices[facet]) {
        vertices.emplace_back(dimension);
        c.points.copy_row(index(id), vertices.back().data());
      }
      ASSERT_EQ(vertices.size(), dimension);
      EXPECT_LT(orientation(vertices, planes[facet + 1]), 0.0);
    }
  }
}

TEST(QhullFormatsLaw, TheNeighbourIsOppositeTheVertexInTheSamePlace) {
  const Case c(sphere(30, 5), 5);
  const Lines vertices = printed("Fv", c.print);
  const Lines neighbours = printed("Fn", c.print);
  ASSERT_EQ(vertices.size(), neighbours.size());
  for (std::size_t facet = 1; facet < vertices.size(); ++facet) {
    ASSERT_EQ(vertices[facet].size(), 6U);
    for (std::size_t k = 1; k <= 5; ++k) {
      const std::vector<double>& other = vertices[index(neighbours[facet][k]) + 1];
      EXPECT_EQ(std::count(other.begin() + 1, other.end(), vertices[facet][k]), 0);
    }
  }
}

TEST(QhullFormatsExample, ACubeHasQuadrilateralsInCyclicOrder) {
  const Case c(cube_corners(3), 3);
  const Lines off = printed("o", c.print);
  EXPECT_EQ(off[0], (std::vector<double>{3}));
  EXPECT_EQ(off[1], (std::vector<double>{8, 6, 12}));
  ASSERT_EQ(off.size(), 2U + 8 + 6);
  for (std::size_t facet = 10; facet < off.size(); ++facet) {
    ASSERT_EQ(off[facet].size(), 5U);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t changed = index(off[facet][k + 1]) ^ index(off[facet][(k + 1) % 4 + 1]);
      EXPECT_EQ(changed & (changed - 1), 0U) << "corners one after the other differ in one coordinate";
    }
  }
  EXPECT_EQ(printed("Fs", c.print)[0], (std::vector<double>{10, 3, 8, 8, 6, 8, 6, 0, 6, 0, 0}));
  EXPECT_EQ(printed("Fx", c.print).size(), 9U);
  EXPECT_EQ(printed("FV", c.print)[1], (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_NEAR(printed("FS", c.print)[1][1], 6.0, 1e-12);
  EXPECT_NEAR(printed("FS", c.print)[1][2], 1.0, 1e-12);
}

TEST(QhullFormatsExample, FacetsOfAFourDimensionalCubeAreConesOverTheirRidges) {
  const Case c(cube_corners(4), 4);
  ASSERT_EQ(c.hull.facet_count(), 8U);
  const Lines cones = printed("i", c.print);
  const Lines centrums = printed("FC", c.print);
  double volume = 0.0;
  for (std::size_t row = 1; row < cones.size(); ++row) {
    Lines corners;
    for (const double id : cones[row]) {
      corners.emplace_back(4);
      if (index(id) < 16) {
        c.points.copy_row(index(id), corners.back().data());
      } else {
        corners.back() = centrums[2 + index(id) - 16];
      }
      for (double& coordinate : corners.back()) coordinate -= 0.5;
    }
    volume += determinant(corners) / 24.0;
    EXPECT_GT(determinant(corners), 0.0) << "one orientation, seen from the centre";
  }
  EXPECT_NEAR(volume, 1.0, 1e-12);
  EXPECT_EQ(index(cones[0][0]), cones.size() - 1);
}

TEST(QhullFormatsExample, PolygonsRunOnceRoundAgainstTheClock) {
  const Case c(sphere(12, 2), 2);
  const Lines ids = printed("Fx", c.print);
  ASSERT_EQ(ids.size(), 13U);
  for (std::size_t k = 0; k < 12; ++k) {
    const std::size_t a = index(ids[1 + k][0]);
    const std::size_t b = index(ids[1 + (k + 1) % 12][0]);
    EXPECT_GT(c.points.at(a, 0) * c.points.at(b, 1) - c.points.at(a, 1) * c.points.at(b, 0), 0.0);
  }
}

TEST(QhullFormatsLaw, OuterPlanesLieOutsideInnerPlanesInside) {
  const Case c(sphere(60, 4), 4);
  const Lines mean = printed("n", c.print);
  const Lines outer = printed("Fo", c.print);
  const Lines inner = printed("Fi", c.print);
  for (std::size_t row = 2; row < mean.size(); ++row) {
    EXPECT_LE(outer[row][4], mean[row][4]);
    EXPECT_GE(inner[row][4], mean[row][4]);
  }
}

TEST(QhullFormatsLaw, ASelectionIsPrintedInItsOrderWithTheOthersAsNegativeNumbers) {
  const Case c(sphere(30, 4), 4);
  const std::vector<FacetId> selection{FacetId{3}, FacetId{0}};
  const QhullPrint some(c.hull, c.points, selection);
  const Lines all = printed("Fv", c.print);
  EXPECT_EQ(printed("Fv", some), (Lines{{2}, all[4], all[1]}));
  const Lines areas = printed("Fa", c.print);
  EXPECT_EQ(printed("Fa", some), (Lines{{2}, areas[4], areas[1]}));
  const Lines neighbours = printed("Fn", some);
  for (std::size_t row = 1; row <= 2; ++row) {
    for (std::size_t k = 1; k < neighbours[row].size(); ++k) {
      const double label = neighbours[row][k];
      EXPECT_TRUE(label == 0.0 || label == 1.0 || label <= -1.0);
    }
  }
  const std::size_t vertex_count = some.vertices.size();
  EXPECT_EQ(printed("Fx", some).size(), vertex_count + 1);
  EXPECT_EQ(printed("p", some).size(), vertex_count + 2);
  const Lines facets_of_points = printed("FN", some);
  ASSERT_EQ(facets_of_points.size(), 31U);
  EXPECT_EQ(std::count(facets_of_points.begin() + 1, facets_of_points.end(), std::vector<double>{0}),
            static_cast<std::ptrdiff_t>(30 - vertex_count));
}

TEST(QhullFormatsExample, ListsAreSplitAtCommasAndBlanksAndUnknownNamesRefused) {
  EXPECT_EQ(split_qhull_formats("n,Fx o"), (std::vector<std::string>{"n", "Fx", "o"}));
  expect_error(ErrorCode::kUsage, "\"Fz\"", [] { split_qhull_formats("n,Fz"); });
}

}  // namespace
}  // namespace ndhull
