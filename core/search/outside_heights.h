// Which point is furthest outside? A tree of largest heights over all points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ndhull {

/// Heights of the points in outside sets, and the furthest of them.
///
/// Idea    A height is written far more often than the furthest is asked for, and hardly ever is the one
///         written the largest of its block: only then the block is looked at again, and not before the
///         question. A heap of outside sets has as many stale entries as points move; taking them off was a
///         twentieth of the time in 5-d.
/// Memory  12 bytes a point, and 9 for 64 of them.
class OutsideHeights {
 public:
  /// What `height` says of a point in no outside set.
  static constexpr double kNotOutside = -1.0;

  struct Furthest {
    double height;      ///< kNotOutside: no point is in an outside set
    std::uint32_t row;  ///< of the simplex in whose set it is; of several with that height the lowest
  };

  /// Forgets all points; `count` points are in no outside set.
  void reset(std::size_t count);
  /// More points, in no outside set. Cost as `reset`.
  void extend(std::size_t count);

  /// Shapes  height: not negative.
  void put(std::uint32_t point, std::uint32_t row, double height) {
    rows_[point] = row;
    write(0, point, height);
  }
  void remove(std::uint32_t point) { write(0, point, kNotOutside); }

  /// As `put` and `remove`, for different points at the same time; `settle` each point before the furthest is
  /// asked for.
  void put_apart(std::uint32_t point, std::uint32_t row, double height) {
    rows_[point] = row;
    levels_[0].values[point] = height;
  }
  void settle(std::uint32_t point) {
    if (levels_.size() > 1) mark_dirty(1, point / kBlock);
  }

  /// Appends the points that are higher than `height`, in ascending order. To be asked after `furthest`.
  void list_above(double height, std::vector<std::uint32_t>& points) const;

  /// Of a point in an outside set: whose.
  std::uint32_t row(std::uint32_t point) const { return rows_[point]; }
  double height(std::uint32_t point) const { return levels_[0].values[point]; }
  /// Cost  amortised some dozen comparisons for each point written; where many points are equally far, one
  ///       for each of them.
  Furthest furthest();

 private:
  static constexpr std::size_t kBlock = 64;

  /// Entry i of a level is at least the largest of block i of the level below; equal to it, unless dirty.
  struct Level {
    std::vector<double> values;          // a multiple of kBlock, filled up with kNotOutside
    std::vector<std::uint8_t> is_dirty;  // of the lowest level none
    std::vector<std::uint32_t> dirty;
  };

  void write(std::size_t level, std::size_t index, double value) {
    double& entry = levels_[level].values[index];
    const double before = entry;
    entry = value;
    if (level + 1 == levels_.size()) return;
    const std::size_t block = index / kBlock;
    const double largest = levels_[level + 1].values[block];
    if (value > largest) {
      write(level + 1, block, value);
    } else if (before == largest && value < before) {
      mark_dirty(level + 1, block);
    }
  }
  void mark_dirty(std::size_t level, std::size_t block);
  double largest_in_block(std::size_t level, std::size_t block) const;
  std::uint32_t lowest_row(std::size_t level, std::size_t block, double height) const;
  void list_above(std::size_t level, std::size_t block, double height,
                  std::vector<std::uint32_t>& points) const;

  std::vector<Level> levels_;  // the last one has one block
  std::vector<std::uint32_t> rows_;
};

}  // namespace ndhull
