#include "tools/contains_command.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "approx/planes/contains.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/named_outputs.h"
#include "tools/io/file_bytes.h"
#include "tools/io/npy_header.h"
#include "tools/io/output_file.h"
#include "tools/io/planes_and_points.h"

namespace ndhull {
namespace {

struct ContainsArguments {
  std::string planes, queries;
  std::string output = "-";
  double width = 0.0;
  ColumnChoice columns;
  unsigned threads = 0;
  bool summary = false;
};

std::string_view to_string(Membership membership) {
  switch (membership) {
    case Membership::kOutside: return "outside";
    case Membership::kWithinWidth: return "within-width";
    case Membership::kInside: return "inside";
  }
  return "unknown";
}

constexpr std::uint32_t kNoPlane = std::numeric_limits<std::uint32_t>::max();

/// As it is written: -1 where there is none.
std::int64_t plane_of(const PlaneDistance& query) {
  return query.plane == kNoPlane ? -1 : std::int64_t{query.plane};
}

/// Without planes nothing is outside, however far.
std::vector<PlaneDistance> distances_of(const PointFile& queries, const HalfspaceFile& planes,
                                        unsigned threads) {
  if (planes.count > 0) {
    std::vector<PlaneDistance> distances = distances_to_planes(queries.view(), planes.rows, threads);
    for (PlaneDistance& query : distances) query.plane = planes.row_of(query.plane);
    return distances;
  }
  fmt::print(stderr, "ndhull: warning: {}: found no planes: every query is inside\n", planes.path);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return std::vector<PlaneDistance>(queries.view().rows,
                                    PlaneDistance{.distance = -kInfinity, .plane = kNoPlane});
}

/// .npy: rows distance, plane, and 1 outside, 0 within the width, -1 inside; text: one line a query, below
/// names in a table.
void write_distances(const std::string& path, const std::vector<PlaneDistance>& distances, double width) {
  OutputFile file(path);
  if (extension_of(path) == "npy") {
    file.write(make_npy_header("<f8", {distances.size(), 3}));
    for (const PlaneDistance& query : distances) {
      const double answer = 1.0 - static_cast<double>(membership_of(query.distance, width));
      const std::array<double, 3> row{query.distance, static_cast<double>(plane_of(query)), answer};
      file.write({reinterpret_cast<const char*>(row.data()), sizeof(row)});
    }
  } else {
    const char table = table_separator(extension_of(path)), between = table != '\0' ? table : ' ';
    if (table != '\0') file.print("distance{0}plane{0}answer\n", between);
    for (const PlaneDistance& query : distances) {
      file.print("{1}{0}{2}{0}{3}\n", between, query.distance, plane_of(query),
                 to_string(membership_of(query.distance, width)));
    }
  }
  file.commit();
}

void write_summary(const std::vector<PlaneDistance>& distances, double width) {
  std::array<std::size_t, 3> counts{};
  std::size_t furthest = 0;
  for (std::size_t query = 0; query < distances.size(); ++query) {
    ++counts[static_cast<std::size_t>(membership_of(distances[query].distance, width))];
    if (distances[query].distance > distances[furthest].distance) furthest = query;
  }
  OutputFile out("-");
  out.print("queries {}: outside {}, within the width {}, inside {}\n", distances.size(), counts[0],
            counts[1], counts[2]);
  out.print("furthest: query {} plane {} distance {}\n", furthest, plane_of(distances[furthest]),
            distances[furthest].distance);
  out.commit();
}

void run_contains(const ContainsArguments& arguments) {
  const auto [planes, queries] = read_planes_and_points(
      arguments.planes, arguments.queries, arguments.columns, {.command = "contains", .points = "queries"});
  check_outputs_are_writable({{"--output", arguments.output, OutputKind::kNumbers}},
                             {arguments.planes, arguments.queries});
  const std::vector<PlaneDistance> distances = distances_of(queries, planes, arguments.threads);
  if (arguments.summary) {
    write_summary(distances, arguments.width);
  } else {
    write_distances(arguments.output, distances, arguments.width);
  }
}

}  // namespace

void add_contains_command(CLI::App& app) {
  const auto arguments = std::make_shared<ContainsArguments>();
  CLI::App* const command = app.add_subcommand(
      "contains",
      "Signed distances of points from outer planes: positive is outside, and which plane says so.");
  add_path_argument(*command, "PLANES", arguments->planes,
                    "halfspaces a.x + b <= 0: a file, or - for standard input")
      ->required();
  add_path_argument(*command, "QUERIES", arguments->queries, "points: a file, or -")->required();
  CLI::Option* const output = add_file_option(
      *command, "-o,--output", arguments->output,
      "where to; default standard output: a line \"distance plane answer\" for each query, in "
      ".csv and .tsv below these names; .npy: rows distance, plane, answer (1 outside, 0 within the "
      "width, -1 inside)");
  command
      ->add_option(
          "--width", arguments->width,
          "in the units of the queries, of the hull's widest facet (max_facet_width in its report, but for "
          "--unit-cube): less far below an outer plane the answer is \"within-width\"; default 0")
      ->type_name("W")
      ->check(number_from_0());
  add_columns_option(*command, arguments->columns);
  command->add_flag("--summary", arguments->summary, "print counts and the furthest query only")
      ->excludes(output);
  add_threads_option(*command, arguments->threads);
  command->footer(
      "Planes count from 0 in the order of their file. Signs are exact: a query on a plane is not "
      "outside. Without planes, as of an empty selection, every query is inside: distance -inf, plane -1.\n" +
      example(
          "ndhull hull points.npy --planes outer.npy && ndhull contains outer.npy new.npy -o answers.npy"));
  command->callback([arguments] { run_contains(*arguments); });
}

}  // namespace ndhull
