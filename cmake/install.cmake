# find_package(ndhull) gives ndhull::ndhull. Headers keep their folders under include/ndhull/, so that their own
# includes ("core/points.h") mean the same at home and installed. tests/consumer uses exactly this.
include(CMakePackageConfigHelpers)

set_target_properties(ndhull_core PROPERTIES EXPORT_NAME core)
set_target_properties(ndhull_approx PROPERTIES EXPORT_NAME ndhull)
install(
  TARGETS ndhull_core ndhull_approx
  EXPORT ndhull-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ndhull)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ndhull DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET ndhull)
  install(TARGETS ndhull RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET ndhull_mpi)
  install(TARGETS ndhull_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/ndhull)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/ndhull)
install(EXPORT ndhull-targets NAMESPACE ndhull:: DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ndhull-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/ndhull-config.cmake ${PROJECT_BINARY_DIR}/ndhull-config-version.cmake
        DESTINATION ${package_dir})
