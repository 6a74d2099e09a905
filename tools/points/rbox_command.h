// What an rbox command asks for, before any point is made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ndhull {

/// The parsed command. Defaults are rbox's.
struct RboxCommand {
  std::string text;       ///< "rbox " and the words, joined by one blank; with 't' the seed appended
  std::int32_t seed = 1;  ///< in 1 .. 2^31 - 2
  std::size_t count = 0;  ///< random or regular points, without P, C, c, d, simplex and poles
  std::size_t dimension = 3;

  bool is_sphere = false;       ///< s
  bool is_simplex = false;      ///< x or y
  bool print_simplex = false;   ///< y
  bool is_regular = false;      ///< r
  bool is_spiral = false;       ///< l, unless r
  bool is_lens = false;         ///< L
  bool is_mesh = false;         ///< M
  bool is_axis = false;         ///< Z
  bool has_gap = false;         ///< G on its own
  bool has_width = false;       ///< W
  bool is_integer = false;      ///< z
  bool is_homogeneous = false;  ///< h
  bool hides_command = false;   ///< n
  bool has_cube = false;        ///< c
  bool has_diamond = false;     ///< d

  double box = 0.5;            ///< [distance] B: half the side of the cube, radius of the sphere
  double gap = 0.5;            ///< [ratio] meaningful with has_gap
  double width = 0.0;          ///< [ratio] meaningful with has_width
  double lens_radius = 10.0;   ///< [ratio] of the box, > 1
  double axis_radius = 1.0;    ///< [ratio]
  double mesh[3] = {0, 0, 0};  ///< [distance] n, m, r
  double offset = 0.0;         ///< [distance] O
  double cube_size = 0.0;      ///< [distance] half the side
  double diamond_size = 0.0;   ///< [distance]

  std::size_t copies = 0;    ///< C: copies of each copied point
  double copy_radius = 0.0;  ///< [distance]
  std::size_t copied_points = 0;

  std::vector<double> explicit_points;  ///< rows x dimension, padded with 0
};

/// Reads the arguments of rbox. Throws Error kUsage, see rbox_text.
RboxCommand parse_rbox(std::string_view arguments);

}  // namespace ndhull
