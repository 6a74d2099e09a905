#include "tools/points/point_set_commands.h"

#include <fmt/format.h>

#include <memory>

#include "core/error.h"
#include "tools/command_line/command_options.h"
#include "tools/command_line/named_outputs.h"
#include "tools/io/file_bytes.h"
#include "tools/io/output_file.h"
#include "tools/io/point_writer.h"
#include "tools/points/rbox.h"

namespace ndhull {
namespace {

// What the readers and the engine can number: more is a slip of the finger that would fill a disk.
constexpr std::uint64_t kMostRows = std::uint64_t{1} << 40;
constexpr std::uint64_t kMostColumns = 1'000'000;

/// Families whose points are a finite set, which is taken whole unless a number is asked for.
bool is_finite_family(PointFamily family) {
  return family == PointFamily::kCubeCorners || family == PointFamily::kCrossPolytope ||
         family == PointFamily::kSimplex || family == PointFamily::kLattice;
}

struct GenerateArguments {
  GenerateOptions options;
  std::string family;
  std::string path = "-";
  std::string curve;
  bool is_float = false;
};

void add_family_parameters(CLI::App& command, GenerateArguments& arguments) {
  GenerateOptions& options = arguments.options;
  command.add_option("--curve", arguments.curve, "cyclic: moment, or trigonometric (even dimensions)")
      ->type_name("NAME")
      ->check(one_of({"auto", "moment", "trigonometric"}));
  command.add_option("--side", options.side, "lattice: points along each axis; default 3")
      ->type_name("N")
      ->check(whole_number(1));
  command
      .add_option("--lens-radius", options.lens_radius, "lens: radius of its two caps, above 1; default 10")
      ->type_name("R")
      ->check(positive_number());
  command.add_option("--axes", options.axes, "ellipsoid: d lengths; default 1 1/2 .. 1/d")
      ->type_name("A ..")
      ->check(positive_number());
  command.add_option("--clusters", options.cluster_count, "clusters: how many; default 10")
      ->type_name("N")
      ->check(whole_number(1));
  command.add_option("--spread", options.spread, "clusters: standard deviation of a cloud; default 0.01")
      ->type_name("S")
      ->check(positive_number());
}

/// A parameter that only one family has.
struct FamilyParameter {
  const char* option;
  PointFamily family;
};
constexpr FamilyParameter kFamilyParameters[] = {
    {"--curve", PointFamily::kCyclic},      {"--side", PointFamily::kLattice},
    {"--lens-radius", PointFamily::kLens},  {"--axes", PointFamily::kEllipsoid},
    {"--clusters", PointFamily::kClusters}, {"--spread", PointFamily::kClusters}};

void check_parameters_are_of(const CLI::App& command, PointFamily family) {
  for (const FamilyParameter& parameter : kFamilyParameters) {
    if (parameter.family == family || command.count(parameter.option) == 0) continue;
    throw Error(ErrorCode::kUsage,
                fmt::format("{}: found it with the family {}, expected it with {} only; leave it out",
                            parameter.option, to_string(family), to_string(parameter.family)));
  }
}

}  // namespace

void write_generated(const std::string& path, const GenerateOptions& options) {
  const PointFileHead head{.rows = row_count(options),
                           .dimension = options.dimension,
                           .scalar = options.scalar,
                           .comment = generate_command(options)};
  PointWriter writer(path, head);
  generate(options, [&writer](const PointView& block) { writer.write(block); });
  writer.commit();
}

void write_rbox(const std::string& path, const std::string& arguments) {
  const std::string extension = extension_of(path);
  if (extension == "npy" || extension == "ext" || table_separator(extension) != '\0') {
    const PointSet points = rbox(arguments);
    PointWriter writer(path, {.rows = points.rows(),
                              .dimension = points.dimension,
                              .scalar = ScalarType::kFloat64,
                              .comment = points.header});
    writer.write(points.view());
    writer.commit();
    return;
  }
  const std::string text = rbox_text(arguments);
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void add_generate_command(CLI::App& app) {
  const auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* const command =
      app.add_subcommand("generate", "Points of a known family; the same for the same options anywhere.");
  std::string names;
  for (const PointFamily family : all_point_families()) {
    names += (names.empty() ? "" : " ") + std::string(to_string(family));
  }
  GenerateOptions& options = arguments->options;
  command->add_option("FAMILY", arguments->family, "one of " + names)->type_name("")->required();
  command->add_option("-d,--dimension", options.dimension, "coordinates of a point; default 5")
      ->type_name("D")
      ->check(whole_number(1, kMostColumns));
  CLI::Option* const count =
      command
          ->add_option(
              "-n,--count", options.count,
              "points; default 1000, and for cube-corners, cross-polytope, simplex and lattice all (0)")
          ->type_name("N")
          ->check(whole_number(0, kMostRows));
  add_seed_option(*command, options.seed, "of the random numbers");
  add_family_parameters(*command, *arguments);
  add_file_option(*command, "-o,--output", arguments->path,
                  "file: .npy, .csv, .tsv, .ext or Qhull text; default - (text)");
  command->add_flag("--float32", arguments->is_float, "round coordinates to float32");
  command->footer(example("ndhull generate sphere -d 7 -n 100000 --seed 3 -o sphere7.npy"));
  command->callback([arguments, command, count] {
    GenerateOptions& wanted = arguments->options;
    wanted.family = point_family(arguments->family);
    check_parameters_are_of(*command, wanted.family);
    if (count->count() == 0 && is_finite_family(wanted.family)) wanted.count = 0;
    if (arguments->is_float) wanted.scalar = ScalarType::kFloat32;
    if (arguments->curve == "moment") wanted.curve = CyclicCurve::kMoment;
    if (arguments->curve == "trigonometric") wanted.curve = CyclicCurve::kTrigonometric;
    check_outputs_fit({{"--output", arguments->path, OutputKind::kPoints}});
    write_generated(arguments->path, wanted);
  });
}

void add_rbox_command(CLI::App& app) {
  struct Arguments {
    std::string text;
    std::string path = "-";
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = app.add_subcommand(
      "rbox", "The points of Qhull's program rbox, digit for digit, from the same arguments.");
  command->add_option("ARGUMENTS", arguments->text, "rbox's arguments as one word, in quotes")
      ->type_name("")
      ->required();
  add_file_option(*command, "-o,--output", arguments->path,
                  "file: .npy, .csv, .tsv, .ext or text; default - (text)");
  command->footer(example("ndhull rbox \"1000 s D5 t1\" | ndhull hull -"));
  command->callback([arguments] {
    check_outputs_fit({{"--output", arguments->path, OutputKind::kPoints}});
    write_rbox(arguments->path, arguments->text);
  });
}

}  // namespace ndhull
