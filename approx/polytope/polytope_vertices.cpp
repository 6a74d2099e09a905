#include "approx/polytope/polytope_vertices.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/linear/dense_solve.h"
#include "core/linear/dense_views.h"

namespace ndhull {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [ratio to a plane's height] Rounding of planes that coplanar merging of the dual hull takes care of
/// itself: a tenth of its shift.
constexpr double kCoveredByHull = 1e-13;
/// Roundings by which planes through one vertex may miss it: what text of 16 digits adds, and the vertex's
/// own error from the planes that determine it.
constexpr double kSameVertexRoundings = 16.0;
/// Roundings of a term of a plane's value, a term and a spare one each, that a vertex may be off without
/// being refined.
constexpr double kAcceptedRoundings = 4.0;
constexpr int kRefinements = 3;
constexpr std::size_t kBetweenClocks = 256;

class VertexPlacer {
 public:
  VertexPlacer(const HalfspaceSet& halfspaces, const HalfspaceRegion& region, std::span<const double> centre,
               const PlanesAboutOrigin& planes, const PlanePolytope& polytope, const WorkEnd& end)
      : halfspaces_(halfspaces),
        region_(region),
        centre_(centre),
        planes_(planes),
        polytope_(polytope),
        end_(end),
        dimension_(halfspaces.dimension()),
        count_(polytope.vertex_count(planes.rank)) {}

  PolytopeVertices run() {
    for (const std::uint32_t plane : polytope_.non_redundant)
      result_.non_redundant.push_back(region_.planes[plane]);
    place_all();
    if (needs_merging()) {
      cluster_of_.resize(count_);
      std::iota(cluster_of_.begin(), cluster_of_.end(), 0U);
      find_local_normals();
      merge_close_vertices();
      list_clusters();
    } else {
      list_all();
    }
    for (std::size_t cluster = 0; cluster + 1 < result_.halfspaces.begin.size(); ++cluster) refine(cluster);
    return std::move(result_);
  }

 private:
  /// x = centre + directions y.
  void place_all() {
    const Index rank = static_cast<Index>(planes_.rank);
    positions_.resize(count_ * dimension_);
    for (std::size_t vertex = 0; vertex < count_; ++vertex) {
      const double* const local = polytope_.vertices.data() + vertex * planes_.rank;
      for (std::size_t k = 0; k < dimension_; ++k) {
        double sum = 0.0;
        for (Index j = 0; j < rank; ++j) sum += region_.directions(static_cast<Index>(k), j) * local[j];
        positions_[vertex * dimension_ + k] = centre_[k] + sum;
      }
    }
  }

  std::span<const double> position(std::size_t vertex) const {
    return {positions_.data() + vertex * dimension_, dimension_};
  }

  /// Distance of x above a halfspace's plane in working precision, and the rounding of the plane there.
  double plain_distance(std::uint32_t halfspace, const double* x, double& roundoff) const {
    const double* const row = halfspaces_.normal(halfspace).data();
    const double offset = halfspaces_.offset(halfspace);
    double sum = offset, size = std::abs(offset);
    for (std::size_t k = 0; k < dimension_; ++k) {
      const double term = row[k] * x[k];
      sum += term;
      size += std::abs(term);
    }
    roundoff = 0x1p-53 * size / halfspaces_.length(halfspace);
    return sum / halfspaces_.length(halfspace);
  }

  bool needs_merging() const {
    for (const std::uint32_t plane : polytope_.non_redundant) {
      if (halfspaces_.roundoff(region_.planes[plane], centre_) > kCoveredByHull * planes_.heights[plane])
        return true;
    }
    return false;
  }

  /// Column by column the unit normals of the planes in coordinates of the subspace, shorter where they leave
  /// it.
  void find_local_normals() {
    local_normals_.resize(static_cast<Index>(planes_.rank), static_cast<Index>(region_.planes.size()));
    for (Index plane = 0; plane < local_normals_.cols(); ++plane) {
      const std::uint32_t id = region_.planes[static_cast<std::size_t>(plane)];
      local_normals_.col(plane) =
          region_.directions.transpose() * as_vector(halfspaces_.normal(id)) / halfspaces_.length(id);
    }
  }

  auto local_normal(std::uint32_t plane) const { return local_normals_.col(static_cast<Index>(plane)); }

  MatrixXd normals_of_simplex(std::size_t row) const {
    const auto rank = static_cast<Index>(planes_.rank);
    MatrixXd normals(rank, rank);
    for (Index k = 0; k < rank; ++k)
      normals.col(k) = local_normal(polytope_.planes[row * planes_.rank + static_cast<std::size_t>(k)]);
    return normals;
  }

  /// Of each vertex the simplex whose planes determine it best: their unit normals span the largest volume.
  struct Determination {
    double volume = -1.0;
    std::size_t simplex = 0;
  };

  /// None when work has ended before.
  std::vector<Determination> determinations() const {
    std::vector<Determination> widest(count_);
    for (std::size_t row = 0; row < polytope_.vertex_of.size(); ++row) {
      if (row % kBetweenClocks == 0 && end_.is_here()) return {};
      const double volume = std::abs(SquareFactors(normals_of_simplex(row)).determinant());
      Determination& best = widest[polytope_.vertex_of[row]];
      if (volume > best.volume) best = {volume, row};
    }
    return widest;
  }

  /// A vertex as its planes determine it, to within their rounding.
  class Seed {
   public:
    Seed(const VertexPlacer& placer, std::uint32_t vertex, std::size_t simplex)
        : placer_(placer),
          position_(placer.positions_.data() + vertex * placer.dimension_),
          factors_(placer.normals_of_simplex(simplex)),
          roundoff_(static_cast<Index>(placer.planes_.rank)) {
      for (Index k = 0; k < roundoff_.size(); ++k) {
        const std::size_t at = simplex * placer.planes_.rank + static_cast<std::size_t>(k);
        placer.plain_distance(placer.region_.planes[placer.polytope_.planes[at]], position_, roundoff_[k]);
      }
    }

    /// Moving the seed's planes by r_i moves it by sum y_i r_i off a plane with normal sum y_i n_i.
    bool is_on_planes_of(std::uint32_t vertex) const {
      for (const std::uint32_t plane : placer_.polytope_.planes_of.row(vertex)) {
        double roundoff = 0.0;
        const double distance = placer_.plain_distance(placer_.region_.planes[plane], position_, roundoff);
        if (std::abs(distance) <= kSameVertexRoundings * roundoff) continue;
        const VectorXd shares = factors_.solve(placer_.local_normal(plane));
        roundoff += shares.cwiseAbs().dot(roundoff_);
        if (!(std::abs(distance) <= kSameVertexRoundings * roundoff)) return false;
      }
      return true;
    }

   private:
    const VertexPlacer& placer_;
    const double* position_;
    SquareFactors factors_;
    VectorXd roundoff_;
  };

  void merge_close_vertices() {
    const std::vector<Determination> determination = determinations();
    if (determination.empty()) return;
    std::vector<std::uint32_t> order(count_);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&determination](std::uint32_t a, std::uint32_t b) {
      return determination[a].volume > determination[b].volume;
    });
    std::vector<bool> taken(count_, false);
    std::vector<std::uint32_t> to_visit;
    for (const std::uint32_t first : order) {
      if (taken[first]) continue;
      if (end_.is_here()) return;  // the others stay apart
      taken[first] = true;
      const Seed seed(*this, first, determination[first].simplex);
      to_visit.assign(1, first);
      while (!to_visit.empty()) {
        const std::uint32_t vertex = to_visit.back();
        to_visit.pop_back();
        for (const std::uint32_t neighbour : polytope_.neighbours_of.row(vertex)) {
          if (taken[neighbour] || !seed.is_on_planes_of(neighbour)) continue;
          taken[neighbour] = true;
          cluster_of_[neighbour] = first;
          to_visit.push_back(neighbour);
        }
      }
    }
  }

