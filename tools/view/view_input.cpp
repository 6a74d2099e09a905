#include "tools/view/view_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "core/error.h"

namespace ndhull {
namespace {

std::string file_name_of(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

/// Every vertex of a facet, once.
std::vector<PointId> vertices_in(const IdRows& rows) {
  std::vector<std::uint32_t> ids = rows.values;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<PointId> vertices;
  for (const std::uint32_t id : ids) vertices.push_back(PointId{id});
  return vertices;
}

/// Input units for one unit-cube unit along a normal: the length it has there, within the points' subspace.
class CubeLength {
 public:
  CubeLength(const std::vector<double>& extents, const std::vector<double>& subspace_equations)
      : extents_(extents) {
    const std::size_t dimension = extents.size();
    if (dimension == 0) return;
    for (std::size_t row = 0; row + dimension < subspace_equations.size(); row += dimension + 1) {
      std::vector<double> across = scaled({subspace_equations.data() + row, dimension});
      const double before = norm(across);
      remove_across(across);
      const double after = norm(across);
      // Constant columns have no extent, and what is left of a dependent row is rounding.
      if (after <= 1e-9 * before || before == 0.0) continue;
      for (double& value : across) value /= after;
      across_.push_back(std::move(across));
    }
  }

  double operator()(std::span<const double> normal) const {
    if (extents_.empty()) return 1.0;
    std::vector<double> length = scaled(normal);
    remove_across(length);
    return norm(length);
  }

 private:
  static double norm(const std::vector<double>& values) {
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
  }
  std::vector<double> scaled(std::span<const double> values) const {
    std::vector<double> result(values.begin(), values.end());
    for (std::size_t k = 0; k < result.size(); ++k) result[k] *= extents_[k];
    return result;
  }
  void remove_across(std::vector<double>& values) const {
    for (const std::vector<double>& across : across_) {
      const double part = std::inner_product(values.begin(), values.end(), across.begin(), 0.0);
      for (std::size_t k = 0; k < values.size(); ++k) values[k] -= part * across[k];
    }
  }

  const std::vector<double>& extents_;
  std::vector<std::vector<double>> across_;  // orthonormal
};

/// What the report was written with. Throws what the JSON library does.
ColumnChoice columns_of_report(const nlohmann::json& report) {
  const nlohmann::json& options = report.at("options");
  const auto columns = options.find("columns");
  if (columns == options.end() || columns->is_null()) return {};
  return ColumnChoice(columns->get<std::string>());
}

PointFile read_points_of_report(const std::string& path, const ColumnChoice& columns,
                                const std::string& report_path) {
  if (path == "-") {
    throw Error(ErrorCode::kUsage,
                fmt::format("{}: found points from standard input, expected input.path to name a file; write "
                            "the report from a file, or view the points",
                            display_name(report_path)));
  }
  const std::filesystem::path beside = std::filesystem::path(report_path).parent_path() / path;
  std::error_code ignored;
  const bool is_beside = !std::filesystem::exists(path, ignored) && std::filesystem::exists(beside, ignored);
  try {
    return read_points(is_beside ? beside.string() : path, columns);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("the points of {}: {}", display_name(report_path), error.what()));
  }
}

void check_points_are_those(const nlohmann::json& input, const PointFile& points,
                            const std::string& report_path) {
  const PointView view = points.view();
  const auto rows = input.at("points").get<std::size_t>();
  const auto dimension = input.at("dimension").get<std::size_t>();
  if (view.rows == rows && view.dimension == dimension) return;
  throw Error(
      ErrorCode::kWrongCount,
      fmt::format("{}: found {} points in {}-d in {}, expected {} in {}-d; the file was changed, write "
                  "the report again",
                  display_name(report_path), view.rows, view.dimension, points.path, rows, dimension));
}

void require_length(const std::vector<double>& values, std::size_t size) {
  if (values.size() != size) throw std::length_error("a list of the wrong length");
}

/// Reads one line of the list. Throws what the JSON library and require_length do.
void append_facet(const nlohmann::json& facet, const std::vector<double>& reference,
                  const CubeLength& cube_length, std::size_t point_count, ViewedHull& viewed) {
  CentredFacets& facets = viewed.facets;
  const auto normal = facet.at("normal").get<std::vector<double>>();
  require_length(normal, facets.dimension);
  double value = facet.at("centred_offset").get<double>();
  for (std::size_t k = 0; k < normal.size(); ++k) value += normal[k] * (facets.centre[k] - reference[k]);
  const double outer = facet.at("outer_offset").get<double>();
  const double inner = facet.at("inner_offset").get<double>();
  const double scale = cube_length(normal);
  if (!(-value > 0.0) || !(outer >= 0.0) || !(inner <= 0.0)) throw std::length_error("a plane inside out");
  facets.normals.insert(facets.normals.end(), normal.begin(), normal.end());
  facets.heights.push_back(-value);
  facets.outer.push_back(outer * scale);
  facets.inner.push_back(inner * scale);
  facets.widths.push_back(outer - inner);
  facets.areas.push_back(facet.at("area").is_null() ? 0.0 : facet.at("area").get<double>());
  for (const nlohmann::json& id : facet.at("vertices")) {
    const auto vertex = id.get<std::uint32_t>();
    if (vertex >= point_count) throw std::length_error("a vertex that is no point");
    viewed.facet_vertices.values.push_back(vertex);
  }
  viewed.facet_vertices.end_row();
}

/// Without the name of the JSON library's exception, which stands in brackets before it.
[[noreturn]] void fail_report(const std::string& path, std::string_view reason) {
  const std::size_t end = reason.find("] ");
  if (reason.starts_with('[') && end != std::string_view::npos) reason.remove_prefix(end + 2);
  throw Error(ErrorCode::kBadHeader,
              fmt::format("{}: found JSON that is no report ({}), expected what `ndhull hull --report FILE "
                          "--facet-list` writes; write it again, or view the points",
                          display_name(path), reason));
}

ViewedHull read_fields(const nlohmann::json& report, const std::string& path) {
  const nlohmann::json& input = report.at("input");
  if (report.find("facet_list") == report.end()) {
    throw Error(ErrorCode::kUsage,
                fmt::format("{}: found a report without facets, expected facet_list; write it with "
                            "--facet-list, or view the points",
                            display_name(path)));
  }
  const auto points_path = input.at("path").get<std::string>();
  ViewedHull viewed;
  viewed.points = read_points_of_report(points_path, columns_of_report(report), path);
  check_points_are_those(input, viewed.points, path);
  viewed.points_name = file_name_of(points_path);
  viewed.rank = input.at("rank").get<std::size_t>();
  viewed.status = report.at("status").get<std::string>();
  CentredFacets& facets = viewed.facets;
  facets.dimension = input.at("dimension").get<std::size_t>();
  facets.centre = report.at("interior_point").get<std::vector<double>>();
  const auto reference = report.at("reference").get<std::vector<double>>();
  require_length(facets.centre, facets.dimension);
  require_length(reference, facets.dimension);
  for (const nlohmann::json& equation : report.value("subspace_equations", nlohmann::json::array())) {
    const auto normal = equation.at("normal").get<std::vector<double>>();
    require_length(normal, facets.dimension);
    facets.subspace_equations.insert(facets.subspace_equations.end(), normal.begin(), normal.end());
    facets.subspace_equations.push_back(equation.at("offset").get<double>());
  }
  if (report.at("length_unit") == "unit-cube") {
    viewed.extents = report.at("unit_cube_extents").get<std::vector<double>>();
    require_length(viewed.extents, facets.dimension);
  }
  if (report.at("facet_list").size() != report.at("facets").get<std::size_t>()) {
    throw Error(
        ErrorCode::kUsage,
        fmt::format("{}: found a selection, {} facets of {}, expected all, which a section of the hull "
                    "needs; write the report without --largest, --min-area and --most-merged, or view "
                    "the points",
                    display_name(path), report.at("facet_list").size(), report.at("facets").dump()));
  }
  const CubeLength cube_length(viewed.extents, facets.subspace_equations);
  for (const nlohmann::json& facet : report.at("facet_list")) {
    append_facet(facet, reference, cube_length, viewed.points.view().rows, viewed);
  }
  viewed.vertices = vertices_in(viewed.facet_vertices);
  return viewed;
}

}  // namespace

ViewedHull viewed_hull(const Hull& hull, PointFile points) {
  ViewedHull viewed;
  viewed.points_name = file_name_of(points.path);
  viewed.points = std::move(points);
  viewed.rank = hull.rank;
  viewed.status = to_string(hull.status);
  viewed.facets = centred_facets(hull);
  viewed.vertices = hull.vertices;
  viewed.extents = hull.unit_cube_extents();
  viewed.facet_vertices.begin.reserve(hull.facet_count() + 1);
  viewed.facet_vertices.values.reserve(hull.facet_count() * hull.rank);
  for (std::uint32_t row = 0; row < hull.facet_count(); ++row)
    viewed.facet_vertices.append(hull.vertices_of(FacetId{row}));
  return viewed;
}

bool is_report(const FileBytes& bytes, const std::string& path) {
  const std::string_view text = bytes.view();
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return extension_of(path) == "json" || (first != std::string_view::npos && text[first] == '{');
}

ViewedHull read_report(const FileBytes& bytes, const std::string& path) {
  const nlohmann::json report = nlohmann::json::parse(bytes.view(), nullptr, false);
  if (report.is_discarded() || !report.is_object()) fail_report(path, "not one JSON object");
  try {
    return read_fields(report, path);
  } catch (const nlohmann::json::exception& error) {
    fail_report(path, error.what());
  } catch (const std::length_error& error) {
    fail_report(path, error.what());
  }
}

}  // namespace ndhull
