# The house: rooms and the arrows between them.
#
# obscura_room(ROOM [COLD] SOURCES... DEPS rooms... LIBS libraries... ALONE sources...)
#   makes the static library of a room: obscura_core of core, obscura_app_scene of app/scene. Its headers are
#   reached as "ROOM/file.h" through a folder of the build tree that holds nothing but this room, so a file can
#   include only its own room and those its room links to: the link graph is the architecture, and a wrong include
#   does not build. A room inside another's folder has walls too: neither reaches the other without an arrow.
#   Files are compiled in batches, since most of a file's time goes into the headers that all of them include.
#   ALONE: files that may not share a batch: two unnamed namespaces of the room use one name, or the file brings
#   a library's whole implementation. A name that is forgotten here does not compile.
#   COLD: nothing in it runs often, so a release is made with -O1, which compiles faster. Pixels are the same.
#
# add_simd_kernels(ROOM files...)
#   builds each kernel file once per instruction set, in a namespace of its own (see core/simd.h).
#   Kernels are always optimised, in Debug too: nothing of them may be left as a weak out-of-line symbol
#   that the linker could hand to code that runs on a lesser machine.

# obscura_precompile(TARGET KIND)
#   lets TARGET start from headers that are parsed once (OBSCURA_PRECOMPILE): KIND is room, program, test or the
#   instruction set of kernels. Only libraries' headers, and core/simd.h for kernels, so it opens no door in a wall;
#   a build without them (House.includes_stand_alone) keeps every file's own includes complete.

# Reading them back costs a unit 0.6 s where parsing takes 1.6; with <filesystem>, streams and <random> it would be 1 s.
set(OBSCURA_LIBRARY_HEADERS <algorithm> <array> <cmath> <cstdint> <cstring> <functional> <limits> <map> <memory>
  <optional> <string> <string_view> <utility> <vector> <fmt/format.h>)

function(obscura_precompile target kind)
  if(NOT OBSCURA_PRECOMPILE)
    return()
  endif()
  set(parsed obscura_parsed_for_${kind})
  if(NOT TARGET ${parsed})
    set(source ${CMAKE_BINARY_DIR}/parsed_for_${kind}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    # Programs and libraries differ in -fPIE and -fPIC, and each wants its own kind of parsed headers.
    if(kind STREQUAL test OR kind STREQUAL program)
      file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
      add_executable(${parsed} ${source})
    else()
      add_library(${parsed} OBJECT ${source})
    endif()
    target_link_libraries(${parsed} PRIVATE obscura_flags)
    if(kind MATCHES "^(room|program)$")
      target_link_libraries(${parsed} PRIVATE fmt::fmt)
      target_precompile_headers(${parsed} PRIVATE ${OBSCURA_LIBRARY_HEADERS})
    elseif(kind STREQUAL test)
      target_link_libraries(${parsed} PRIVATE fmt::fmt GTest::gtest)
      target_precompile_headers(${parsed} PRIVATE ${OBSCURA_LIBRARY_HEADERS} <gtest/gtest.h>)
    else()
      obscura_kernel_options(${parsed} ${kind})
      target_include_directories(${parsed} PRIVATE $<TARGET_PROPERTY:obscura_core,INTERFACE_INCLUDE_DIRECTORIES>)
      target_precompile_headers(${parsed} PRIVATE <core/simd.h>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${parsed})
endfunction()

# The libraries of rooms: app/scene -> obscura_app_scene.
function(obscura_libraries out)
  list(TRANSFORM ARGN REPLACE "/" "_" OUTPUT_VARIABLE names)
  list(TRANSFORM names PREPEND obscura_)
  set(${out} ${names} PARENT_SCOPE)
endfunction()

# The folder of the build tree that shows `room` alone: links to its headers, none to rooms inside its folder.
function(obscura_window room out)
  string(REPLACE "/" "_" name ${room})
  set(window ${CMAKE_BINARY_DIR}/rooms/${name})
  set(${out} ${window} PARENT_SCOPE)
  get_filename_component(above ${window}/${room} DIRECTORY)
  file(MAKE_DIRECTORY ${above})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${window}/${room} SYMBOLIC)
