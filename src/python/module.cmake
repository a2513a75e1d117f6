# The Python package leapmap: src/python/leapmap with its compiled core, the charts and the page's parts
# beside it.
set(package ${PROJECT_BINARY_DIR}/python/leapmap)
pybind11_add_module(leapmap-python MODULE NO_EXTRAS src/python/arguments.cpp src/python/design.cpp
  src/python/hoops.cpp src/python/module.cpp src/python/results.cpp)
set_target_properties(leapmap-python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${package}
                                                CXX_VISIBILITY_PRESET hidden UNITY_BUILD OFF)
target_link_libraries(leapmap-python PRIVATE leapmap leapmap-options)
target_compile_options(leapmap-python PRIVATE $<$<CONFIG:Release>:-O1>)
target_precompile_headers(leapmap-python PRIVATE <pybind11/numpy.h> <pybind11/stl.h> <fmt/format.h>)

file(GLOB modules CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src/python/leapmap
  ${PROJECT_SOURCE_DIR}/src/python/leapmap/*.py
     ${PROJECT_SOURCE_DIR}/src/python/leapmap/py.typed)
file(MAKE_DIRECTORY ${package})
foreach(module ${modules})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/python/leapmap/${module} ${package}/${module} SYMBOLIC)
endforeach()
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/analysis ${package}/analysis SYMBOLIC)

# Type stubs for editors, from the tables of parameters and fields.
list(TRANSFORM modules PREPEND ${PROJECT_SOURCE_DIR}/src/python/leapmap/ OUTPUT_VARIABLE sources)
add_custom_command(OUTPUT ${package}/__init__.pyi DEPENDS leapmap-python src/python/stubs.py ${sources}
  VERBATIM
  COMMAND ${CMAKE_COMMAND} -E env PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=${PROJECT_BINARY_DIR}/python
          ${Python_EXECUTABLE} -P ${PROJECT_SOURCE_DIR}/src/python/stubs.py ${package}/__init__.pyi
  COMMENT "Type stubs of the Python module")
add_custom_target(leapmap-stubs ALL DEPENDS ${package}/__init__.pyi)

# Found by Debian's interpreter under /usr and /usr/local; under another prefix by PYTHONPATH.
set(LEAPMAP_PYTHON_DIR lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages CACHE STRING
    "Where the Python package is installed, under the prefix")
install(TARGETS leapmap-python DESTINATION ${LEAPMAP_PYTHON_DIR}/leapmap)
install(DIRECTORY src/python/leapmap/ DESTINATION ${LEAPMAP_PYTHON_DIR}/leapmap FILES_MATCHING PATTERN "*.py"
  PATTERN py.typed
        PATTERN __pycache__ EXCLUDE)
install(FILES ${package}/__init__.pyi DESTINATION ${LEAPMAP_PYTHON_DIR}/leapmap)
install(DIRECTORY analysis/ DESTINATION ${LEAPMAP_PYTHON_DIR}/leapmap/analysis USE_SOURCE_PERMISSIONS
        PATTERN __pycache__ EXCLUDE PATTERN pictures EXCLUDE PATTERN "*.sh" EXCLUDE PATTERN rivals.py EXCLUDE
        PATTERN boost_rival.cpp EXCLUDE)
if(TARGET leapmap-page)
  foreach(file leapmap.wasm leapmap-page.js leapmap-worker.js)
    install(FILES ${PROJECT_BINARY_DIR}/${file} DESTINATION ${LEAPMAP_PYTHON_DIR}/leapmap)
  endforeach()
endif()
