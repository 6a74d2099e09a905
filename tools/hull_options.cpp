#include "tools/hull_options.h"

#include "tools/byte_count.h"
#include "tools/command_options.h"

namespace ndhull {

void HullOptionSet::add_to(CLI::App& command) {
  command.add_option("--max-facets", options_.limits.max_facets, "limit: simplices of the growing hull")
      ->type_name("N")
      ->check(whole_number(1));
  command.add_option("--max-seconds", options_.limits.max_seconds, "limit: seconds of growth")
      ->type_name("S")
      ->check(positive_number());
  command.add_option("--max-memory", max_memory_, "limit: memory of the tables, like 4G, 512M or 65536")
      ->type_name("B");
  command.add_flag("--unit-cube", options_.unit_cube,
                   "measure offsets, widths and roundoff after scaling the input to the unit cube");
  command.add_flag("--triangulate", options_.triangulate,
                   "leave facets simplices: no coplanar ones are merged");
  command
      .add_option("--threads", options_.threads,
                  "0, the default: all cores; the result is the same for any number")
      ->type_name("N")
      ->check(whole_number(0, kMostThreads));
  command
      .add_option("--seed", options_.seed,
                  "of the shifts below roundoff that settle degenerate cases; default 1")
      ->type_name("S")
      ->check(whole_number(0));
}

HullOptions HullOptionSet::complete() const {
  HullOptions options = options_;
  if (!max_memory_.empty()) options.limits.max_memory_bytes = parse_byte_count(max_memory_, "--max-memory");
  return options;
}

}  // namespace ndhull
