# The house: rooms and the arrows between them.
#
# obscura_room(NAME SOURCES... DEPS rooms... LIBS libraries...)
#   makes the static library obscura_NAME. Its headers are reached as "NAME/file.h" through a folder of
#   the build tree that holds nothing but this room, so a file can include only its own room and those its
#   room links to: the link graph is the architecture, and a wrong include does not build.
#
# add_simd_kernels(ROOM files...)
#   builds each kernel file once per instruction set, in a namespace of its own (see core/simd.h).
#   Kernels are always optimised, in Debug too: nothing of them may be left as a weak out-of-line symbol
#   that the linker could hand to code that runs on a lesser machine.

function(obscura_room name)
  cmake_parse_arguments(ARG "" "" "DEPS;LIBS" ${ARGN})
  add_library(obscura_${name} STATIC ${ARG_UNPARSED_ARGUMENTS})
  set(window ${CMAKE_BINARY_DIR}/rooms/${name})
  file(MAKE_DIRECTORY ${window})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${window}/${name} SYMBOLIC)
  target_include_directories(obscura_${name} PUBLIC ${window})
  list(TRANSFORM ARG_DEPS PREPEND obscura_)
  target_link_libraries(obscura_${name} PUBLIC obscura_flags ${ARG_DEPS} PRIVATE ${ARG_LIBS})
  set_property(GLOBAL APPEND PROPERTY OBSCURA_ROOMS ${name})
endfunction()

set(OBSCURA_ISA_FLAGS_sse2 -msse2)
set(OBSCURA_ISA_FLAGS_avx2 -mavx2 -mno-fma)
set(OBSCURA_ISA_FLAGS_avx512bw -mavx512f -mavx512cd -mavx512dq -mavx512bw -mavx512vl
    -mprefer-vector-width=512)

function(add_simd_kernels name)
  foreach(isa sse2 avx2 avx512bw)
    set(objects obscura_${name}_kernels_${isa})
    add_library(${objects} OBJECT ${ARGN})
    target_link_libraries(${objects} PRIVATE obscura_flags)
    target_include_directories(${objects} PRIVATE
      $<TARGET_PROPERTY:obscura_${name},INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${objects} PRIVATE OBSCURA_ISA=${isa} OBSCURA_ISA_${isa}=1)
    # g++ 12 takes the undefined upper halves inside its own AVX-512 headers for uninitialised reads.
    target_compile_options(${objects} PRIVATE ${OBSCURA_ISA_FLAGS_${isa}} -O3 -DNDEBUG
      $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized -Wno-maybe-uninitialized>
      -fno-exceptions -fno-rtti)
    target_sources(obscura_${name} PRIVATE $<TARGET_OBJECTS:${objects}>)
    set_property(GLOBAL APPEND PROPERTY OBSCURA_KERNEL_OBJECTS $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
