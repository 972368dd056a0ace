# What `cmake --install` puts where, in two components: `runtime`, the program with all that belongs to it and the shared
# library, and `development`, what other programs are built with.
install(TARGETS etendue COMPONENT runtime)
install(DIRECTORY "${ETENDUE_MANUAL}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT runtime)
install(DIRECTORY "${ETENDUE_MANUAL}/" DESTINATION "${CMAKE_INSTALL_DATADIR}" COMPONENT runtime
  PATTERN man EXCLUDE)
install(DIRECTORY scenes DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue" COMPONENT runtime
  PATTERN CMakeLists.txt EXCLUDE)
install(DIRECTORY addons/blender/etendue DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue/blender" COMPONENT runtime
  PATTERN __pycache__ EXCLUDE)
install(FILES "${ETENDUE_BLENDER_ZIP}" DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue/blender" COMPONENT runtime)
install(FILES third_party_config/ocio/config.ocio DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue" COMPONENT runtime)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE SECURITY.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)
# With it docs/tutorial.md begins.
install(FILES examples/glass_of_water.py DESTINATION "${CMAKE_INSTALL_DOCDIR}/examples" COMPONENT runtime)

if(ETENDUE_BUILD_LIBRARY)
  include(CMakePackageConfigHelpers)
  set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/Etendue")
  install(TARGETS etendue_library EXPORT EtendueTargets
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT development)
  install(DIRECTORY include/etendue TYPE INCLUDE COMPONENT development)
  install(EXPORT EtendueTargets FILE EtendueConfig.cmake NAMESPACE Etendue:: DESTINATION "${package_directory}"
    COMPONENT development)
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/EtendueConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
  install(FILES "${PROJECT_BINARY_DIR}/EtendueConfigVersion.cmake" DESTINATION "${package_directory}"
    COMPONENT development)
  install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT development
    PATTERN glass_of_water.py EXCLUDE)
endif()

# All that is installed, without tests.
add_custom_target(installable DEPENDS etendue manual scenes blender_addon)
if(ETENDUE_BUILD_LIBRARY)
  add_dependencies(installable etendue_library)
endif()

# cmake --build BUILD --target uninstall
add_custom_target(uninstall
  COMMAND "${CMAKE_COMMAND}" -D "build=${PROJECT_BINARY_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/uninstall.cmake"
  COMMENT "Removing what was installed" VERBATIM)

# tools/dev/package makes Debian packages of it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME etendue)
set(CPACK_PACKAGE_CONTACT "The Etendue authors <etendue@localhost>")
set(CPACK_PACKAGE_VENDOR "Etendue")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME etendue)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME etendue-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
  "offline renderer for glTF 2.0 scenes\nEtendue renders glTF 2.0 scenes by path tracing and bidirectional path tracing to colour-managed EXR images.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "offline renderer for glTF 2.0 scenes, development files\nHeaders and CMake files for programs that render with Etendue.")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/debian_layout.cmake")
set(CPACK_PROJECT_CONFIG_FILE "${PROJECT_SOURCE_DIR}/cmake/debian_dependencies.cmake")
set(CPACK_ETENDUE_OIIO_MODULE "${PROJECT_BINARY_DIR}/src/oiio/etendue_oiio.so")
set(CPACK_ETENDUE_COPYRIGHT "${PROJECT_SOURCE_DIR}/third_party_config/debian/copyright")
include(CPack)
