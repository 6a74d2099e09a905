// `ndhull-bench halfspaces`. Whole processes of both programs, started, reading the same file and writing all
// vertices as text (Fp) to a file.
#include "bench/halfspaces.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "bench/child_process.h"
#include "bench/commands.h"
#include "bench/machine.h"
#include "core/error.h"
#include "core/portable_random.h"
#include "tools/io/text_source.h"

namespace ndhull {
namespace {

constexpr const char* kHalfspacesCommand = "halfspaces";

/// Halfspaces n.x <= b about the origin, n uniform on the sphere.
struct HalfspaceFamily {
  std::size_t count, dimension;
  double furthest;  ///< b is uniform from 1 to this: with 1 none is redundant

  std::string name() const {
    return furthest > 1.0 ? fmt::format("{} in {}-d, distance 1 to {}", count, dimension, furthest)
                          : fmt::format("{} in {}-d, distance 1", count, dimension);
  }
};

constexpr HalfspaceFamily kFamilies[] = {
    {2000, 5, 1.0}, {1000, 6, 1.0}, {1000, 6, 1.5}, {500, 7, 1.0}, {300, 8, 1.0}, {1000, 8, 2.0},
};

/// Rows normal, offset.
PointSet halfspaces_of(const HalfspaceFamily& family) {
  PortableRandom random(1);
  const std::size_t columns = family.dimension + 1;
  PointSet rows{columns, std::vector<double>(family.count * columns), {}};
  for (std::size_t index = 0; index < family.count; ++index) {
    const std::span<double> row = rows.row(index);
    double squares = 0.0;
    for (std::size_t column = 0; column < family.dimension; ++column) {
      row[column] = random.normal();
      squares += row[column] * row[column];
    }
    for (double& coordinate : row) coordinate /= std::sqrt(squares);
    row.back() = -(1.0 + (family.furthest - 1.0) * random.unit());
  }
  return rows;
}

/// A folder that goes with this object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "ndhull-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + " cannot be made");
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// What qhalf reads, and ndhull intersect too: a point inside, then the halfspaces.
void write_halfspaces(const PointSet& rows, const std::string& path) {
  const std::size_t dimension = rows.dimension - 1;
  std::string text = fmt::format("{} 1\n", dimension);
  for (std::size_t column = 0; column < dimension; ++column) text += "0 ";
  text += fmt::format("\n{}\n{}\n", rows.dimension, rows.rows());
  for (std::size_t index = 0; index < rows.rows(); ++index) {
    for (const double number : rows.row(index)) text += fmt::format("{:.17g} ", number);
    text += "\n";
  }
  if (!(std::ofstream(path) << text)) throw std::runtime_error(path + " cannot be written");
}

/// Fp: dimension, number of vertices, vertices.
struct Vertices {
  std::uint64_t count = 0;
  double furthest = 0.0;  ///< [distance] from the origin
};

Vertices read_vertices(const std::string& path, std::size_t dimension) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const char* place = text.data();
  const char* const end = place + text.size();
  const auto next = [&] {
    while (place != end && (*place == ' ' || *place == '\n')) ++place;
    double value = 0.0;
    place = parse_number(place, end, value);
    if (place == nullptr) throw std::runtime_error("the program wrote no list of vertices");
    return value;
  };
  if (next() != static_cast<double>(dimension)) throw std::runtime_error("vertices of another dimension");
  Vertices vertices{.count = static_cast<std::uint64_t>(next())};
  for (std::uint64_t vertex = 0; vertex < vertices.count; ++vertex) {
    double squares = 0.0;
    for (std::size_t column = 0; column < dimension; ++column) {
      const double coordinate = next();
      squares += coordinate * coordinate;
    }
    vertices.furthest = std::max(vertices.furthest, std::sqrt(squares));
  }
  return vertices;
}

HullRun run_intersection(const BenchInput& input, const std::vector<std::string>& words, bool reads_file) {
  const ScratchFolder folder;
  const std::string halfspaces = folder.file("halfspaces.txt"), output = folder.file("vertices.txt");
  write_halfspaces(input.points, halfspaces);
  std::vector<std::string> command = words;
  if (reads_file) command.push_back(halfspaces);
  const ProgramRun program = run_program(command, halfspaces, output);
  const Vertices vertices = read_vertices(output, input.points.dimension - 1);
  HullRun run;
  run.wall_seconds = program.wall_seconds;
  run.cpu_seconds = program.cpu_seconds;
  run.peak_bytes = program.peak_bytes;
  run.vertices = vertices.count;
  run.detail = {{"furthest_vertex", vertices.furthest}};
  return run;
}

/// The seconds of both, "0.171 (0.17 .. 0.18)".
std::vector<std::string> cells_of(const Repeats& repeats) {
  if (repeats.is_empty()) return {"-", "-", repeats.failure.empty() ? "-" : repeats.failure, "-"};
  return {grouped_number(repeats.last().vertices),
          short_number(repeats.last().detail.at("furthest_vertex").get<double>()),
          seconds_with_spread(repeats),
          fmt::format("{:.0f}", static_cast<double>(repeats.peak_bytes()) / (1024.0 * 1024.0))};
}

void run_halfspaces(const HalfspacesOptions& options) {
  const std::vector<RunRecord> records = measure_with(halfspaces_plan(options), options.measuring);
  fmt::print("{}\n{}", machine_line(describe_machine()), halfspaces_table(records).as_text());
  throw_if_ndhull_failed(records);
}

}  // namespace

