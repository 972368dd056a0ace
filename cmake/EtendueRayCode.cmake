# What works per ray, compiled once more for an instruction set, as one object of which nothing but the way in can be seen:
# inline functions and templates are compiled in many sources, and of those that carry one name the linker takes any. With
# all names local, code for newer processors is reached in no other way than by the one that was chosen at start.

# Beside the baseline, x86-64-v2, whose name is sse4.
set(ETENDUE_INSTRUCTION_SETS avx2 avx512)
set(ETENDUE_MARCH_avx2 x86-64-v3)
set(ETENDUE_MARCH_avx512 x86-64-v4)

# etendue_ray_code(<set> OBJECT_TO <variable> ROOMS room... [EXCEPT source...] ENTRY <source>)
#
# Compiles all sources of ROOMS but EXCEPT, and ENTRY, for an instruction set. OBJECT_TO is set to the object file that holds them; it
# needs the other rooms that ROOMS depend on. Of what it defines only etendue::ray_code_here is visible, as
# etendue::<set>_ray_code.
function(etendue_ray_code set)
  cmake_parse_arguments(ARG "" "OBJECT_TO;ENTRY" "ROOMS;EXCEPT" ${ARGN})
  set(copy etendue_ray_code_${set})
  add_library(${copy} OBJECT "${ARG_ENTRY}")
  foreach(room IN LISTS ARG_ROOMS)
    get_target_property(sources etendue_${room} SOURCES)
    list(REMOVE_ITEM sources ${ARG_EXCEPT})
    get_target_property(source_dir etendue_${room} SOURCE_DIR)
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${source_dir}")
      target_sources(${copy} PRIVATE "${source}")
    endforeach()
    get_target_property(libraries etendue_${room} LINK_LIBRARIES)
    get_target_property(directories etendue_${room} INCLUDE_DIRECTORIES)
    target_link_libraries(${copy} PRIVATE ${libraries})
    target_include_directories(${copy} PRIVATE ${directories})
    add_dependencies(${copy} etendue_${room})  # which makes the sources that are generated
  endforeach()
  # Unique symbols, which GCC makes of static variables of inline functions, cannot be made local.
  target_compile_options(${copy} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  # Before version 13 of GCC's library every source that includes <iostream>, as Imath's headers do, sets up the standard
  # streams before main(). This is the guard of that header, which none of these sources needs.
  target_compile_definitions(${copy} PRIVATE _GLIBCXX_IOSTREAM)
  target_precompile_headers(${copy} PRIVATE ${headers_of_all})
  set_target_properties(${copy} PROPERTIES UNITY_BUILD OFF ETENDUE_MARCH ${ETENDUE_MARCH_${set}})

  set(object "${CMAKE_CURRENT_BINARY_DIR}/ray_code_${set}.o")
  set(parts "$<FILTER:$<TARGET_OBJECTS:${copy}>,INCLUDE,[.]o$>")  # without the compiled headers
  string(LENGTH "${set}_ray_code" length)
  set(entry "_ZN7etendue${length}${set}_ray_codeE")
  add_custom_command(
    OUTPUT "${object}"
    COMMAND "${CMAKE_LINKER}" -r --force-group-allocation -o "${object}.all" "${parts}"
    COMMAND "${CMAKE_OBJCOPY}" --redefine-sym _ZN7etendue13ray_code_hereE=${entry} "${object}.all"
    COMMAND "${CMAKE_OBJCOPY}" --keep-global-symbol=${entry} "${object}.all" "${object}"
    COMMAND "${CMAKE_COMMAND}" -E rm "${object}.all"
    COMMAND "${CMAKE_COMMAND}" -D "OBJECT=${object}" -D ENTRY=${entry} -D "NM=${CMAKE_NM}" -D "READELF=${CMAKE_READELF}"
            -P "${PROJECT_SOURCE_DIR}/cmake/check_ray_code.cmake"
    DEPENDS "${parts}" "${PROJECT_SOURCE_DIR}/cmake/check_ray_code.cmake"
    COMMENT "Closing the code for ${set}"
    COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties("${object}" PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(${ARG_OBJECT_TO} "${object}" PARENT_SCOPE)
endfunction()
