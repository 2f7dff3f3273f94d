# Checks of the house itself, label build: each is a script that prints findings and exits 0, 1 or 77 (cannot be
# checked here).

function(house_test name)
  add_test(NAME House.${name} COMMAND bash ${ARGN})
  set_tests_properties(House.${name} PROPERTIES LABELS build SKIP_RETURN_CODE 77 TIMEOUT 120
    WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
endfunction()

set(here ${CMAKE_CURRENT_SOURCE_DIR})
foreach(check doors includes libm files format)
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

# The two commands, and what cmake --install leaves behind.
house_test(launcher ${here}/launcher_test.sh ${CMAKE_SOURCE_DIR})
house_test(install ${here}/install_test.sh ${CMAKE_COMMAND} ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR})

# Debug and clang++ builds render the same bytes. Minutes when nothing is cached.
house_test(other_builds ${here}/determinism_builds.sh $<TARGET_FILE:obscura>)
set_tests_properties(House.other_builds PROPERTIES TIMEOUT 1800 RUN_SERIAL ON)

# clang-tidy over core, raster, hierarchy and filters. Minutes.
house_test(tidy ${here}/tidy_check.sh ${CMAKE_BINARY_DIR})
set_tests_properties(House.tidy PROPERTIES TIMEOUT 1800)
