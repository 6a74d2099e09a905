#include "bench/machine.h"

#include <fmt/format.h>

#include <fstream>
#include <thread>

#include "bench/hull_run.h"

namespace ndhull {
namespace {

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown CPU";
}

std::string compiler() {
#ifdef __clang__
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown compiler";
#endif
}

}  // namespace

nlohmann::json describe_machine() {
  return {{"cpu", cpu_model()},       {"cores", std::thread::hardware_concurrency()},
          {"compiler", compiler()},   {"build_type", NDHULL_BUILD_TYPE},
          {"ndhull", NDHULL_VERSION}, {"qhull", qhull_version()}};
}

std::string machine_line(const nlohmann::json& machine) {
  const auto text = [&](const char* key) { return machine.at(key).get<std::string>(); };
  return fmt::format("{}, {} cores; {}, {}; ndhull {}, Qhull {}", text("cpu"),
                     machine.at("cores").get<unsigned>(), text("compiler"), text("build_type"),
                     text("ndhull"), text("qhull"));
}

}  // namespace ndhull
