# Compile options of our own code, carried by one interface target that every room links.
if(ETENDUE_MARCH)
  set(march "${ETENDUE_MARCH}")
else()
  set(march x86-64-v2)
endif()
add_library(etendue_options INTERFACE)
target_compile_options(etendue_options INTERFACE
  -Wall -Wextra -Wconversion
  # Where files are compiled together, a local name may be that of a constant in another file. Clang cannot tell that from
  # the name of another local variable.
  $<IF:$<BOOL:${CMAKE_UNITY_BUILD}>,$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>,-Wshadow>
  # errno and trapping are not used; without them sqrt and comparisons inline and vectorise. Results stay IEEE.
  -fno-math-errno -fno-trapping-math
  $<$<BOOL:${ETENDUE_WARNINGS_AS_ERRORS}>:-Werror>
  # What is compiled once more for an instruction set has it as the property ETENDUE_MARCH.
  -march=$<IF:$<BOOL:$<TARGET_PROPERTY:ETENDUE_MARCH>>,$<TARGET_PROPERTY:ETENDUE_MARCH>,${march}>)
if(ETENDUE_SANITIZERS)
  # Not in the code of targets with the property ETENDUE_UNINSTRUMENTED.
  set(sanitizer_options -fsanitize=${ETENDUE_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(etendue_options INTERFACE
    "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:ETENDUE_UNINSTRUMENTED>>>:${sanitizer_options}>")
  target_link_options(etendue_options INTERFACE -fsanitize=${ETENDUE_SANITIZERS})
endif()

# Every object goes into the program and into the library of src/api, so that nothing is compiled twice. Hidden symbols
# make that free: calls and data are reached as in code of a program.
if(ETENDUE_BUILD_LIBRARY)
  target_compile_options(etendue_options INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
endif()

# For tests and for what runs once per image: compiling their many templates takes longer than optimisation ever saves.
# -Og compiles in a third less time than -O1 and as fast as -O0. After -O0, g++ 12 forgets what it was told of
# headers. With -Og, its warnings of uninitialised variables are often wrong.
if(ETENDUE_SANITIZERS OR NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(ETENDUE_QUICK_OPTIONS -Og $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()
if(ETENDUE_QUICK_BUILD AND NOT ETENDUE_SANITIZERS)
  list(APPEND ETENDUE_QUICK_OPTIONS -D_GLIBCXX_ASSERTIONS)
endif()

# etendue_compile_singly(<target>...)
#
# For code that runs once per ray: of sources that are compiled together the compiler inlines less, which costs 5 to 10%
# (docs/testing.md). Builds for tests can do without, and so can the baseline of the portable program, which only old
# processors run.
function(etendue_compile_singly)
  if(ETENDUE_MARCH AND NOT ETENDUE_QUICK_BUILD)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD OFF)
  endif()
endfunction()

# etendue_set_sanitizers(<program>): what sanitizers are to overlook goes into each program that they watch.
function(etendue_set_sanitizers program)
  get_target_property(type ${program} TYPE)
  if(ETENDUE_SANITIZERS AND type STREQUAL "EXECUTABLE")
    target_sources(${program} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/sanitizer_defaults.cpp")
  endif()
endfunction()
