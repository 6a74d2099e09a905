// What a measurement was made on: without it a figure means nothing.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace ndhull {

/// Keys: cpu, cores, compiler, build_type, ndhull, qhull.
nlohmann::json describe_machine();

/// The same on one line.
std::string machine_line(const nlohmann::json& machine);

}  // namespace ndhull
