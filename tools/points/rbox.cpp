// The generators of rbox. Written from rbox's manual and from its output; no code of it was used.
//
// One stream of Lehmer's minimal standard generator feeds everything, so the order of the draws is part of
// each family: coordinates first, then gap, width and sign. Rounding is, too: expressions are evaluated in
// the order that gives rbox's last digit, which is why some of them look roundabout.
//
// Park, Miller. Random number generators: good ones are hard to find. Comm. ACM 31(10), 1988.

#include "tools/points/rbox.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "tools/points/rbox_command.h"

namespace ndhull {
namespace {

constexpr double kRandomMax = 2147483646.0;  // largest value of the generator

class Stream {
 public:
  explicit Stream(std::int32_t seed) : state_(seed) {}
  // In 1 .. 2^31 - 2.
  std::int64_t next() {
    state_ = 16807 * state_ % 2147483647;
    return state_;
  }
  double unit() { return static_cast<double>(next()) / kRandomMax; }  // (0, 1]
  double times(double factor) { return factor * static_cast<double>(next()) / kRandomMax; }
  // (-1, 1]
  double coordinate() { return 2.0 * static_cast<double>(next()) / kRandomMax - 1.0; }

 private:
  std::int64_t state_;
};

// Rows in the order of rbox; `regular_rows` of them, from `first_regular` on, are printed without the blank
// that ends the others.
struct Points {
  std::size_t dimension = 0;
  std::size_t first_regular = 0;
  std::size_t regular_rows = 0;
  std::vector<double> values;

