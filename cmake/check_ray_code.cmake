# cmake -D OBJECT=... -D ENTRY=... -D NM=... -D READELF=... -P check_ray_code.cmake
#
# Fails, and removes OBJECT, if others than ENTRY can see anything of it, or if anything of it would run before main(), on
# whatever processor.
function(fail)
  file(REMOVE "${OBJECT}")
  message(FATAL_ERROR ${ARGN})
endfunction()

execute_process(COMMAND "${NM}" --extern-only --defined-only --format=just-symbols "${OBJECT}"
                OUTPUT_VARIABLE symbols OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols STREQUAL ENTRY)
  fail("${OBJECT} shows other names than ${ENTRY}, which code for older processors could be given:\n${symbols}")
endif()
execute_process(COMMAND "${READELF}" --section-headers --wide "${OBJECT}"
                OUTPUT_VARIABLE sections COMMAND_ERROR_IS_FATAL ANY)
if(sections MATCHES "[.](preinit_array|init_array|ctors|init|ifunc)[. ]")
  fail("${OBJECT} has a section ${CMAKE_MATCH_0}: a variable of a room that works per ray is set before main(), "
       "which an older processor may not survive. Make it constexpr, or local to a function.")
endif()
execute_process(COMMAND "${NM}" "${OBJECT}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(symbols MATCHES "\n[0-9a-f]+ [iu] ")
  fail("${OBJECT} has indirect or unique symbols, which are not its own alone.")
endif()
