#include "tools/command_line/hull_options.h"

#include <fast_float/fast_float.h>
#include <fmt/core.h>

#include <cmath>

#include "approx/option_check.h"
#include "core/error.h"
#include "tools/command_line/byte_count.h"
#include "tools/command_line/command_options.h"

namespace ndhull {
namespace {

/// "0.05" in the length unit or "5%" of the largest extent.
Length parse_length(const std::string& text, const char* option) {
  Length length;
  std::string_view number = text;
  if (!number.empty() && number.back() == '%') {
    length.is_percent = true;
    number.remove_suffix(1);
  }
  const auto [end, error] =
      fast_float::from_chars(number.data(), number.data() + number.size(), length.value);
  if (error != std::errc() || end != number.data() + number.size() || !std::isfinite(length.value) ||
      length.value <= 0.0) {
    throw Error(ErrorCode::kUsage, fmt::format("{}: found '{}', expected a positive length like 0.05, or a "
                                               "share of the largest extent like 2%",
                                               option, text));
  }
  return length;
}

}  // namespace

void HullOptionSet::add_accuracy_to(CLI::App& command) {
  const auto add_length = [&command](const char* name, std::string& text, const char* help) {
    command.add_option(name, text, help)->type_name("LENGTH")->check(some_text());
  };
  add_length("--width", width_, "target: no facet wider than this (certified), as few facets as possible");
  command
      .add_option("--facets", options_.accuracy.facets,
                  "target: at most this many facets, as narrow as possible; more than the dimension, since "
                  "fewer bound "
                  "no region")
      ->type_name("N")
      ->check(whole_number(1));
  command
      .add_option_function<std::string>(
          "--objective",
          [this](const std::string& word) {
            options_.accuracy.objective = word == "volume" ? FacetObjective::kVolume : FacetObjective::kWidth;
          },
          "what --facets makes small: the widest facet (width, default), or the volume below the outer "
          "planes "
          "(volume: planes are chosen of the exact hull's)")
      ->type_name("WHAT")
      ->check(one_of({"width", "volume"}))
      ->needs("--facets");
  command
      .add_option_function<std::string>(
          "--effort",
          [this](const std::string& word) {
            options_.accuracy.effort = word == "thorough" ? Effort::kThorough : Effort::kQuick;
          },
          "how long --width and --facets look: about as long as the exact hull takes (quick, default), or "
          "up to 35 times as long for up to half as many, or narrower, facets (thorough)")
      ->type_name("HOW")
      ->check(one_of({"quick", "thorough"}));
  add_length("--outside-width", outside_width_,
             "leave out points that are less than this outside (Qhull's Wn), to a twentieth of it");
  add_length("--centrum-radius", centrum_radius_,
             "merge facets while a centrum is less than this below its neighbour's plane (Cn)");
  command
      .add_option("--max-cosine", options_.accuracy.max_cosine,
                  "merge facets while the cosine between their normals is above this (An)")
      ->type_name("A")
      ->check(number_from_to(-1.0, 1.0));
  add_length(
      "--width-cap", width_cap_,
      "merging makes no facet wider than this; default the larger of W + 0.9 C and 6.5 C, with --max-cosine "
      "alone W + 10% of the largest extent");
}

void HullOptionSet::add_to(CLI::App& command) {
  add_accuracy_to(command);
  command.add_option("--max-facets", options_.limits.max_facets, "limit: simplices of the growing hull")
      ->type_name("N")
      ->check(whole_number(1));
  command
      .add_option("--max-seconds", options_.limits.max_seconds,
                  "limit: seconds of the whole run but --verify; growth ends in time for the rest")
      ->type_name("S")
      ->check(positive_number());
  command
      .add_option("--max-memory", max_memory_,
                  "limit: memory of the whole run, like 4G, 512M or 65536 bytes; otherwise four fifths of "
                  "what is free")
      ->type_name("B")
      ->check(some_text());
  command.add_flag("--unit-cube", options_.unit_cube,
                   "measure offsets, widths and roundoff after scaling the input to the unit cube");
  command.add_flag("--triangulate", options_.triangulate,
                   "leave facets simplices: no coplanar ones are merged");
  add_threads_option(command, options_.threads);
  add_seed_option(command, options_.seed, kOfShifts);
}

HullOptions HullOptionSet::complete() const {
  HullOptions options = options_;
  Accuracy& accuracy = options.accuracy;
  if (!width_.empty()) accuracy.width = parse_length(width_, "--width");
  if (!outside_width_.empty()) accuracy.outside_width = parse_length(outside_width_, "--outside-width");
  if (!centrum_radius_.empty()) accuracy.centrum_radius = parse_length(centrum_radius_, "--centrum-radius");
  if (!width_cap_.empty()) accuracy.width_cap = parse_length(width_cap_, "--width-cap");
  check_options(options, OptionSpelling::kProgram);
  if (!max_memory_.empty()) options.limits.max_memory_bytes = parse_byte_count(max_memory_, "--max-memory");
  return options;
}

}  // namespace ndhull
