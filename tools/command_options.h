// What the commands' options have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace ndhull {

/// A number above 0; the help does not repeat what the option's line says.
inline CLI::Validator positive() {
  CLI::Validator validator = CLI::PositiveNumber;
  return validator.description("");
}

/// Threads that --threads takes: more than any machine has, fewer than would exhaust one.
inline CLI::Validator thread_count() {
  constexpr unsigned kMost = 1024;
  CLI::Validator validator = CLI::Range(0U, kMost);
  return validator.description("");
}

/// The example at the end of a command's help.
inline std::string example(const std::string& text) { return "Example: " + text; }

}  // namespace ndhull
