# etendue_room(<name> SOURCES ... [DEPENDS room...] [PUBLIC target...] [PRIVATE target...] [QUICKLY] [QUICKLY_IN_TESTS])
#
# One static library per folder of src/. DEPENDS lists other rooms and is the architecture table of src/README.md in
# executable form: a room that is not listed cannot be linked, and tools/dev/check_includes.py checks headers against the same
# table. Third-party targets go to PRIVATE unless the room's headers include them. QUICKLY: it is optimised little;
# QUICKLY_IN_TESTS: only where ETENDUE_QUICK_BUILD asks for a short build.
function(etendue_room name)
  cmake_parse_arguments(ARG "QUICKLY;QUICKLY_IN_TESTS" "" "SOURCES;DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  add_library(etendue_${name} STATIC ${ARG_SOURCES})
  target_include_directories(etendue_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src")
  list(TRANSFORM ARG_DEPENDS PREPEND etendue_)
  target_link_libraries(etendue_${name} PUBLIC ${ARG_DEPENDS} ${ARG_PUBLIC} PRIVATE etendue_options ${ARG_PRIVATE})
  if(ARG_QUICKLY OR (ARG_QUICKLY_IN_TESTS AND ETENDUE_QUICK_BUILD))
    target_compile_options(etendue_${name} PRIVATE ${ETENDUE_QUICK_OPTIONS})
    target_precompile_headers(etendue_${name} REUSE_FROM etendue_quick_headers)
  else()
    target_precompile_headers(etendue_${name} REUSE_FROM etendue_headers)
  endif()
endfunction()

# etendue_of_tests(<target>...): optimises little, with the compiled headers of tests.
function(etendue_of_tests)
  foreach(target ${ARGN})
    target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
    target_link_libraries(${target} PRIVATE etendue_options GTest::gtest fmt::fmt)
    target_compile_options(${target} PRIVATE ${ETENDUE_QUICK_OPTIONS})
    target_precompile_headers(${target} REUSE_FROM etendue_test_headers)
    etendue_set_sanitizers(${target})
  endforeach()
endfunction()

# etendue_test(<room> SOURCES ... [LINK target...] [SLOW pattern...] [SANITIZED])
#
# One test program per room, tests/<room>/. SLOW: regular expressions of suites with tests of more than a second, which
# 'tools/test quick' leaves out. SANITIZED: sanitizers watch it in continuous integration, too, as it reads files;
# all others are left to the thorough tests.
function(etendue_test room)
  cmake_parse_arguments(ARG "SANITIZED" "" "SOURCES;LINK;SLOW" ${ARGN})
  add_executable(test_${room} ${ARG_SOURCES})
  etendue_of_tests(test_${room})
  target_include_directories(test_${room} SYSTEM PRIVATE "${ETENDUE_BOOST_MATH}")
  target_link_libraries(test_${room} PRIVATE ${ARG_LINK} GTest::gtest_main)
  add_dependencies(unit_tests test_${room})
  if(ARG_SANITIZED)
    add_dependencies(sanitized_tests test_${room})
    set(ARG_SANITIZED "sanitized")
  else()
    set(ARG_SANITIZED "")
  endif()
  target_compile_definitions(test_${room} PRIVATE
    ETENDUE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ETENDUE_SHARED_ASSETS="${PROJECT_SOURCE_DIR}/../shared/assets")
  if(ETENDUE_SANITIZERS)
    # Each program as a whole: case by case, start-up alone would take minutes.
    add_test(NAME ${room} COMMAND test_${room} --gtest_brief=1)
    set_tests_properties(${room} PROPERTIES LABELS "${room};${ARG_SANITIZED}" TIMEOUT 5400
      ENVIRONMENT "ETENDUE_TEST_OUTPUT=${PROJECT_BINARY_DIR}/test-output")
  else()
    etendue_discover_suites(${room} SLOW ${ARG_SLOW})
  endif()
endfunction()
