# `cmake --install build/release --prefix DIR`: the program, the static library, the public headers
# and what find_package(arris) needs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(ARRIS_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/arris)
install(TARGETS arris EXPORT arrisTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT arrisTargets NAMESPACE arris:: DESTINATION ${ARRIS_PACKAGE_DIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/arris DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET arris_program)
  install(TARGETS arris_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/arrisConfig.cmake.in
  ${PROJECT_BINARY_DIR}/arrisConfig.cmake INSTALL_DESTINATION ${ARRIS_PACKAGE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/arrisConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/arrisConfig.cmake ${PROJECT_BINARY_DIR}/arrisConfigVersion.cmake
  DESTINATION ${ARRIS_PACKAGE_DIR})
