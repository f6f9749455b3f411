# Install and package files: find_package(gridmorph [COMPONENTS core io]).
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/gridmorph")

# One export set per component, so that a user of the core never hears of CGNS.
function(gridmorph_install component)
  install(
    TARGETS ${ARGN}
    EXPORT gridmorph_${component}
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
    INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT gridmorph_${component} FILE gridmorph_${component}.cmake NAMESPACE gridmorph:: DESTINATION "${package_folder}")
endfunction()

gridmorph_install(core gridmorph_kernels gridmorph)
if(GRIDMORPH_ENABLE_IO)
  gridmorph_install(io gridmorph_io)
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/FindCGNS.cmake" DESTINATION "${package_folder}")
endif()
if(GRIDMORPH_ENABLE_CLI)
  install(TARGETS gridmorph_cli)
  if(BUILD_SHARED_LIBS)
    install(TARGETS gridmorph_app)
  endif()
  install(FILES "${PROJECT_SOURCE_DIR}/docs/gridmorph.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
  install(FILES "${PROJECT_SOURCE_DIR}/scripts/completion/gridmorph.bash"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME gridmorph)
  # What --help refers to.
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/" DESTINATION "${CMAKE_INSTALL_DOCDIR}" FILES_MATCHING PATTERN "*.md" PATTERN "*.png")
  install(FILES "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
endif()

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/gridmorphConfig.cmake.in" "${PROJECT_BINARY_DIR}/gridmorphConfig.cmake"
  INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/gridmorphConfigVersion.cmake" VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(
  FILES "${PROJECT_BINARY_DIR}/gridmorphConfig.cmake" "${PROJECT_BINARY_DIR}/gridmorphConfigVersion.cmake"
        "${PROJECT_SOURCE_DIR}/cmake/gridmorphCheckKokkos.cmake"
  DESTINATION "${package_folder}")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
