#include "core/growth/growth.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/growth/staged_table.h"
#include "core/linear/simplex_planes.h"
#include "core/machine/block_store.h"
#include "core/machine/blocks.h"

namespace ndhull {
namespace {

/// Before a hull begins: nothing is left of one before, and no point has a place.
void clear_work(GrowthWork& work) {
  work.grower.reset();
  work.complex = SimplicialComplex();
  work.complex.rank = work.rank;
  work.free_rows = HugeArray<std::uint32_t>();
  work.free_count = 0;
  work.next_outside.assign(work.point_count, 0);
  work.heights.reset(work.point_count);
  work.points_outside = 0;
  work.waiting.clear();
  work.shifted_points.clear();
  work.counters = GrowthCounters();
  work.parting = PartingRecord();
}

/// Where a point is over the first simplex.
struct Place {
  std::uint32_t row;
  double height;  // 0: inside
};

Place place_in_simplex(const GrowthWork& work, std::uint32_t id) {
  const double* point = work.points + std::size_t{id} * work.rank;
  double best = -HUGE_VAL;
  std::uint32_t best_row = 0;
  for (std::uint32_t row = 0; row <= work.rank; ++row) {
    double gauge = -1.0;
    for (std::size_t k = 0; k < work.rank; ++k) gauge += work.complex.planes[row * work.rank + k] * point[k];
    if (gauge > best) {
      best = gauge;
      best_row = row;
    }
  }
  if (best <= 2.0 * work.options.shift) return {0, 0.0};
  return {best_row, height_above(work, best_row, best)};
}

/// A height over the first simplex that about `few` points reach, from a sample of all.
double height_of_few(const GrowthWork& work, std::size_t few) {
  constexpr std::size_t kSample = 4096;
  std::vector<double> heights;
  for (std::size_t id = 0; id < work.point_count; id += 1 + work.point_count / kSample)
    heights.push_back(place_in_simplex(work, static_cast<std::uint32_t>(id)).height);
  const auto place = static_cast<std::ptrdiff_t>(heights.size() * few / work.point_count);
  std::nth_element(heights.begin(), heights.begin() + place, heights.end(), std::greater<>());
  return heights[static_cast<std::size_t>(place)];
}

}  // namespace

void GrowthCounters::add(const GrowthCounters& other, double share) {
  created += other.created;
  insertions += other.insertions;
  undone += other.undone;
  rejected += other.rejected;
  set_aside += other.set_aside;
  in_regions += other.in_regions;
  seconds_visible += share * other.seconds_visible;
  seconds_cone += share * other.seconds_cone;
  seconds_match += share * other.seconds_match;
  seconds_partition += share * other.seconds_partition;
}

double height_above(const GrowthWork& work, std::uint32_t row, double gauge) {
  const std::vector<double>& factor = work.options.gradient_factor;
  if (factor.empty()) return gauge;
  const double* plane = work.complex.planes.data() + std::size_t{row} * work.rank;
  double gradient_sq = 0.0;
  for (std::size_t i = 0; i < work.rank; ++i) {
    double entry = 0.0;
    for (std::size_t k = i; k < work.rank; ++k) entry += factor[i * work.rank + k] * plane[k];
    gradient_sq += entry * entry;
  }
  return gauge / std::sqrt(gradient_sq);
}

double least_height(const GrowthWork& work) {
  return work.options.gradient_factor.empty() ? 2.0 * work.options.shift : work.options.outside_width;
}

void push_outside(GrowthWork& work, std::uint32_t point, std::uint32_t row, double height) {
  work.heights.put(point, row, height);
  link_outside(work, point, row, height);
  ++work.points_outside;
}

void link_outside(GrowthWork& work, std::uint32_t point, std::uint32_t row, double height) {
  std::uint32_t& head = work.complex.outside_head[row];
  if (head != 0 && height <= work.heights.height(head - 1)) {
    work.next_outside[point] = work.next_outside[head - 1];
    work.next_outside[head - 1] = point + 1;
  } else {
    work.next_outside[point] = head;
    head = point + 1;
  }
}

void take_from_outside(GrowthWork& work, std::uint32_t point) {
  const std::uint32_t row = work.heights.row(point);
  std::uint32_t next = work.complex.outside_head[row];
  work.complex.outside_head[row] = 0;
  while (next != 0) {  // all others again: the furthest of them comes first
    const std::uint32_t member = next - 1;
    next = work.next_outside[member];
    --work.points_outside;
    if (member != point) push_outside(work, member, row, work.heights.height(member));
  }
  work.heights.remove(point);
}

void forget_outside(GrowthWork& work) {
  if (work.points_outside == 0) return;
  for (std::size_t row = 0; row < work.complex.row_count; ++row) {
    std::uint32_t next = work.complex.outside_head[row];
    work.complex.outside_head[row] = 0;
    for (; next != 0; next = work.next_outside[next - 1]) work.heights.remove(next - 1);
  }
  work.points_outside = 0;
}

void start_growth(GrowthWork& work, std::span<const PointId> simplex, FirstPoints first) {
  clear_work(work);
  make_room_for(work, work.rank + 1);
  SimplicialComplex& complex = work.complex;
  complex.row_count = work.rank + 1;
  for (std::uint32_t row = 0; row <= work.rank; ++row) {
    std::uint32_t* vertices = complex.topology.data() + row * 2 * work.rank;
    std::uint32_t* neighbours = vertices + work.rank;
    for (std::uint32_t k = 0; k < work.rank; ++k) {
      const std::uint32_t other = k < row ? k : k + 1;
      vertices[k] = simplex[other].value;
      neighbours[k] = other;
    }
    if (row % 2 != 0) {  // leaving out the next vertex changes the orientation: swap two to restore it
      std::swap(vertices[0], vertices[1]);
      std::swap(neighbours[0], neighbours[1]);
    }
    const Eigen::VectorXd plane = plane_through(work.points, work.rank, complex.vertices(SimplexId{row}));
    std::copy_n(plane.data(), work.rank, complex.planes.data() + row * work.rank);
    complex.state[row] = SimplexState::kLive;
  }
  const double least = least_height(work);
  std::vector<bool> is_vertex(work.point_count, false);
  for (const PointId id : simplex) is_vertex[id.value] = true;
  // A chunk at a time: places side by side, then into the outside sets in order.
  constexpr std::size_t kChunk = std::size_t{1} << 16, kPointsInBlock = 1024;
  const bool waits_for_low = first.most < work.point_count;
  const double enough = waits_for_low ? height_of_few(work, first.most) : 0.0;
  work.waiting_height = first.stride > 1 ? HUGE_VAL : enough;
  std::vector<Place> places(std::min(kChunk, work.point_count));
  for (std::size_t chunk = 0; chunk < work.point_count; chunk += kChunk) {
    const std::size_t count = std::min(kChunk, work.point_count - chunk);
    for_each_block(count, kPointsInBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if ((chunk + i) % first.stride == 0)
          places[i] = place_in_simplex(work, static_cast<std::uint32_t>(chunk + i));
    });
    for (std::size_t i = 0; i < count; ++i) {
      const auto id = static_cast<std::uint32_t>(chunk + i);
      if (is_vertex[id]) continue;
      if (places[i].height < enough || id % first.stride != 0) {
        work.waiting.push_back(id);
      } else if (places[i].height > least) {
        push_outside(work, id, places[i].row, places[i].height);
      }
    }
  }
}

