#include "tests/hull/exact_oracle.h"

#include <CGAL/Epick_d.h>
#include <CGAL/Triangulation.h>
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdio>

namespace ndhull {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Row = std::vector<Rational>;

/// Row echelon form in place; returns the pivot columns.
std::vector<std::size_t> eliminate(std::vector<Row>& rows, std::size_t columns) {
  std::vector<std::size_t> pivots;
  for (std::size_t column = 0; column < columns && pivots.size() < rows.size(); ++column) {
    const std::size_t top = pivots.size();
    std::size_t row = top;
    while (row < rows.size() && rows[row][column] == 0) ++row;
    if (row == rows.size()) continue;
    std::swap(rows[top], rows[row]);
    for (std::size_t other = 0; other < rows.size(); ++other) {
      if (other == top || rows[other][column] == 0) continue;
      const Rational factor = rows[other][column] / rows[top][column];
      for (std::size_t k = column; k < columns; ++k) rows[other][k] -= factor * rows[top][k];
    }
    pivots.push_back(column);
  }
  return pivots;
}

/// The plane (a, b) with a.x + b = 0 at d homogeneous rows (x, 1); empty unless they span exactly one.
Row plane_through(std::vector<Row> rows) {
  const std::size_t columns = rows.front().size();
  const std::vector<std::size_t> pivots = eliminate(rows, columns);
  if (pivots.size() != columns - 1) return {};
  std::size_t free_column = 0;
  while (free_column < pivots.size() && pivots[free_column] == free_column) ++free_column;
  Row plane(columns, 0);
  plane[free_column] = 1;
  for (std::size_t k = 0; k < pivots.size(); ++k)
    plane[pivots[k]] = -rows[k][free_column] / rows[k][pivots[k]];
  return plane;
}

/// Of the points in supporting hyperplanes only those are vertices that d independent normals meet in.
std::vector<VertexSet> without_redundant_points(const std::vector<std::pair<Row, VertexSet>>& facets,
                                                std::size_t n, std::size_t d) {
  std::vector<bool> is_vertex(n, false);
  for (std::uint32_t id = 0; id < n; ++id) {
    std::vector<Row> normals;
    for (const auto& [plane, points] : facets) {
      if (std::binary_search(points.begin(), points.end(), id))
        normals.emplace_back(plane.begin(), plane.end() - 1);
    }
    is_vertex[id] = eliminate(normals, d).size() == d;
  }
  std::vector<VertexSet> result;
  for (const auto& [plane, points] : facets) {
    result.emplace_back();
    for (const std::uint32_t id : points) {
      if (is_vertex[id]) result.back().push_back(id);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

std::vector<VertexSet> facets_by_brute_force(const PointSet& set) {
  const std::size_t n = set.rows(), d = set.dimension;
  std::vector<Row> points(n, Row(d + 1, 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < d; ++k) points[i][k] = Rational(set.row(i)[k]);
  }
  std::set<VertexSet> seen;
  std::vector<std::pair<Row, VertexSet>> facets;
  std::vector<bool> chosen(n, false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(d), true);
  do {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < n; ++i) {
      if (chosen[i]) rows.push_back(points[i]);
    }
    const Row plane = plane_through(rows);
    if (plane.empty()) continue;
    bool above = false, below = false;
    VertexSet on;
    for (std::uint32_t i = 0; i < n; ++i) {
      Rational value = 0;
      for (std::size_t k = 0; k <= d; ++k) value += plane[k] * points[i][k];
      above |= value > 0;
      below |= value < 0;
      if (value == 0) on.push_back(i);
    }
    if (above != below && seen.insert(on).second) facets.emplace_back(plane, on);
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return without_redundant_points(facets, n, d);
}

std::vector<VertexSet> facets_by_cgal(const PointSet& set) {
  using Kernel = CGAL::Epick_d<CGAL::Dynamic_dimension_tag>;
  using Vertex = CGAL::Triangulation_vertex<Kernel, std::uint32_t>;
  using Cell = CGAL::Triangulation_full_cell<Kernel>;
  using Structure = CGAL::Triangulation_data_structure<CGAL::Dynamic_dimension_tag, Vertex, Cell>;
  const int d = static_cast<int>(set.dimension);
  CGAL::Triangulation<Kernel, Structure> triangulation(d);
  for (std::uint32_t id = 0; id < set.rows(); ++id) {
    const auto row = set.row(id);
    const auto vertex = triangulation.insert(Kernel::Point_d(d, row.begin(), row.end()));
    vertex->data() = id;
  }
  std::vector<VertexSet> facets;
  for (auto cell = triangulation.full_cells_begin(); cell != triangulation.full_cells_end(); ++cell) {
    if (!triangulation.is_infinite(*cell)) continue;
    facets.emplace_back();
    for (int k = 0; k <= d; ++k) {
      if (!triangulation.is_infinite(cell->vertex(k))) facets.back().push_back(cell->vertex(k)->data());
    }
    std::sort(facets.back().begin(), facets.back().end());
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

std::uint64_t facet_count_by_qhull(const PointSet& set, const std::string& options) {
  std::vector<coordT> coordinates(set.coordinates.begin(), set.coordinates.end());
  std::string command = "qhull Qx " + options;
  qhT qhull;
  QHULL_LIB_CHECK
  qh_zero(&qhull, stderr);
  std::uint64_t count = 0;
  if (qh_new_qhull(&qhull, static_cast<int>(set.dimension), static_cast<int>(set.rows()), coordinates.data(),
                   False, command.data(), nullptr, stderr) == 0) {
    count = static_cast<std::uint64_t>(qhull.num_facets);
  }
  qh_freeqhull(&qhull, !qh_ALL);
  int blocks = 0, bytes = 0;
  qh_memfreeshort(&qhull, &blocks, &bytes);
  return count;
}

}  // namespace ndhull
