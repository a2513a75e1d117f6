# leapmap design by pagmo and NLopt. Debian's libpagmo-dev is large, and optional: without them the search
# does without.
#
# Debian's shared pagmo takes longer to load than the program takes for ten hops: where HDF5 is linked
# statically, so is pagmo, of which little more than two algorithms is called.
find_package(pagmo CONFIG QUIET)
find_package(NLopt CONFIG QUIET)
if(pagmo_FOUND AND NLopt_FOUND)
  set(LEAPMAP_ENGINES ON)
  target_sources(leapmap PRIVATE src/design/engines_pagmo.cpp src/design/descend_nlopt.cpp)
  target_include_directories(leapmap SYSTEM PRIVATE
    $<TARGET_PROPERTY:Pagmo::pagmo,INTERFACE_INCLUDE_DIRECTORIES>)
  # Matrices pass between pagmo's code and ours: whoever frees them has to see Eigen's allocator as Debian's
  # build did, whatever -march or a sanitizer make of it.
  target_compile_definitions(leapmap PRIVATE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MALLOC_ALREADY_ALIGNED=1)
  find_library(PAGMO_STATIC_LIBRARY libpagmo.a)
  find_library(BOOST_SERIALIZATION_STATIC_LIBRARY libboost_serialization.a)
  set(shared_engines Pagmo::pagmo)
  if(PAGMO_STATIC_LIBRARY AND BOOST_SERIALIZATION_STATIC_LIBRARY)
    set(static_engines "${PAGMO_STATIC_LIBRARY};${BOOST_SERIALIZATION_STATIC_LIBRARY};TBB::tbb")
    find_package(TBB CONFIG REQUIRED)
  else()
    set(static_engines Pagmo::pagmo)
  endif()
  target_link_libraries(leapmap PUBLIC
    "$<BUILD_INTERFACE:NLopt::nlopt;$<${is_static}:${static_engines}>;$<$<NOT:${is_static}>:Pagmo::pagmo>>"
                                PRIVATE "$<INSTALL_INTERFACE:NLopt::nlopt;Pagmo::pagmo>")
else()
  set(LEAPMAP_ENGINES OFF)
  message(STATUS
    "libpagmo-dev or libnlopt-cxx-dev (Debian) is not there: leapmap design searches without CMA-ES, NSGA-II \
and SLSQP")
  target_sources(leapmap PRIVATE src/design/engines_absent.cpp)
endif()
