# Compiles the kernels (src/model/kernels.hpp) once for each of LEAPMAP_INSTRUCTION_SETS and adds them to the
# library.
#
# Each set is linked into one object in which every symbol but its entry is local and no section is shared
# (COMDAT): otherwise the linker would keep any one copy of an inline function, perhaps one for a newer
# machine, or a slower one with other roundings.

# How wide the registers are. GCC copies structures in narrower parts, and a load of a whole register that
# follows waits until these have reached memory. Longer copies are calls: "rep movsq" is slow to begin.
set(register_bits_of_x86-64-v3 256)
set(register_bits_of_x86-64-v4 512)

function(leapmap_kernel_objects target march entry)
  add_library(${target} OBJECT ${LEAPMAP_KERNEL_SOURCES})
  set_target_properties(${target} PROPERTIES LEAPMAP_LANES ON)
  target_compile_definitions(${target} PRIVATE LEAPMAP_KERNELS=${entry})
  target_compile_options(${target} PRIVATE $<$<NOT:$<STREQUAL:${march},>>:-march=${march}> -fno-gnu-unique
    -fno-lto -fno-trapping-math -fno-math-errno
    # What a loop over lanes calls is worth inlining up to hundreds of instructions: a call passes its lanes
    # by memory. Loops over a panel's nodes are worth unrolling.
    "$<$<CXX_COMPILER_ID:GNU>:SHELL:-funroll-loops --param max-inline-insns-auto=400>")
  set(bits ${register_bits_of_${march}})
  if(bits AND CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
    target_compile_options(${target} PRIVATE -mmove-max=${bits} -mstore-max=${bits}
      -mmemcpy-strategy=libcall:-1:noalign)
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_include_directories(${target} SYSTEM PRIVATE
    $<TARGET_PROPERTY:GSL::gsl,INTERFACE_INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen> $<BUILD_INTERFACE:leapmap-options>)
endfunction()

include(CheckCXXSourceRuns)
# The best of some sets that this machine has, as src/model/model.cpp tells it at start; none if it has none
# of them.
set(parts_of_x86-64 sse2)
set(parts_of_x86-64-v3 avx2 fma bmi bmi2)
set(parts_of_x86-64-v4 ${parts_of_x86-64-v3} avx512f avx512bw avx512cd avx512dq avx512vl)
function(leapmap_best_set result)
  set(best "")
  foreach(set ${ARGN})
    string(MAKE_C_IDENTIFIER runs_${set} runs)
    list(TRANSFORM parts_of_${set} REPLACE "(.+)" "__builtin_cpu_supports(\"\\1\")" OUTPUT_VARIABLE parts)
    list(JOIN parts " && " all)
    check_cxx_source_runs("int main() { return ${all} ? 0 : 1; }" ${runs})
    if(${runs})
      set(best ${set})
    endif()
  endforeach()
  set(${result} "${best}" PARENT_SCOPE)
endfunction()

set(sets "${LEAPMAP_INSTRUCTION_SETS}")
if(sets STREQUAL best)
  leapmap_best_set(sets x86-64 x86-64-v3 x86-64-v4)
endif()
message(STATUS "The solvers are compiled for: ${sets}")

# What looks inside the kernels, tests and benchmarks, is compiled as they are.
add_library(leapmap-inside INTERFACE)
set(march "")
set(list "")
if(LEAPMAP_SANITIZE OR NOT sets)  # sanitizers ask for symbols of their own
  list(POP_BACK sets march)
  leapmap_kernel_objects(leapmap-kernels "${march}" leapmap_kernels)
  target_sources(leapmap PRIVATE $<TARGET_OBJECTS:leapmap-kernels>)
  set(list "KERNELS(leapmap_kernels, \"$<IF:$<STREQUAL:${march},>,baseline,${march}>\")\n")
else()
  foreach(set ${sets})
    string(MAKE_C_IDENTIFIER leapmap_kernels_${set} entry)
    leapmap_kernel_objects(leapmap-kernels-${set} ${set} ${entry})
    set(object ${PROJECT_BINARY_DIR}/kernels-${set}.o)
    set(objects $<TARGET_OBJECTS:leapmap-kernels-${set}>)
    add_custom_command(OUTPUT ${object} DEPENDS ${objects} VERBATIM COMMAND_EXPAND_LISTS
      COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${object} ${objects}
      COMMAND ${CMAKE_OBJCOPY} --keep-global-symbol=${entry} ${object}
      COMMENT "The kernels for ${set} as one object")
    target_sources(leapmap PRIVATE ${object})
    set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT TRUE GENERATED TRUE)
    string(APPEND list "KERNELS(${entry}, \"${set}\")\n")
  endforeach()
  leapmap_best_set(march ${sets})  # tests and benchmarks see every symbol of it
  if(NOT march)
    list(GET sets 0 march)
  endif()
  target_sources(leapmap-inside INTERFACE $<TARGET_OBJECTS:leapmap-kernels-${march}>)
endif()
target_compile_options(leapmap-inside INTERFACE $<$<NOT:$<STREQUAL:${march},>>:-march=${march}>)
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/generated/kernel_list.inc CONTENT "${list}")
target_include_directories(leapmap PRIVATE ${PROJECT_BINARY_DIR}/generated)
