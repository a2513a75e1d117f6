# What needs Arb and libzip. The library holds it; the program loads it as a module when it is first needed:
# with these libraries it would take twice as long to start.
if(LEAPMAP_SOURCES MATCHES "src/film/")
  list(APPEND LEAPMAP_LATE_SOURCES src/film/unzip.cpp)
  list(APPEND LEAPMAP_LATE_LIBRARIES ${ZIP_LIBRARY})
endif()
if(LEAPMAP_LATE_SOURCES)
  add_library(leapmap-late-objects OBJECT ${LEAPMAP_LATE_SOURCES})
  set_target_properties(leapmap-late-objects PROPERTIES UNITY_BUILD OFF)  # the program replaces some of them
  target_include_directories(leapmap-late-objects PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_options(leapmap-late-objects PRIVATE $<$<CONFIG:Release>:-O2>)
  target_link_libraries(leapmap-late-objects PRIVATE fmt::fmt Eigen3::Eigen leapmap-options)
  target_sources(leapmap PRIVATE $<TARGET_OBJECTS:leapmap-late-objects>)
  target_link_libraries(leapmap PRIVATE ${LEAPMAP_LATE_LIBRARIES})
endif()
