// A cross-polytope in 5-d has 2^5 facets and 2 * 5 vertices.
#include <ndhull/hull.h>

#include <cstdio>
#include <vector>

int main() {
  constexpr std::size_t kDimension = 5;
  std::vector<double> coordinates;
  for (std::size_t axis = 0; axis < kDimension; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t column = 0; column < kDimension; ++column) {
        coordinates.push_back(column == axis ? sign : 0.0);
      }
    }
  }
  const ndhull::PointView points =
      ndhull::PointView::row_major(coordinates.data(), 2 * kDimension, kDimension);
  const ndhull::Hull hull = ndhull::convex_hull(points);
  std::printf("%zu facets, %zu vertices, widest %g\n", hull.facet_count(), hull.vertices.size(),
              hull.max_facet_width);
  return hull.facet_count() == 32 && hull.vertices.size() == 10 ? 0 : 1;
}
