# etendue_discover_suites(<room> SLOW pattern...)
#
# Registers the program test_<room> with CTest suite by suite, long suites in parts of some twenty cases: case by case, to
# start a process 3,000 times took minutes. Suites have the label <room>, or <room>-slow where one of the patterns, regular
# expressions, matches the whole of their name; these start first, so that none is left to run alone. What is skipped
# stands in the files of <build folder>/test-cases.
if(CMAKE_SCRIPT_MODE_FILE)
  # Run after the program is built: PROGRAM, ROOM, SLOW, OUTPUT, TEST_OUTPUT, CASES.
  execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE ";" "\\;" listing "${listing}")
  string(REPLACE "\n" ";" lines "${listing}")
  set(cases_of_part 20)
  set(script "")
  set(suite "")
  set(cases 0)
  function(add_suite)
    if(suite STREQUAL "" OR cases EQUAL 0)
      return()
    endif()
    math(EXPR parts "(${cases} + ${cases_of_part} - 1) / ${cases_of_part}")
    set(label "${ROOM}")
    set(cost 0)
    if(NOT SLOW STREQUAL "" AND suite MATCHES "^(${SLOW})$")
      set(label "${ROOM}-slow")
      set(cost 1)
    endif()
    math(EXPR last "${parts} - 1")
    foreach(part RANGE ${last})
      set(name "${ROOM}.${suite}")
      if(parts GREATER 1)
        math(EXPR number "${part} + 1")
        string(APPEND name ".${number}of${parts}")
      endif()
      string(REPLACE "/" "-" file "${name}")
      string(APPEND script
        "add_test([==[${name}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==] --gtest_brief=1)\n"
        "set_tests_properties([==[${name}]==] PROPERTIES LABELS ${label} COST ${cost} TIMEOUT 900 ENVIRONMENT "
        "[==[ETENDUE_TEST_OUTPUT=${TEST_OUTPUT};GTEST_OUTPUT=xml:${CASES}/${file}.xml;"
        "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part}]==])\n")
    endforeach()
    set(script "${script}" PARENT_SCOPE)
  endfunction()
  foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ]+)\\.( |$)")
      set(next "${CMAKE_MATCH_1}")
      add_suite()
      set(suite "${next}")
      set(cases 0)
    elseif(line MATCHES "^  [^ ]")
      math(EXPR cases "${cases} + 1")
    endif()
  endforeach()
  add_suite()
  file(WRITE "${OUTPUT}" "${script}")
  return()
endif()

set(ETENDUE_SUITES_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")
function(etendue_discover_suites room)
  cmake_parse_arguments(ARG "" "" "SLOW" ${ARGN})
  list(JOIN ARG_SLOW "|" slow)
  set(suites "${CMAKE_CURRENT_BINARY_DIR}/test_${room}_suites.cmake")
  add_custom_command(TARGET test_${room} POST_BUILD
    COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:test_${room}>" -DROOM=${room} "-DSLOW=${slow}"
      "-DOUTPUT=${suites}" "-DTEST_OUTPUT=${PROJECT_BINARY_DIR}/test-output" "-DCASES=${PROJECT_BINARY_DIR}/test-cases"
      -P "${ETENDUE_SUITES_SCRIPT}"
    BYPRODUCTS "${suites}"
    VERBATIM)
  # A program that is not built has one test, which fails.
  file(WRITE "${suites}.include" "if(EXISTS [==[${suites}]==])\n  include([==[${suites}]==])\nelse()\n"
    "  add_test(${room}_NOT_BUILT ${room}_NOT_BUILT)\n  set_tests_properties(${room}_NOT_BUILT PROPERTIES LABELS ${room})\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${suites}.include")
endfunction()
