# What the library and the program need; scripts/packages.txt names the Debian packages. Tests and bench find
# their own. Nothing is fetched. Imported targets are SYSTEM: their headers raise no warnings here.
# Of CGAL only the d-dimensional kernel (LGPL) is used; its GPL packages may not enter library or program.
find_package(Threads REQUIRED)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE) # dev and the sanitizers are slow on purpose
find_package(CGAL 5.5 REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(hwy 1.0 REQUIRED)
find_package(TBB 2021 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(CLI11 2 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(FastFloat 3 REQUIRED)
find_package(glm REQUIRED)

# Optional: --points-sharded on several processes. Without it the option reads all files in one.
find_package(MPI COMPONENTS CXX QUIET)
if(NOT TARGET MPI::MPI_CXX)
  message(STATUS "MPI was not found: ndhull hull --points-sharded works in one process only")
endif()

# Highway's headers without its library, which nothing calls (core/machine/simd_targets.h).
add_library(ndhull_simd INTERFACE)
target_include_directories(ndhull_simd SYSTEM INTERFACE $<TARGET_PROPERTY:hwy::hwy,INTERFACE_INCLUDE_DIRECTORIES>)
