# Installed as ndhull-config.cmake. The libraries are static: what they link must be found again.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(TBB)
include(${CMAKE_CURRENT_LIST_DIR}/ndhull-targets.cmake)
