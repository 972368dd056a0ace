# What `cmake --install` puts where, in two components: `runtime`, the program with all that belongs to it and the shared
# library, and `development`, what other programs are built with.
install(TARGETS etendue COMPONENT runtime)
install(DIRECTORY "${ETENDUE_MANUAL}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT runtime)
install(DIRECTORY "${ETENDUE_MANUAL}/" DESTINATION "${CMAKE_INSTALL_DATADIR}" COMPONENT runtime
  PATTERN man EXCLUDE)
install(DIRECTORY scenes DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue" COMPONENT runtime
  PATTERN CMakeLists.txt EXCLUDE)
install(FILES third_party_config/ocio/config.ocio DESTINATION "${CMAKE_INSTALL_DATADIR}/etendue" COMPONENT runtime)
install(FILES README.md LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)

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
  install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT development)
endif()

# All that is installed, without tests.
add_custom_target(installable DEPENDS etendue manual scenes)
if(ETENDUE_BUILD_LIBRARY)
  add_dependencies(installable etendue_library)
endif()

# cmake --build BUILD --target uninstall
add_custom_target(uninstall
  COMMAND "${CMAKE_COMMAND}" -D "build=${PROJECT_BINARY_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/uninstall.cmake"
  COMMENT "Removing what was installed" VERBATIM)
