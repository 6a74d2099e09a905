// The options that say which hull is wanted, for every command that computes one.
#pragma once

#include <string>

#include "approx/hull.h"

namespace CLI {
class App;
}

namespace ndhull {

/// HullOptions as they are written on the command line: some are text until all is parsed.
class HullOptionSet {
 public:
  /// Adds --width, --facets, --objective, --effort, --outside-width, --centrum-radius, --max-cosine,
  /// --width-cap,
  /// --max-facets,
  /// --max-seconds, --max-memory, --unit-cube, --triangulate, --threads and --seed. The set must live until
  /// the command line is parsed.
  void add_to(CLI::App& command);
  /// What they ask for. Throws Error kUsage, with the option, for text that means nothing.
  HullOptions complete() const;

 private:
  void add_accuracy_to(CLI::App& command);

  HullOptions options_;
  std::string width_, outside_width_, centrum_radius_, width_cap_;
  std::string max_memory_;
};

}  // namespace ndhull