endfunction()

function(obscura_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Compiles the files of a target in batches of `size`, but for those that stay alone.
function(obscura_batches target size alone)
  if(OBSCURA_PRECOMPILE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

function(obscura_room room)
  cmake_parse_arguments(ARG "COLD" "" "DEPS;LIBS;ALONE" ${ARGN})
  obscura_libraries(library ${room})
  obscura_libraries(below ${ARG_DEPS})
  obscura_window(${room} window)
  add_library(${library} STATIC ${ARG_UNPARSED_ARGUMENTS})
  target_include_directories(${library} PUBLIC ${window})
  target_link_libraries(${library} PUBLIC obscura_flags ${below} PRIVATE ${ARG_LIBS})
  if(ARG_COLD)
    obscura_cold(${library})
  endif()
  obscura_precompile(${library} room)
  obscura_batches(${library} 6 "${ARG_ALONE}")
  set_property(GLOBAL APPEND PROPERTY OBSCURA_ROOMS ${room})
endfunction()

set(OBSCURA_ISA_FLAGS_sse2 -msse2)
set(OBSCURA_ISA_FLAGS_avx2 -mavx2 -mno-fma)
set(OBSCURA_ISA_FLAGS_avx512bw -mavx512f -mavx512cd -mavx512dq -mavx512bw -mavx512vl
    -mprefer-vector-width=512)

# g++ 12 takes the undefined upper halves inside its own AVX-512 headers for uninitialised reads.
function(obscura_kernel_options target isa)
  target_compile_definitions(${target} PRIVATE OBSCURA_ISA=${isa} OBSCURA_ISA_${isa}=1)
  if(OBSCURA_SANITIZE)
    # An address that wraps around is read or written far outside, which the address sanitizer sees. Watching every
    # sum of a pointer is half of a kernel's compile time.
    target_compile_options(${target} PRIVATE -fno-sanitize=pointer-overflow)
  else()
    target_compile_options(${target} PRIVATE -O3)
  endif()
  target_compile_options(${target} PRIVATE ${OBSCURA_ISA_FLAGS_${isa}} -DNDEBUG
    $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized -Wno-maybe-uninitialized> -fno-exceptions -fno-rtti)
  if(NOT isa STREQUAL sse2)
    set_target_properties(${target} PROPERTIES OBSCURA_UNWATCHED ON)
  endif()
endfunction()

# Of another build's kernels (OBSCURA_KERNELS_FROM) those of OBSCURA_KERNELS_TAKEN are linked.
function(add_simd_kernels room)
  obscura_libraries(library ${room})
  file(RELATIVE_PATH folder ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  foreach(isa sse2 avx2 avx512bw)
    set(objects ${library}_kernels_${isa})
    if(OBSCURA_KERNELS_FROM AND isa IN_LIST OBSCURA_KERNELS_TAKEN)
      list(TRANSFORM ARGN PREPEND ${OBSCURA_KERNELS_FROM}/${folder}/CMakeFiles/${objects}.dir/ OUTPUT_VARIABLE made)
      list(TRANSFORM made APPEND ${CMAKE_CXX_OUTPUT_EXTENSION})
      add_library(${objects} OBJECT IMPORTED GLOBAL)
      set_target_properties(${objects} PROPERTIES IMPORTED_OBJECTS "${made}")
    else()
      add_library(${objects} OBJECT ${ARGN})
      target_link_libraries(${objects} PRIVATE obscura_flags)
      target_include_directories(${objects} PRIVATE
        $<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>)
      obscura_kernel_options(${objects} ${isa})
      obscura_precompile(${objects} ${isa})
    endif()
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:${objects}>)
    set_property(GLOBAL APPEND PROPERTY OBSCURA_KERNEL_OBJECTS $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
