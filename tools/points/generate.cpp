// One row after the other from one random stream, collected in blocks. A family is a function that fills a
// row; it may keep what the whole set shares (cluster centres), never earlier rows.

#include "tools/points/generate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/portable_random.h"

namespace ndhull {
namespace {

using FillRow = std::function<void(std::size_t index, std::span<double> row)>;

constexpr std::size_t kBlockCoordinates = std::size_t{1} << 17;  // 1 MiB of doubles
constexpr std::size_t kMostRowsOfProduct = std::size_t{1}
                                           << 40;  // 2^d and side^d beyond that are typing errors

constexpr std::size_t kMostCentreCoordinates = std::size_t{1} << 27;  // of clusters: 1 GiB

struct NamedFamily {
  PointFamily family;
  std::string_view name;
};
constexpr std::array kFamilies = {
    NamedFamily{PointFamily::kSphere, "sphere"},
    NamedFamily{PointFamily::kBall, "ball"},
    NamedFamily{PointFamily::kGaussian, "gaussian"},
    NamedFamily{PointFamily::kCube, "cube"},
    NamedFamily{PointFamily::kCubeSurface, "cube-surface"},
    NamedFamily{PointFamily::kCubeCorners, "cube-corners"},
    NamedFamily{PointFamily::kCrossPolytope, "cross-polytope"},
    NamedFamily{PointFamily::kSimplex, "simplex"},
    NamedFamily{PointFamily::kCyclic, "cyclic"},
    NamedFamily{PointFamily::kLattice, "lattice"},
    NamedFamily{PointFamily::kLens, "lens"},
    NamedFamily{PointFamily::kCone, "cone"},
    NamedFamily{PointFamily::kEllipsoid, "ellipsoid"},
    NamedFamily{PointFamily::kClusters, "clusters"},
};

[[noreturn]] void refuse_request(const std::string& message) {
  throw Error(ErrorCode::kUsage, "generate: " + message);
}

std::size_t power(std::size_t base, std::size_t exponent, const char* what) {
  std::size_t value = 1;
  for (std::size_t k = 0; k < exponent; ++k, value *= base) {
    if (value > kMostRowsOfProduct / base) {
      throw Error(ErrorCode::kTooManyPoints,
                  std::string("generate: ") + what + " has more than 2^40 points; lower -d");
    }
  }
  return value;
}

// Rows of the family when it is finite, 0 when it has no end.
std::size_t finite_size(const GenerateOptions& o) {
  switch (o.family) {
    case PointFamily::kCubeCorners: return o.count == 0 ? power(2, o.dimension, "cube-corners") : 0;
    case PointFamily::kCrossPolytope: return 2 * o.dimension;
    case PointFamily::kSimplex: return o.dimension + 1;
    case PointFamily::kLattice: return power(o.side, o.dimension, "lattice");
    default: return 0;
  }
}

void check_parameters(const GenerateOptions& o) {
  if (o.dimension == 0) throw Error(ErrorCode::kDimensionTooLow, "generate: dimension 0; give -d 1 or more");
  const bool is_odd = o.dimension % 2 == 1;
  if (o.family == PointFamily::kCyclic && o.curve == CyclicCurve::kTrigonometric && is_odd) {
    refuse_request("the trigonometric curve needs an even dimension, found " + std::to_string(o.dimension));
  }
  if (o.family == PointFamily::kLattice && o.side == 0) refuse_request("a lattice needs a side of 1 or more");
  if (o.family == PointFamily::kLens && !(std::isfinite(o.lens_radius) && o.lens_radius > 1.0)) {
    refuse_request("the lens radius must be above 1, found " + std::to_string(o.lens_radius));
  }
  if ((o.family == PointFamily::kLens || o.family == PointFamily::kCone) && o.dimension < 2) {
    refuse_request("lens and cone need dimension 2 or more");
  }
  if (o.family == PointFamily::kEllipsoid) {
    if (!o.axes.empty() && o.axes.size() != o.dimension) {
      refuse_request(std::to_string(o.axes.size()) + " axes for dimension " + std::to_string(o.dimension));
    }
    if (!std::all_of(o.axes.begin(), o.axes.end(), [](double axis) { return std::isfinite(axis); })) {
      refuse_request("the axes of an ellipsoid must be finite");
    }
  }
  if (o.family == PointFamily::kClusters) {
    if (o.cluster_count == 0) refuse_request("clusters needs one cluster or more");
    if (o.cluster_count > kMostCentreCoordinates / o.dimension) {
      refuse_request("found " + std::to_string(o.cluster_count) + " clusters in " +
                     std::to_string(o.dimension) + "-d, expected at most " +
                     std::to_string(kMostCentreCoordinates / o.dimension) + "; ask for fewer");
    }
    if (!(std::isfinite(o.spread) && o.spread >= 0.0))
      refuse_request("the spread of clusters must be 0 or more");
  }
}

// A uniform direction; a draw of zeros cannot be normalised and is repeated.
void fill_sphere(PortableRandom& random, std::span<double> row) {
  double norm_sq = 0.0;
  while (norm_sq == 0.0) {
    for (double& value : row) {
      value = random.normal();
      norm_sq += value * value;
    }
  }
  const double norm = std::sqrt(norm_sq);
  for (double& value : row) value /= norm;
}

// Two further coordinates of a direction, left out: what remains is uniform in the ball.
void fill_ball(PortableRandom& random, std::span<double> row) {
  double norm_sq = 0.0;
  while (norm_sq == 0.0) {
    for (double& value : row) {
      value = random.normal();
      norm_sq += value * value;
    }
    const double first = random.normal();
    const double second = random.normal();
    norm_sq += first * first + second * second;
  }
  const double norm = std::sqrt(norm_sq);
  for (double& value : row) value /= norm;
}

// Uniform in x >= 0, sum x <= 1: spacings of a Poisson process (Devroye. Non-uniform random variate
// generation. Springer, 1986, ch. V.2).
void fill_simplex(PortableRandom& random, std::span<double> row) {
  double sum = 0.0;
  while (sum == 0.0) {
    sum = random.exponential();
    for (double& value : row) {
      value = random.exponential();
      sum += value;
    }
  }
  for (double& value : row) value /= sum;
}

void fill_cyclic(const GenerateOptions& o, std::size_t index, std::size_t rows, std::span<double> row) {
  const bool is_even = o.dimension % 2 == 0;
  if (o.curve == CyclicCurve::kTrigonometric || (o.curve == CyclicCurve::kAuto && is_even)) {
    for (std::size_t k = 0; k < o.dimension / 2; ++k) {
      const CirclePoint point = portable_circle((k + 1) * index, rows);
      row[2 * k] = point.cosine;
      row[2 * k + 1] = point.sine;
    }
    return;
  }
  const double t = rows == 1 ? 0.0 : 2.0 * static_cast<double>(index) / static_cast<double>(rows - 1) - 1.0;
  double value = t;
  for (double& coordinate : row) {
    coordinate = value;
    value *= t;
  }
}

void fill_vertex_of_cross_polytope(std::size_t index, std::span<double> row) {
  std::fill(row.begin(), row.end(), 0.0);
  row[index / 2] = index % 2 == 0 ? 1.0 : -1.0;
}

void fill_vertex_of_simplex(std::size_t index, std::span<double> row) {
  std::fill(row.begin(), row.end(), 0.0);
  if (index > 0) row[index - 1] = 1.0;
}

void fill_lattice(std::size_t side, std::size_t index, std::span<double> row) {
  for (double& value : row) {
    value = static_cast<double>(index % side);
    index /= side;
  }
}

void fill_lens(PortableRandom& random, double radius, std::span<double> row) {
  const std::span<double> disk = row.first(row.size() - 1);
  fill_ball(random, disk);
  double norm_sq = 0.0;
  for (const double value : disk) norm_sq += value * value;
  // The difference of both roots, without cancellation; squares of a radius may be no doubles.
  const double rest = (1.0 - norm_sq) / radius, least = 1.0 / radius;
  const double height = rest / (std::sqrt(1.0 - norm_sq * least * least) + std::sqrt(1.0 - least * least));
  row.back() = random.coin() ? height : -height;
}

// On the cone's side the distance s from the apex has density proportional to s^(d-2): it is the largest of
// d-1 uniform numbers.
void fill_cone(PortableRandom& random, std::span<double> row) {
  const std::span<double> base = row.first(row.size() - 1);
  fill_sphere(random, base);
  double s = 0.0;
  for (std::size_t k = 0; k < base.size(); ++k) s = std::max(s, random.unit());
  for (double& value : base) value *= s;
  row.back() = 1.0 - s;
}

FillRow make_filler(const GenerateOptions& o, std::size_t rows, PortableRandom& random) {
  switch (o.family) {
    case PointFamily::kSphere: return [&](std::size_t, std::span<double> row) { fill_sphere(random, row); };
    case PointFamily::kBall: return [&](std::size_t, std::span<double> row) { fill_ball(random, row); };
    case PointFamily::kGaussian:
      return [&](std::size_t, std::span<double> row) {
        for (double& value : row) value = random.normal();
      };
    case PointFamily::kCube:
      return [&](std::size_t, std::span<double> row) {
        for (double& value : row) value = random.symmetric();
      };
    case PointFamily::kCubeSurface:
      return [&](std::size_t, std::span<double> row) {
        for (double& value : row) value = random.symmetric();
        const std::size_t face = random.below(2 * row.size());
        row[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
      };
    case PointFamily::kCubeCorners:
      return [&](std::size_t index, std::span<double> row) {
        for (std::size_t k = 0; k < row.size(); ++k) {
          const bool is_upper = o.count == 0 ? (index >> k & 1U) != 0 : random.coin();
          row[k] = is_upper ? 1.0 : -1.0;
        }
      };
    case PointFamily::kCrossPolytope:
      return [&](std::size_t index, std::span<double> row) {
        if (o.count == 0) return fill_vertex_of_cross_polytope(index, row);
        fill_simplex(random, row);
        for (double& value : row) value = random.coin() ? value : -value;
      };
    case PointFamily::kSimplex:
      return [&](std::size_t index, std::span<double> row) {
        if (o.count == 0) return fill_vertex_of_simplex(index, row);
        fill_simplex(random, row);
      };
    case PointFamily::kCyclic:
      return [&, rows](std::size_t index, std::span<double> row) { fill_cyclic(o, index, rows, row); };
    case PointFamily::kLattice:
      return [&](std::size_t index, std::span<double> row) { fill_lattice(o.side, index, row); };
    case PointFamily::kLens:
      return [&](std::size_t, std::span<double> row) { fill_lens(random, o.lens_radius, row); };
    case PointFamily::kCone: return [&](std::size_t, std::span<double> row) { fill_cone(random, row); };
    case PointFamily::kEllipsoid:
      return [&](std::size_t, std::span<double> row) {
        fill_sphere(random, row);
        for (std::size_t k = 0; k < row.size(); ++k) {
          row[k] *= o.axes.empty() ? 1.0 / static_cast<double>(k + 1) : o.axes[k];
        }
      };
    case PointFamily::kClusters: {
      std::vector<double> centres(o.cluster_count * o.dimension);
      for (double& value : centres) value = random.symmetric();
      return [&, centres = std::move(centres)](std::size_t, std::span<double> row) {
        const double* centre = centres.data() + random.below(o.cluster_count) * row.size();
        for (std::size_t k = 0; k < row.size(); ++k) row[k] = centre[k] + o.spread * random.normal();
      };
    }
  }
  NDHULL_CHECK(false);
}

void check_finite(const PointView& block, std::size_t first_row) {
  for (std::size_t row = 0; row < block.rows; ++row) {
    for (std::size_t k = 0; k < block.dimension; ++k) {
      if (std::isfinite(block.at(row, k))) continue;
      throw Error(ErrorCode::kOutOfRange, "generate: found a coordinate of point " +
                                              std::to_string(first_row + row) +
                                              " that is too large for its type, expected a finite one; give "
                                              "a smaller radius, axes or spread");
    }
  }
}

}  // namespace

std::string_view to_string(PointFamily family) {
  for (const NamedFamily& named : kFamilies) {
    if (named.family == family) return named.name;
  }
  NDHULL_CHECK(false);
}

std::span<const PointFamily> all_point_families() {
  static constexpr std::array families = [] {
    std::array<PointFamily, kFamilies.size()> list{};
    for (std::size_t k = 0; k < list.size(); ++k) list[k] = kFamilies[k].family;
    return list;
  }();
  return families;
}

PointFamily point_family(std::string_view name) {
  std::string names;
  for (const NamedFamily& named : kFamilies) {
    if (named.name == name) return named.family;
    names += (names.empty() ? "" : ", ") + std::string(named.name);
  }
  refuse_request("no family '" + std::string(name) + "'; there are " + names);
}

std::size_t row_count(const GenerateOptions& options) {
  check_parameters(options);
  const std::size_t size = finite_size(options);
  if (options.count == 0) {
    if (size == 0) refuse_request(std::string(to_string(options.family)) + " needs a number of points, -n");
    return size;
  }
  if (options.family == PointFamily::kLattice && options.count > size) {
    refuse_request("the lattice has " + std::to_string(size) + " points, asked for " +
                   std::to_string(options.count));
  }
  return options.count;
}

void generate(const GenerateOptions& options, const std::function<void(const PointView&)>& take_block) {
  const std::size_t rows = row_count(options);
  const std::size_t dimension = options.dimension;
  const std::size_t block_rows = std::min(rows, std::max<std::size_t>(1, kBlockCoordinates / dimension));
  PortableRandom random(options.seed);
  const FillRow fill_row = make_filler(options, rows, random);
  std::vector<double> block(block_rows * dimension);
  std::vector<float> rounded(options.scalar == ScalarType::kFloat32 ? block.size() : 0);
  for (std::size_t first = 0; first < rows; first += block_rows) {
    const std::size_t count = std::min(block_rows, rows - first);
    for (std::size_t k = 0; k < count; ++k) fill_row(first + k, {block.data() + k * dimension, dimension});
    PointView view = PointView::row_major(block.data(), count, dimension);
    if (!rounded.empty()) {
      std::transform(block.begin(), block.end(), rounded.begin(),
                     [](double value) { return static_cast<float>(value); });
      view = PointView::row_major(rounded.data(), count, dimension);
    }
    check_finite(view, first);
    take_block(view);
  }
}

std::string generate_command(const GenerateOptions& options) {
  std::string command = "ndhull generate " + std::string(to_string(options.family)) + " -d " +
                        std::to_string(options.dimension);
  const auto add = [&command](const char* option, const std::string& value) {
    command += std::string(" ") + option + " " + value;
  };
  // As short as reads back as the same double.
  const auto digits = [](double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
  };
  const GenerateOptions plain;
  if (options.count > 0) add("-n", std::to_string(options.count));
  add("--seed", std::to_string(options.seed));
  if (options.scalar == ScalarType::kFloat32) command += " --float32";
  switch (options.family) {
    case PointFamily::kCyclic:
      if (options.curve != plain.curve)
        add("--curve", options.curve == CyclicCurve::kMoment ? "moment" : "trigonometric");
      break;
    case PointFamily::kLattice:
      if (options.side != plain.side) add("--side", std::to_string(options.side));
      break;
    case PointFamily::kLens:
      if (options.lens_radius != plain.lens_radius) add("--lens-radius", digits(options.lens_radius));
      break;
    case PointFamily::kEllipsoid:
      if (!options.axes.empty()) command += " --axes";
      for (const double axis : options.axes) command += " " + digits(axis);
      break;
    case PointFamily::kClusters:
      if (options.cluster_count != plain.cluster_count)
        add("--clusters", std::to_string(options.cluster_count));
      if (options.spread != plain.spread) add("--spread", digits(options.spread));
      break;
    default: break;
  }
  return command;
}

PointSet generate_points(const GenerateOptions& options) {
  PointSet set;
  set.dimension = options.dimension;
  const std::size_t rows = row_count(options);
  set.coordinates.reserve(rows * options.dimension);
  generate(options, [&](const PointView& block) {
    for (std::size_t row = 0; row < block.rows; ++row) {
      for (std::size_t k = 0; k < block.dimension; ++k) set.coordinates.push_back(block.at(row, k));
    }
  });
  set.header = generate_command(options);
  return set;
}

}  // namespace ndhull
