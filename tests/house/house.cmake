# Checks of the house itself, label build: each is a script that prints findings and exits 0, 1 or 77 (cannot be
# checked here).

function(house_test name)
  add_test(NAME House.${name} COMMAND bash ${ARGN})
  set_tests_properties(House.${name} PROPERTIES LABELS build SKIP_RETURN_CODE 77 TIMEOUT 120
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()

# Those that take minutes have both cores for themselves.
function(slow_house_test name)
  house_test(${name} ${ARGN})
  set_tests_properties(House.${name} PROPERTIES LABELS "slow build" TIMEOUT 1800 RUN_SERIAL ON)
endfunction()

set(here ${CMAKE_CURRENT_SOURCE_DIR}/house)
# Builds that checks make for themselves.
set(other_builds ${CMAKE_BINARY_DIR}/other_builds)

foreach(check doors includes libm names files links format)
  house_test(${check} ${here}/house_checks.sh ${check} ${CMAKE_SOURCE_DIR})
endforeach()
house_test(checks_find_violations ${here}/house_checks.sh self-test)

# Kernels of wide instruction sets export nothing weak.
get_property(objects GLOBAL PROPERTY OBSCURA_KERNEL_OBJECTS)
list(JOIN objects "\n" objects)
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/kernel_objects.txt CONTENT "$<JOIN:${objects},\n>\n")
house_test(kernel_symbols ${here}/kernel_symbols.sh ${CMAKE_BINARY_DIR}/kernel_objects.txt)
house_test(kernel_symbols_find_violations ${here}/kernel_symbols.sh self-test ${CMAKE_CXX_COMPILER})

# Rooms include only what lies below them.
get_property(rooms GLOBAL PROPERTY OBSCURA_ROOMS)
set(walls "")
foreach(room ${rooms})
  obscura_libraries(library ${room})
  string(APPEND walls "${room}|$<TARGET_PROPERTY:${library},INTERFACE_INCLUDE_DIRECTORIES>\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/rooms.txt CONTENT "${walls}")
house_test(room_walls ${here}/room_walls.sh ${CMAKE_CXX_COMPILER} ${CMAKE_BINARY_DIR}/rooms.txt ${CMAKE_SOURCE_DIR})
house_test(room_walls_find_violations ${here}/room_walls.sh self-test ${CMAKE_CXX_COMPILER})

# The lists of slow and of sanitized tests name tests.
get_property(programs GLOBAL PROPERTY OBSCURA_TEST_PROGRAMS)
set(paths "")
foreach(program ${programs})
  string(APPEND paths "$<TARGET_FILE:${program}>\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/test_programs.txt CONTENT "${paths}")
house_test(slow_names ${here}/slow_names.sh ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/test_programs.txt
  ${CMAKE_CTEST_COMMAND} ${CMAKE_BINARY_DIR})

# The launcher, and what cmake --install leaves behind.
house_test(launcher ${here}/launcher_test.sh ${CMAKE_SOURCE_DIR})
house_test(install ${here}/install_test.sh ${CMAKE_COMMAND} ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})

# A clang++ build renders the same bytes.
slow_house_test(other_builds ${here}/determinism_builds.sh ${CMAKE_BINARY_DIR} ${other_builds})

# No report from the address and undefined-behaviour sanitizers; and Debug has the golden pictures.
slow_house_test(sanitizers ${here}/sanitizers.sh ${CMAKE_SOURCE_DIR} ${other_builds}/sanitizers
  ${CMAKE_BINARY_DIR})
house_test(sanitizers_find_violations ${here}/sanitizers.sh ${CMAKE_SOURCE_DIR} ${other_builds}/sanitizers self-test)

# Clang-tidy's rules hold where something changed. And every file names the headers it needs, whatever the precompiled
# ones bring. The number is the seconds after which files are left out, those that have not changed lately first.
set(plain ${other_builds}/plain)
slow_house_test(tidy ${here}/file_by_file.sh tidy ${plain} ${CMAKE_SOURCE_DIR} 120)
slow_house_test(includes_stand_alone ${here}/file_by_file.sh includes ${plain} ${CMAKE_SOURCE_DIR} 60)
set_tests_properties(House.includes_stand_alone PROPERTIES DEPENDS House.tidy)
house_test(file_by_file_finds_violations ${here}/file_by_file.sh self-test ${CMAKE_CXX_COMPILER})