  /// Every vertex by itself.
  void list_all() {
    result_.coordinates = std::move(positions_);
    result_.halfspaces = polytope_.planes_of;
    result_.neighbours = polytope_.neighbours_of;
    for (IdRows* const rows : {&result_.halfspaces, &result_.neighbours}) {
      for (std::size_t row = 0; row < count_; ++row) {
        const auto begin = rows->values.begin();
        std::sort(begin + rows->begin[row], begin + rows->begin[row + 1]);
      }
    }
    for (std::uint32_t& id : result_.halfspaces.values) id = region_.planes[id];  // keeps the order
  }

  /// Vertices in the order of their seeds, with the halfspaces and neighbours of all that was taken in.
  void list_clusters() {
    std::vector<std::uint32_t> number(count_), size(count_, 0), members(count_);
    std::uint32_t clusters = 0;
    for (std::uint32_t vertex = 0; vertex < count_; ++vertex) {
      if (cluster_of_[vertex] == vertex) number[vertex] = clusters++;
      ++size[cluster_of_[vertex]];
    }
    std::vector<std::uint32_t> begin(clusters + 1, 0);
    for (std::uint32_t vertex = 0; vertex < count_; ++vertex) {
      if (cluster_of_[vertex] == vertex) begin[number[vertex] + 1] = size[vertex];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    for (std::uint32_t vertex = 0; vertex < count_; ++vertex)
      members[next[number[cluster_of_[vertex]]]++] = vertex;
    result_.coordinates.reserve(clusters * dimension_);
    for (std::uint32_t vertex = 0; vertex < count_; ++vertex) {
      if (cluster_of_[vertex] != vertex) continue;
      const auto x = position(vertex);
      result_.coordinates.insert(result_.coordinates.end(), x.begin(), x.end());
      const std::uint32_t own = number[vertex];
      for (std::uint32_t k = begin[own]; k < begin[own + 1]; ++k) {
        for (const std::uint32_t plane : polytope_.planes_of.row(members[k]))
          result_.halfspaces.values.push_back(region_.planes[plane]);
        for (const std::uint32_t neighbour : polytope_.neighbours_of.row(members[k])) {
          const std::uint32_t other = number[cluster_of_[neighbour]];
          if (other != own) result_.neighbours.values.push_back(other);
        }
      }
      close_row(result_.halfspaces);
      close_row(result_.neighbours);
    }
  }

  /// Sorts the values behind the last row, drops repeated ones and makes them a row.
  static void close_row(IdRows& rows) {
    const auto begin = rows.values.begin() + rows.begin.back();
    std::sort(begin, rows.values.end());
    rows.values.erase(std::unique(begin, rows.values.end()), rows.values.end());
    rows.end_row();
  }

  /// The largest distance from the planes of a vertex; `excess`: over what is accepted, as a ratio.
  double residual(std::size_t cluster, const double* x, double& excess) const {
    double largest = 0.0;
    excess = 0.0;
    const double accepted = kAcceptedRoundings * static_cast<double>(dimension_ + 2);
    for (const std::uint32_t halfspace : result_.halfspaces.row(cluster)) {
      double roundoff = 0.0;
      const double distance = std::abs(plain_distance(halfspace, x, roundoff));
      largest = std::max(largest, distance);
      if (distance > accepted * roundoff) excess = std::max(excess, distance / (accepted * roundoff));
    }
    return largest;
  }

  void refine(std::size_t cluster) {
    double* const x = result_.coordinates.data() + cluster * dimension_;
    double excess = 0.0;
    double largest = residual(cluster, x, excess);
    for (int round = 0; round < kRefinements && excess > 1.0 && !end_.is_here(); ++round) {
      const auto ids = result_.halfspaces.row(cluster);
      MatrixXd normals(static_cast<Index>(ids.size()), region_.directions.cols());
      VectorXd distances(normals.rows());
      for (Index row = 0; row < normals.rows(); ++row) {
        const std::uint32_t id = ids[static_cast<std::size_t>(row)];
        normals.row(row) =
            as_vector(halfspaces_.normal(id)).transpose() * region_.directions / halfspaces_.length(id);
        distances[row] = halfspaces_.distance(id, {x, dimension_});
      }
      const VectorXd step = region_.directions * PivotedFactors(normals).solve(distances);
      const VectorXd moved = as_vector({x, dimension_}) - step;
      double moved_excess = 0.0;
      const double moved_largest = residual(cluster, moved.data(), moved_excess);
      if (!(moved_excess < excess)) break;
      std::copy(moved.begin(), moved.end(), x);
      excess = moved_excess;
      largest = moved_largest;
    }
    result_.max_residual = std::max(result_.max_residual, largest);
  }

  const HalfspaceSet& halfspaces_;
  const HalfspaceRegion& region_;
  std::span<const double> centre_;
  const PlanesAboutOrigin& planes_;
  const PlanePolytope& polytope_;
  const WorkEnd& end_;
  std::size_t dimension_, count_;
  std::vector<double> positions_;
  MatrixXd local_normals_;
  std::vector<std::uint32_t> cluster_of_;  // of each vertex: the one that took it in, or itself
  PolytopeVertices result_;
};

}  // namespace

PolytopeVertices place_vertices(const HalfspaceSet& halfspaces, const HalfspaceRegion& region,
                                std::span<const double> centre, const PlanesAboutOrigin& planes,
                                const PlanePolytope& polytope, const WorkEnd& end) {
  return VertexPlacer(halfspaces, region, centre, planes, polytope, end).run();
}

}  // namespace ndhull