// What would fill twice the machine's memory. Only touched pages count.
// Where address space itself is limited, two fifths of it: what follows growth needs as much.
std::size_t most_rows(std::size_t rank) {
  const auto machine_bytes =
      static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t row_bytes = 16 * rank;
  // With lists of visible simplices and of ridges, one for growth and one for each of two threads and
  // regions.
  const std::size_t reserved_bytes = row_bytes + 16 + 5 * (12 * rank + 16);
  constexpr std::size_t kMostRows = std::size_t{1} << 30;  // the sign bit of a row id marks new simplices
  return std::min({2 * machine_bytes / row_bytes, address_space() / 5 * 2 / reserved_bytes, kMostRows});
}

void make_room_for(GrowthWork& work, std::size_t rows) {
  SimplicialComplex& complex = work.complex;
  const TableStages stages{most_rows(work.rank), work.options.foreseen_rows};
  const std::size_t kept = complex.row_count, room = stages.rows_for(rows);
  move_to_stage(complex.planes, stages, kept, room, work.rank);
  move_to_stage(complex.topology, stages, kept, room, 2 * work.rank);
  move_and_clear(complex.state, stages, kept, room);
  move_and_clear(complex.outside_head, stages, kept, room);
  move_list(work.free_rows, stages, work.free_count, room);
}

GrownHull take_grown(GrowthWork& work) {
  work.grower.reset();
  forget_outside(work);
  return {std::move(work.complex), std::move(work.free_rows), work.free_count, work.counters};
}

void start_growth(GrowthWork& work, GrownHull grown) {
  clear_work(work);
  work.complex = std::move(grown.complex);
  work.free_rows = std::move(grown.free_rows);
  work.free_count = grown.free_count;
  work.counters = grown.counters;
  const std::vector<bool> is_vertex = find_corners(work.complex, 0, work.complex.row_count, work.point_count);
  for (std::uint32_t id = 0; id < work.point_count; ++id)
    if (!is_vertex[id]) work.waiting.push_back(id);
  work.waiting_height = HUGE_VAL;
}

std::vector<bool> find_corners(const GrowthWork& work) {
  return find_corners(work.complex, 0, work.complex.row_count, work.point_count, work.most_vertices());
}

}  // namespace ndhull