RunPlan halfspaces_plan(const HalfspacesOptions& options) {
  std::string ndhull = options.ndhull;
  if (ndhull.empty())
    ndhull = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "ndhull").string();
  RunPlan plan;
  for (const HalfspaceFamily& family : kFamilies) {
    if (family.name().find(options.only) == std::string::npos) continue;
    plan.inputs.push_back({.name = family.name(),
                           .points = {{"points", family.count}, {"dimension", family.dimension}},
                           .load = [family] {
                             return BenchInput{halfspaces_of(family), {}};
                           }});
    PlannedRun run{.input = plan.inputs.size() - 1,
                   .command = kHalfspacesCommand,
                   .task = kHalfspacesCommand,
                   .engine = "ndhull",
                   .options = {.text = "intersect --threads 1", .accuracy = {}},
                   .rounds = options.rounds};
    run.work = [ndhull](const BenchInput& input) {
      return run_intersection(input, {ndhull, "intersect", "--threads", "1", "--quiet", "--format", "Fp"},
                              true);
    };
    plan.runs.push_back(run);
    run.engine = "qhull";
    run.options.text = "qhalf";
    run.work = [](const BenchInput& input) { return run_intersection(input, {"qhalf", "Fp"}, false); };
    plan.runs.push_back(std::move(run));
  }
  if (plan.runs.empty())
    throw Error(ErrorCode::kUsage, fmt::format("no set of halfspaces has \"{}\" in its name", options.only));
  return plan;
}

Table halfspaces_table(const std::vector<RunRecord>& records) {
  Table table{.title = "Intersection of halfspaces",
              .note =
                  "Halfspaces about the origin, normals uniform on the sphere. Whole processes of both, one "
                  "thread: start, reading text with a point inside, writing all vertices as text. Seconds: "
                  "median (smallest .. largest).",
              .columns = {"halfspaces", "ndhull vertices", "furthest", "seconds", "MiB", "qhalf vertices",
                          "furthest", "seconds", "MiB", "times faster", "of one round"},
              .rows = {}};
  std::vector<std::string> inputs;
  for (const RunRecord& record : records) {
    const bool is_new = std::find(inputs.begin(), inputs.end(), record.key.input) == inputs.end();
    if (record.command == kHalfspacesCommand && is_new) inputs.push_back(record.key.input);
  }
  for (const std::string& input : inputs) {
    Repeats ndhull, qhalf;
    for (const RunRecord& record : records) {
      if (record.command == kHalfspacesCommand && record.key.input == input)
        add_repeat(record, record.key.engine == "ndhull" ? ndhull : qhalf);
    }
    std::vector<std::string> row{input};
    for (const Repeats* repeats : {&ndhull, &qhalf}) {
      for (std::string& cell : cells_of(*repeats)) row.push_back(std::move(cell));
    }
    const bool has_both = !ndhull.is_empty() && !qhalf.is_empty();
    row.push_back(has_both ? short_number(qhalf.median_seconds() / ndhull.median_seconds()) : "-");
    row.push_back(ratio_spread(ndhull, qhalf));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_halfspaces_command(CLI::App& app) {
  const auto options = std::make_shared<HalfspacesOptions>();
  options->measuring.warm_ups = 0;
  CLI::App* command = app.add_subcommand(
      "halfspaces", "`ndhull intersect` and Qhull's `qhalf` on random halfspaces, whole processes in turns");
  command->add_option("--only", options->only, "only the sets whose name contains this, like \"6-d\"");
  command->add_option("--ndhull", options->ndhull, "the program; by default the one beside ndhull-bench");
  command->add_option("--rounds", options->rounds, "runs of each program on each set")
      ->check(CLI::Range(1U, 1000U))
      ->capture_default_str();
  options->measuring.add_options(*command);
  command->footer("Example: ndhull-bench halfspaces --json halfspaces.jsonl   # two minutes");
  command->callback([options] { run_halfspaces(*options); });
}

}  // namespace ndhull
