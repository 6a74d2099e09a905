#include "tools/processes/process_group.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "core/error.h"

namespace ndhull {
namespace {

/// Set by the launchers of Open MPI, MPICH and Slurm.
bool was_launched() {
  constexpr std::array<const char*, 4> kVariables = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK",
                                                     "MPI_LOCALNRANKS"};
  for (const char* name : kVariables)
    if (std::getenv(name) != nullptr) return true;
  return false;
}

/// Beside the program where it was built, in the libraries' folder where it was installed.
void* load_module() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  for (const char* folder : {".", NDHULL_MODULE_FOLDER}) {
    const std::filesystem::path path = program.parent_path() / folder / "ndhull_mpi.so";
    if (!std::filesystem::exists(path, ignored)) continue;
    if (void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL); module != nullptr) return module;
    throw Error(ErrorCode::kUsage,
                fmt::format("--points-sharded: {}; install the MPI that ndhull was built with", ::dlerror()));
  }
  return nullptr;
}

}  // namespace

std::unique_ptr<ProcessGroup> join_processes() {
  if (!was_launched()) return nullptr;
  void* const module = load_module();
  if (module == nullptr) {
    throw Error(
        ErrorCode::kUsage,
        "--points-sharded: found several processes, but this build has no MPI; start it without mpirun, "
        "or build it again with libopenmpi-dev installed");
  }
  const auto join = reinterpret_cast<ProcessGroup* (*)()>(::dlsym(module, "ndhull_join_mpi"));
  NDHULL_CHECK(join != nullptr);
  return std::unique_ptr<ProcessGroup>(join());
}

}  // namespace ndhull
