# The program.
find_path(CLI11_INCLUDE_DIR CLI/CLI.hpp REQUIRED)  # the Debian package has no usable CMake file of its own
add_executable(leapmap-program
  src/cli/audit_lines.cpp
  src/cli/boundaries.cpp
  src/cli/check.cpp
  src/cli/command_line.cpp
  src/cli/design.cpp
  src/cli/export.cpp
  src/cli/shown_units.cpp
  src/cli/fit.cpp
  src/cli/fit_report.cpp
  src/cli/gait.cpp
  src/cli/hop.cpp
  src/cli/hop_gradient.cpp
  src/cli/hop_jump.cpp
  src/cli/hop_scatter.cpp
  src/cli/info.cpp
  src/cli/info_place.cpp
  src/cli/join.cpp
  src/cli/json.cpp
  src/cli/late.cpp
  src/cli/main.cpp
  src/cli/motor.cpp
  src/cli/out_of_memory.cpp
  src/cli/output.cpp
  src/cli/precision.cpp
  src/cli/progress.cpp
  src/cli/proof_lines.cpp
  src/cli/quick_first.cpp
  src/cli/prove.cpp
  src/cli/spec_flags.cpp
  src/cli/spoken.cpp
  src/cli/stability.cpp
  src/cli/sweep.cpp
  src/cli/sweep_plan.cpp
  src/cli/sweep_retry.cpp)
set_target_properties(leapmap-program PROPERTIES OUTPUT_NAME leapmap)
target_include_directories(leapmap-program SYSTEM PRIVATE ${CLI11_INCLUDE_DIR})
set_target_properties(leapmap-program PROPERTIES LEAPMAP_STATIC_HDF5 ${LEAPMAP_STATIC_HDF5})
# Of GSL an archive, where it is there: what is not called stays away, and the program starts sooner. It
# stands before the shared library, which the linker then finds that nothing needs.
set(gsl_archives "")
if(LEAPMAP_STATIC_HDF5)
  get_filename_component(directory "${GSL_LIBRARY}" DIRECTORY)
  find_library(GSL_ARCHIVE libgsl.a HINTS ${directory} NO_DEFAULT_PATH)
  find_library(GSL_CBLAS_ARCHIVE libgslcblas.a HINTS ${directory} NO_DEFAULT_PATH)
  if(GSL_ARCHIVE AND GSL_CBLAS_ARCHIVE)
    set(gsl_archives ${GSL_ARCHIVE} ${GSL_CBLAS_ARCHIVE})
  endif()
endif()
target_link_libraries(leapmap-program PRIVATE leapmap ${gsl_archives} leapmap-options
  nlohmann_json::nlohmann_json ${CMAKE_DL_LIBS})
target_compile_options(leapmap-program PRIVATE $<$<CONFIG:Release>:-O1>)
target_precompile_headers(leapmap-program PRIVATE <algorithm> <cmath> <filesystem> <functional> <map> <memory>
  <numeric> <optional>
                                                  <span> <string> <vector> <fmt/format.h>)
# Arb and libzip come with a module, which is loaded when it is first needed.
set_source_files_properties(src/cli/late.cpp src/cli/late_module.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
  COMPILE_DEFINITIONS  # a commit compiles two files again
  "LEAPMAP_MODULE_FOLDER=\"${CMAKE_INSTALL_LIBDIR}/leapmap\";LEAPMAP_GIT_REVISION=\"${revision}\"")
target_link_options(leapmap-program PRIVATE -Wl,--as-needed)
if(LEAPMAP_SOURCES MATCHES "src/film/")  # not for some tests alone
  add_library(leapmap-late MODULE src/cli/late_module.cpp $<TARGET_OBJECTS:leapmap-late-objects>)
  set_target_properties(leapmap-late PROPERTIES PREFIX "")
  target_compile_definitions(leapmap-late PRIVATE $<$<BOOL:${ARB_LIBRARY}>:LEAPMAP_HAS_ARB>)
  target_include_directories(leapmap-late PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(leapmap-late PRIVATE ${LEAPMAP_LATE_LIBRARIES} fmt::fmt leapmap-options)
  target_link_options(leapmap-late PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/late.map)
  if(NOT LEAPMAP_SANITIZE)  # whose symbols are the program's
    target_link_options(leapmap-late PRIVATE -Wl,--no-undefined)
  endif()
  add_dependencies(leapmap-program leapmap-late)
  install(TARGETS leapmap-late DESTINATION ${CMAKE_INSTALL_LIBDIR}/leapmap)
endif()
