# leapmap-hdf5: the HDF5 library as targets here link it, shared, or static where a target's
# LEAPMAP_STATIC_HDF5 says so.
#
# Debian's shared HDF5 can read from the web, for which it loads some thirty libraries more: twice the time
# that the program takes for one hop. Linked statically, what is not called stays away.
include(CheckCXXSourceCompiles)
get_filename_component(directory "${HDF5_C_LIBRARY_hdf5}" DIRECTORY)
find_library(HDF5_STATIC_LIBRARY libhdf5.a HINTS ${directory} NO_DEFAULT_PATH)
find_library(HDF5_STATIC_HL_LIBRARY libhdf5_hl.a HINTS ${directory} NO_DEFAULT_PATH)
set(static_hdf5 "${HDF5_STATIC_HL_LIBRARY};${HDF5_STATIC_LIBRARY};sz;z;m;${CMAKE_DL_LIBS}")
if(HDF5_STATIC_LIBRARY AND HDF5_STATIC_HL_LIBRARY)
  set(CMAKE_REQUIRED_INCLUDES ${HDF5_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_LIBRARIES ${static_hdf5})
  check_cxx_source_compiles("#include <hdf5_hl.h>
    int main() { return H5open() + H5DSis_scale(0); }" HDF5_LINKS_STATICALLY)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
option(LEAPMAP_STATIC_HDF5 "Link the program with HDF5's static library: it starts faster"
  "${HDF5_LINKS_STATICALLY}")
if(LEAPMAP_STATIC_HDF5 AND NOT HDF5_LINKS_STATICALLY)
  message(FATAL_ERROR
    "LEAPMAP_STATIC_HDF5 is ON, but libhdf5.a and libhdf5_hl.a are not there or do not link with sz, z and m \
alone; allowed: OFF, or a new build folder once they are installed")
endif()
if(NOT LEAPMAP_STATIC_HDF5)
  message(STATUS
    "libhdf5.a is not there or does not link, or LEAPMAP_STATIC_HDF5 is OFF: the program links the shared \
HDF5 and starts more slowly")
endif()

add_library(leapmap-hdf5 INTERFACE)
set(is_static "$<BOOL:$<TARGET_PROPERTY:LEAPMAP_STATIC_HDF5>>")
target_link_libraries(leapmap-hdf5 INTERFACE "$<${is_static}:${static_hdf5}>"
  "$<$<NOT:${is_static}>:hdf5::hdf5_hl;hdf5::hdf5>")
