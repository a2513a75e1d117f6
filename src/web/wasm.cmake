# The explorer's page runs the exact solver in the browser, from the same sources. Debian's emcc needs
# NODE_PATH to find its JavaScript packages, and xsimd and Boost beside, not among, this machine's headers.
find_program(LEAPMAP_EMCC emcc)
find_path(XSIMD_INCLUDE_DIR xsimd/xsimd.hpp REQUIRED)
find_path(BOOST_INCLUDE_DIR boost/math/special_functions/erf.hpp)
if(LEAPMAP_EMCC AND BOOST_INCLUDE_DIR)
  set(wasm ${PROJECT_BINARY_DIR}/wasm)
  file(MAKE_DIRECTORY ${wasm}/include)
  file(CREATE_LINK ${XSIMD_INCLUDE_DIR}/xsimd ${wasm}/include/xsimd SYMBOLIC)
  file(CREATE_LINK ${BOOST_INCLUDE_DIR}/boost ${wasm}/include/boost SYMBOLIC)
  add_executable(sobol-directions src/web/sobol_directions.cpp src/numerics/sobol_sequence.cpp)
  target_include_directories(sobol-directions PRIVATE src)
  target_link_libraries(sobol-directions PRIVATE GSL::gsl GSL::gslcblas leapmap-options)
  add_custom_command(OUTPUT ${wasm}/include/sobol_directions.hpp VERBATIM
    COMMAND sobol-directions > ${wasm}/include/sobol_directions.hpp
    COMMENT "Reading off the directions of GSL's Sobol' sequence")
  set(emcc ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${LEAPMAP_EMCC} -msimd128 -DLEAPMAP_KERNELS
    -DLEAPMAP_SCALARS)
  set(parts
    web/body web/hoop web/hoops web/made web/page web/without_gsl web/without_stop model/fields
    model/parameters model/variable friction/coulomb friction/exact_motion friction/recorded_way friction/way
    noslip/way trajectory/way friction/rolling_leg friction/sliding_leg friction/sliding_panel noslip/clock
    noslip/exact noslip/exact_motion noslip/find noslip/leg noslip/prepare noslip/rolling_motion
    noslip/rolling_time noslip/take_off leapmap/outcome gaits/settle numerics/sobol_points
    tolerance/drawn_line tolerance/made_hoops tolerance/made_sample tolerance/made_line
    tolerance/scatter_solver)
  # Of one hoop at a time: made small, as it is much of the page.
  set(derivatives
    friction/gradient gaits/error_growth gaits/known_jumps gaits/return_map noslip/dual_jump noslip/dual_time
    noslip/gradient noslip/halved_time trajectory/clearance)
  # All in four units, as most of the time goes into reading headers.
  foreach(part ${parts})
    list(FIND parts ${part} number)
    math(EXPR unit "${number} % 3")
    string(APPEND includes_${unit} "#include \"${part}.cpp\"\n")
    list(APPEND sources_${unit} src/${part}.cpp)
  endforeach()
  foreach(part ${derivatives})
    string(APPEND includes_3 "#include \"${part}.cpp\"\n")
    list(APPEND sources_3 src/${part}.cpp)
  endforeach()
  set(objects "")
  foreach(unit 0 1 2 3)
    set(object ${wasm}/unit_${unit}.o)
    file(GENERATE OUTPUT ${wasm}/unit_${unit}.cpp CONTENT "${includes_${unit}}")
    add_custom_command(OUTPUT ${object} DEPFILE ${object}.d VERBATIM COMMAND_EXPAND_LISTS
      DEPENDS ${wasm}/unit_${unit}.cpp ${sources_${unit}} ${wasm}/include/sobol_directions.hpp
      COMMAND ${emcc} $<IF:$<EQUAL:${unit},3>,-Os,-O2> -std=c++20 -msse2 -DNDEBUG -Wall -Wextra
      -Wno-bitwise-instead-of-logical -fno-slp-vectorize $<$<BOOL:${LEAPMAP_STRICT}>:-Werror>
      -I${PROJECT_SOURCE_DIR}/src -isystem ${wasm}/include
              -DEIGEN_DONT_VECTORIZE -isystem $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>
              -MD -MF ${object}.d -c ${wasm}/unit_${unit}.cpp -o ${object}
      COMMENT "Compiling to WebAssembly: unit ${unit} of 4")
    list(APPEND objects ${object})
  endforeach()
  # Of functions that several units have, the first unit's is taken. At -O3 the linker's own passes make the
  # module a little smaller still.
  add_custom_command(OUTPUT leapmap.wasm DEPENDS ${objects} VERBATIM
    COMMAND ${emcc} -O3 -sSTANDALONE_WASM -sALLOW_MEMORY_GROWTH=1 --no-entry ${objects} -o
    ${PROJECT_BINARY_DIR}/leapmap.wasm
    COMMENT "Linking leapmap.wasm")
  add_custom_target(leapmap-wasm ALL DEPENDS leapmap.wasm)
else()
  message(STATUS
    "emcc (Debian's emscripten) or Boost's headers (libboost-dev) are not there: the explorer's page cannot \
be made")
endif()
