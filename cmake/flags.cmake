# Flags every source of the project is compiled with. Link the two targets PRIVATE:
#   target_link_libraries(my_target PRIVATE ndhull_arithmetic ndhull_warnings)
# No -march=native: speed comes from run-time dispatch (Highway), one binary runs everywhere. No -ffast-math:
# the error bounds are proofs about IEEE arithmetic.

# The compiler must not fuse a*b + c on its own: the same source would round differently from machine to
# machine, and results are the same bytes everywhere. An explicit fused multiply-add stays what it is.
# Nobody reads what math functions leave in errno: without it a square root is one instruction.
add_library(ndhull_arithmetic INTERFACE)
target_compile_options(ndhull_arithmetic INTERFACE -ffp-contract=off -fno-math-errno)

add_library(ndhull_warnings INTERFACE)
target_compile_options(
  ndhull_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                            $<$<BOOL:${NDHULL_WARNINGS_AS_ERRORS}>:-Werror>)

# GCC 12 sees overlapping memcpy where std::string grows (its bug 105651, mended in 13).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(ndhull_warnings INTERFACE -Wno-restrict)
endif()

set(CMAKE_CXX_EXTENSIONS OFF)

# A plain `cmake -S . -B build` must not give an unoptimised engine.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
