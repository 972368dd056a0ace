# etendue_room(<name> SOURCES ... [DEPENDS room...] [PUBLIC target...] [PRIVATE target...])
#
# One static library per folder of src/. DEPENDS lists other rooms and is the architecture table of src/README.md in
# executable form: a room that is not listed cannot be linked, and tools/check_includes.py checks headers against the same
# table. Third-party targets go to PRIVATE unless the room's headers include them.
function(etendue_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  add_library(etendue_${name} STATIC ${ARG_SOURCES})
  target_include_directories(etendue_${name} PUBLIC "${PROJECT_SOURCE_DIR}/src")
  list(TRANSFORM ARG_DEPENDS PREPEND etendue_)
  target_link_libraries(etendue_${name} PUBLIC ${ARG_DEPENDS} ${ARG_PUBLIC} PRIVATE etendue_options ${ARG_PRIVATE})
  target_precompile_headers(etendue_${name} REUSE_FROM etendue_headers)
endfunction()

# etendue_test(<room> SOURCES ... [LINK target...] [QUICKLY])
#
# One test program per room, tests/<room>/, registered with CTest case by case. QUICKLY: with sanitizers it is not
# optimised. For tests that do little themselves: what is inline in the headers of a room comes from them, too.
function(etendue_test room)
  cmake_parse_arguments(ARG "QUICKLY" "" "SOURCES;LINK" ${ARGN})
  add_executable(test_${room} ${ARG_SOURCES})
  target_include_directories(test_${room} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_include_directories(test_${room} SYSTEM PRIVATE "${ETENDUE_BOOST_MATH}")
  target_link_libraries(test_${room} PRIVATE etendue_options ${ARG_LINK} GTest::gtest_main)
  add_dependencies(unit_tests test_${room})
  if(ARG_QUICKLY AND ETENDUE_SANITIZERS)
    target_compile_options(test_${room} PRIVATE -O0)
    target_precompile_headers(test_${room} REUSE_FROM etendue_quick_test_headers)
  else()
    target_precompile_headers(test_${room} REUSE_FROM etendue_test_headers)
  endif()
  target_compile_definitions(test_${room} PRIVATE
    ETENDUE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ETENDUE_SHARED_ASSETS="${PROJECT_SOURCE_DIR}/../shared/assets")
  gtest_discover_tests(test_${room} TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 120 PROPERTIES LABELS ${room} TIMEOUT 600
    ENVIRONMENT "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/lsan-suppressions.txt"
    ENVIRONMENT_MODIFICATION "ETENDUE_TEST_OUTPUT=set:${PROJECT_BINARY_DIR}/test-output")
endfunction()