  std::size_t rows() const { return values.size() / dimension; }
  void add(const std::vector<double>& row) { values.insert(values.end(), row.begin(), row.end()); }
};

double norm_of(const std::vector<double>& row, std::size_t count) {
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k) sum += row[k] * row[k];
  return std::sqrt(sum);
}

// Moves one coordinate, drawn at random from the first `count`, to within `width` of the unit cube's faces.
void push_to_face(std::vector<double>& row, std::size_t count, double width, Stream& stream) {
  const auto k = static_cast<std::size_t>(stream.next()) % count;
  row[k] = row[k] < 0.0 ? -1.0 - row[k] * width : 1.0 - row[k] * width;
}

void scale(std::vector<double>& row, std::size_t count, double factor) {
  for (std::size_t k = 0; k < count; ++k) row[k] *= factor;
}

// Distance of the rim's plane from the centre of the sphere a lens is cut from.
double lens_base(const RboxCommand& c) { return c.lens_radius * std::cos(std::asin(1.0 / c.lens_radius)); }

// A lens is two caps of a sphere of radius n that meet in the unit sphere (or cube) of the first d-1 axes.
void draw_lens_point(const RboxCommand& c, std::vector<double>& row, Stream& stream) {
  const std::size_t flat = c.dimension - 1;
  const double gap = c.has_gap ? c.gap : 1.0;
  const double base = lens_base(c);
  for (std::size_t k = 0; k < flat; ++k) row[k] = stream.coordinate();
  if (c.is_sphere) {
    const double norm = norm_of(row, flat);
    scale(row, flat, (1.0 - stream.times(gap)) / norm);
  } else {
    push_to_face(row, flat, gap, stream);
  }
  row[flat] = base;
  const double norm = norm_of(row, c.dimension);
  for (double& value : row) value = value * c.lens_radius / norm;
  row[flat] -= base;
  if (c.has_width) row[flat] *= 1.0 - stream.times(c.width);
  if (static_cast<double>(stream.next()) > kRandomMax * 0.5) row[flat] = -row[flat];
}

// A disk around the last axis, projected to the sphere with 's'.
void draw_axis_point(const RboxCommand& c, std::vector<double>& row, Stream& stream) {
  const std::size_t flat = c.dimension - 1;
  const double gap = c.has_gap ? c.gap : 1.0;
  for (std::size_t k = 0; k < flat; ++k) row[k] = stream.coordinate();
  const double norm = norm_of(row, flat);
  scale(row, flat, c.axis_radius * (1.0 - stream.times(gap)) / norm);
  if (!c.is_sphere) {
    row[flat] = stream.coordinate();
    return;
  }
  row[flat] = 1.0;
  double length_sq = 1.0;
  for (std::size_t k = 0; k < flat; ++k) length_sq += row[k] * row[k];
  const double length = std::sqrt(length_sq);
  for (double& value : row) value /= length;
  if (c.has_width) row[flat] *= 1.0 - stream.times(c.width);
}

void draw_point(const RboxCommand& c, std::vector<double>& row, std::size_t index, Stream& stream) {
  for (double& value : row) value = stream.coordinate();
  if (c.is_sphere) {
    double factor = 1.0 / norm_of(row, c.dimension);
    if (c.has_width) factor *= 1.0 - stream.times(c.width);
    scale(row, c.dimension, factor);
    return;
  }
  if (c.is_spiral) {  // the draws are thrown away
    const double last = static_cast<double>(c.count - 1);
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(index) / last;
    row[0] = std::cos(angle);
    row[1] = std::sin(angle);
    row[2] = 2.0 * static_cast<double>(index) / last - 1.0;
  }
  if (c.has_width) push_to_face(row, c.dimension, c.width, stream);
}

// Point `index` of the lattice, counted with the first axis running fastest.
void lattice_point(const RboxCommand& c, std::vector<double>& row, std::size_t index, std::size_t side) {
  for (double& value : row) {
    value = static_cast<double>(index % side);
    index /= side;
  }
  const double x = row[0];
  if (c.dimension > 1) {
    const double y = row[1];
    row[0] = c.mesh[0] * x - c.mesh[1] * y;
    row[1] = c.mesh[1] * x + c.mesh[0] * y;
  } else {
    row[0] = c.mesh[0] * x;
  }
  for (std::size_t k = 2; k < c.dimension; ++k) row[k] *= c.mesh[2];
}

std::size_t lattice_side(std::size_t count, std::size_t dimension) {
  for (std::size_t side = 1;; ++side) {
    std::size_t cells = 1;
    for (std::size_t k = 0; k < dimension && cells < count; ++k) cells *= side;
    if (cells >= count) return side;
  }
}

// Vertices of the simplex of 'x' and 'y', d + 1 rows, in the unit cube.
std::vector<std::vector<double>> simplex_vertices(const RboxCommand& c, Stream& stream) {
  std::vector<std::vector<double>> vertices;
  for (std::size_t i = 0; i <= c.dimension; ++i) {
    std::vector<double> row(c.dimension, 0.0);
    for (std::size_t k = 0; k < c.dimension; ++k) {
      if (!c.is_regular)
        row[k] = stream.coordinate();
      else if (i == c.dimension)
        row[k] = -1.0;
      else if (i == k)
        row[k] = 1.0;
    }
    vertices.push_back(std::move(row));
  }
  return vertices;
}

void draw_simplex_point(const RboxCommand& c, const std::vector<std::vector<double>>& vertices,
                        std::vector<double>& row, Stream& stream) {
  std::vector<double> weights(vertices.size());
  double sum = 0.0;
  const std::size_t apex = c.has_width ? static_cast<std::size_t>(stream.next()) % weights.size() : 0;
  for (double& weight : weights) weight = stream.unit();
  if (c.has_width) weights[apex] *= c.width;
  for (const double weight : weights) sum += weight;
  for (std::size_t k = 0; k < c.dimension; ++k) {
    row[k] = 0.0;
    for (std::size_t i = 0; i < vertices.size(); ++i) row[k] += weights[i] * vertices[i][k];
    row[k] *= c.box / sum;
  }
}

// A lens's outline in 2-d: the two ends, and between them both arcs at equal angles.
void add_lens_outline(const RboxCommand& c, Points& points) {
  const double radius = c.lens_radius * c.box;
  const double rim_angle = std::asin(1.0 / c.lens_radius);
  const double step = 2.0 * rim_angle / static_cast<double>(c.count - 1);
  double angle = rim_angle;
  points.add({c.box, 0.0});
  for (std::size_t i = 1; i < c.count; ++i) {
    angle -= step;
    const double x = radius * std::sin(angle);
    const double y = radius * (std::cos(angle) - std::cos(rim_angle));
    points.add({x, y});
    if (i + 1 < c.count) points.add({x, -y});
  }
}

// Regular points: a polygon in 2-d; poles and polygons on the sphere, or a lens, in 3-d.
void add_regular_points(const RboxCommand& c, Points& points) {
  points.first_regular = points.rows();
  const double turn = 2.0 * std::numbers::pi / static_cast<double>(c.count);
  double angle = 0.0;  // a running sum, as rbox's last digits tell
  const double axis_radius = c.axis_radius == 0.0 ? 1.0 : c.axis_radius;
  if (c.dimension == 2 && c.is_lens) {
    add_lens_outline(c, points);
  } else if (c.dimension == 2) {
    for (std::size_t i = 0; i < c.count; ++i) {
      angle += turn;
      points.add({axis_radius * c.box * std::cos(angle), axis_radius * c.box * std::sin(angle)});
    }
  } else if (c.is_lens) {
    const double inner = c.has_gap ? 1.0 - c.gap : 0.5;
    const double base = lens_base(c);
    const double height = std::sqrt(c.lens_radius * c.lens_radius - inner * inner) - base;
    for (std::size_t i = 0; i < c.count; ++i, angle += turn) {
      const double x = c.box * std::cos(angle);
      const double y = c.box * std::sin(angle);
      points.add({x, y, 0.0});
      points.add({x * inner, y * inner, c.box * height});
      points.add({x * inner, y * inner, -c.box * height});
    }
  } else {
    points.add({0.0, 0.0, -c.box});
    if (!c.has_gap) points.add({0.0, 0.0, c.box});
    for (std::size_t i = 0; i < c.count; ++i) {
      angle += turn;
      for (int ring = 0; ring < (c.has_gap ? 2 : 1); ++ring) {
        const double radius = ring == 0 ? axis_radius : axis_radius * (1.0 - c.gap);
        const double x = radius * std::cos(angle);
        const double y = radius * std::sin(angle);
        const double norm = std::sqrt(1.0 + x * x + y * y);
        points.add({x * c.box / norm, y * c.box / norm, c.box / norm});
      }
    }
  }
  points.regular_rows = points.rows() - points.first_regular;
}

void add_random_points(const RboxCommand& c, Stream& stream, Points& points) {
  std::vector<double> row(c.dimension);
  std::vector<std::vector<double>> vertices;
  if (c.is_simplex) vertices = simplex_vertices(c, stream);
  if (c.print_simplex) {
    for (std::vector<double> vertex : vertices) {
      scale(vertex, c.dimension, c.box);
      points.add(vertex);
    }
  }
  if (c.is_axis) {
    std::vector<double> pole(c.dimension, 0.0);
    pole.back() = -c.box;
    points.add(pole);
  }
  const std::size_t side = c.is_mesh ? lattice_side(c.count, c.dimension) : 0;
  for (std::size_t i = 0; i < c.count; ++i) {
    if (c.is_mesh)
      lattice_point(c, row, i, side);
    else if (c.is_simplex)
      draw_simplex_point(c, vertices, row, stream);
    else if (c.is_lens)
      draw_lens_point(c, row, stream);
    else if (c.is_axis)
      draw_axis_point(c, row, stream);
    else
      draw_point(c, row, i, stream);
    if (!c.is_mesh && !c.is_simplex) scale(row, c.dimension, c.box);
    points.add(row);
    if (i >= c.copied_points) continue;
    for (std::size_t copy = 0; copy < c.copies; ++copy) {
      std::vector<double> near = row;
      for (double& value : near) value += c.copy_radius * stream.coordinate();
      points.add(near);
    }
  }
}

void add_cube(const RboxCommand& c, Points& points) {
  std::vector<double> row(c.dimension);
  for (std::size_t corner = 0; corner < std::size_t{1} << c.dimension; ++corner) {
    for (std::size_t k = 0; k < c.dimension; ++k) {
      row[k] = (corner >> (c.dimension - 1 - k) & 1U) != 0 ? c.cube_size : -c.cube_size;
    }
    points.add(row);
  }
}

void add_diamond(const RboxCommand& c, Points& points) {
  std::vector<double> row(c.dimension, 0.0);
  for (std::size_t k = c.dimension; k-- > 0;) {
    for (const double size : {-c.diamond_size, c.diamond_size}) {
      row[k] = size;
      points.add(row);
    }
    row[k] = 0.0;
  }
}

Points make_points(const RboxCommand& c) {
  Points points;
  points.dimension = c.dimension;
  points.values = c.explicit_points;
  Stream stream(c.seed);
  if (c.is_regular && !c.is_simplex)
    add_regular_points(c, points);
  else
    add_random_points(c, stream, points);
  if (c.has_cube) add_cube(c, points);
  if (c.has_diamond) add_diamond(c, points);
  return points;
}

// Appends a number as rbox prints it, and the value a reader gets back.
class Printer {
 public:
  explicit Printer(const RboxCommand& command) : command_(command) {}

