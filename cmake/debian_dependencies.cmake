# CPack reads this before it packs. What it cannot see of dependencies: those of the module that is bytes of the program.
set(folder "${CPACK_PACKAGE_DIRECTORY}/module-dependencies")
file(WRITE "${folder}/debian/control" "Source: etendue\n\nPackage: etendue\nArchitecture: any\n")
execute_process(
  COMMAND dpkg-shlibdeps -O "${CPACK_ETENDUE_OIIO_MODULE}"
  WORKING_DIRECTORY "${folder}" OUTPUT_VARIABLE dependencies ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE
  COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^shlibs:Depends=" "" dependencies "${dependencies}")
if(NOT dependencies MATCHES "libopenimageio")
  message(FATAL_ERROR "dpkg-shlibdeps finds no OpenImageIO among what the module needs: '${dependencies}'.")
endif()
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "${dependencies}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "etendue (= ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
