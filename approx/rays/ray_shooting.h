// The facets of a hull that rays hit, or that lie across ridges, without the hull: linear programs over the
// points, many at a time.
//
// 1 core      Walks go over a small set of points first: those that were above some plane before. It is what
//             the large facets are made of, and stays in cache.
// 2 all       Planes that no point of the core is above are multiplied with all points, in single precision.
//             A point found above goes to the core, and the walk goes on.
// 3 decide    What single precision leaves open is decided in double precision. A plane that no point is
//             above is a facet's, and the points on it are known.
//
// Steps 1 and 3 are shared out walk by walk, step 2 by blocks of points; the core changes between rounds
// only, in the order of the walks. So the results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "approx/rays/cone_walk.h"
#include "approx/rays/direction_scan.h"
#include "approx/work_end.h"
#include "core/frame.h"
#include "core/points.h"

namespace ndhull {

/// What to walk to.
struct WalkTask {
  /// Ray: rank numbers, in the frame, from its centre 0. Empty: over a ridge.
  std::vector<double> direction = {};
  /// Ridge: rank points of a facet, and which of them is not on the ridge.
  std::vector<std::uint32_t> basis = {};
  std::size_t place = 0;
  /// The hull is that of all points but this one.
  std::uint32_t skip = DirectionQuery::kNoPoint;
  /// Ray: is the point `direction` in the hull? The walk ends as soon as that is proven, or the opposite.
  bool asks_inside = false;
};

enum class WalkEnd {
  kFacet,     ///< no point is above the plane
  kInside,    ///< `direction` is in the hull (or above it by less than rounding)
  kOutside,   ///< asks_inside: all points are below the plane a.y = level, `direction` is above it
  kOpen,      ///< rounding or the limit of pivots ended the walk: nothing is known
  kNotBegun,  ///< or not ended: it was time to stop first
};

struct WalkResult {
  WalkEnd end = WalkEnd::kNotBegun;
  /// rank points on the plane; kInside: what `direction` is a combination of, with points on the axes, whose
  /// ids are those after the points'
  std::vector<std::uint32_t> basis;
  std::vector<double> weights;          ///< kInside: of the basis, in that combination
  std::vector<double> plane;            ///< a with a.y = 1 at the basis, frame
  std::vector<std::uint32_t> on_plane;  ///< kFacet: ids of all points within `coplanar` of the plane,
                                        ///< ascending; of equal points the first
  double determinant = 0.0;             ///< kFacet: of the basis, frame
  double coplanar = 0.0;                ///< [gauge]
  double gauge = 0.0;                   ///< ray: a.direction
  double level = 1.0;                   ///< kOutside: between a.y for all points y and the gauge,
  double gap = 0.0;                     ///< and at least so far from both, but for rounding [gauge]
};

/// Counters of the work, which do not depend on the machine.
struct WalkCounters {
  std::uint64_t walks = 0, pivots = 0, open = 0;
  std::uint64_t core_products = 0;  ///< points times directions
  std::uint64_t all_products = 0;   ///< the same, of planes with all points
};

/// The points in a frame, and walks over them.
class RayShooter {
 public:
  /// Reads the points. The frame's centre is moved to the middle of points that are furthest along some
  /// directions, where rays see large facets under large angles.
  /// Throws    Error as fit_frame.
  /// Cost      time of some 300 products of all points with a direction; 12 rank bytes a point.
  /// Near      points no further from an earlier one are met as that. [ratio to the longest point]
  explicit RayShooter(const PointView& points, double near = 0.0);

  const Frame& frame() const { return frame_; }
  FramePoints points() const { return {coordinates_.data(), frame_.rank, all_.largest_length()}; }
  std::size_t point_count() const { return point_count_; }
  /// Points that walks meet: of equal points only the first.
  std::size_t distinct_count() const { return all_.size(); }
  /// The one in this place, the longest first.
  std::uint32_t distinct_point(std::size_t place) const { return all_.id(place); }
  /// Of each point the distinct one that it is equal or near to.
  std::span<const std::uint32_t> copy_of() const { return copy_of_; }
  std::size_t core_size() const { return core_.size(); }
  const WalkCounters& counters() const { return counters_; }

  /// Walks. Precondition: rank >= 2.
  /// Returns   one result a task, in order. A stop request leaves those not begun; those begun are ended,
  ///           so that what rays hit stays a fair sample. `end` leaves both.
  std::vector<WalkResult> walk(std::span<const WalkTask> tasks, std::stop_token stop = {},
                               const WorkEnd& end = {});

  /// Adds a point to the core.
  void add_to_core(std::uint32_t id);

 private:
  struct Walker;
  void fill_tiles(double near);
  std::vector<std::uint32_t> find_centre(const PointView& points);
  bool begin(const WalkTask& task, const Walker* begun, Walker& walker) const;
  void walk_on_core(std::span<Walker*> walkers, const WorkEnd& end, WalkCounters& counters) const;
  bool ends_inside(Walker& walker) const;
  bool separates(Walker& walker, const DirectionQuery& answer) const;
  void decide(Walker& walker) const;
  void take_in(std::uint32_t id, Walker& walker) const;
  void end_at_facet(double above, Walker& walker) const;

  Frame frame_;
  std::size_t point_count_ = 0;
  double inner_radius_ = 0.0;        // of a ball about 0 in the hull
  std::vector<double> coordinates_;  // the points and 2 rank points inside the hull, on the axes
  ScanTiles all_{0}, core_{0};
  std::vector<bool> is_in_core_;
  std::vector<std::uint32_t> copy_of_;
  WalkCounters counters_;
};

}  // namespace ndhull