  double print(double value, std::string& text) const {
    value += command_.offset;
    char digits[64];
    int length = 0;
    if (command_.is_integer) {
      const double whole = value > 0.0 ? std::floor(value + 0.5) : std::ceil(value - 0.5);
      if (!(std::abs(whole) <= std::numeric_limits<int>::max())) {
        throw Error(ErrorCode::kUsage,
                    "rbox: a coordinate does not fit an integer of 'z'; give a smaller 'Bn'");
      }
      length = std::snprintf(digits, sizeof digits, "%d", static_cast<int>(whole));
    } else {
      length = std::snprintf(digits, sizeof digits, "%6.16g", value);
    }
    text.append(digits, static_cast<std::size_t>(length));
    const char* first = digits;
    while (*first == ' ') ++first;
    double read = 0.0;
    std::from_chars(first, digits + length, read);
    return read;
  }

 private:
  const RboxCommand& command_;
};

}  // namespace

std::string rbox_text(std::string_view arguments) {
  const RboxCommand command = parse_rbox(arguments);
  const Points points = make_points(command);
  const Printer printer(command);
  const std::string title = command.hides_command ? "" : command.text;
  const std::string count = std::to_string(points.rows());
  std::string text;
  if (command.is_homogeneous) {
    text = title + "\nbegin\n        " + count + " " + std::to_string(command.dimension + 1) +
           (command.is_integer ? " integer\n" : " real\n");
  } else {
    text = std::to_string(command.dimension) + (title.empty() ? "" : " ") + title + "\n" + count + "\n";
  }
  for (std::size_t row = 0; row < points.rows(); ++row) {
    const bool is_regular = row - points.first_regular < points.regular_rows;
    if (command.is_homogeneous) {
      printer.print(1.0, text);
      text += ' ';
    }
    for (std::size_t k = 0; k < points.dimension; ++k) {
      if (k > 0) text += ' ';
      printer.print(points.values[row * points.dimension + k], text);
    }
    text += is_regular ? "\n" : " \n";
  }
  if (command.is_homogeneous) text += "end\nhull\n";
  return text;
}

PointSet rbox(std::string_view arguments) {
  const RboxCommand command = parse_rbox(arguments);
  const Printer printer(command);
  Points points = make_points(command);
  std::string digits;
  for (double& value : points.values) {
    digits.clear();
    value = printer.print(value, digits);
  }
  return {command.dimension, std::move(points.values), command.hides_command ? "" : command.text};
}

}  // namespace ndhull
