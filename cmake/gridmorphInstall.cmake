# Install and package files: find_package(gridmorph [COMPONENTS core io mpi]).
#
# Components of cmake --install: `runtime` (the command, shared libraries, manual page, completion, scripts that draw),
# `development` (headers, static libraries, package files) and `documentation` (pages, examples with their meshes).
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/gridmorph")
set(data_folder "${CMAKE_INSTALL_DATADIR}/gridmorph")
set(doc_folder "${CMAKE_INSTALL_DOCDIR}")
if(NOT PROJECT_IS_TOP_LEVEL)
  set(doc_folder "${CMAKE_INSTALL_DATAROOTDIR}/doc/gridmorph") # the other one is the parent project's
endif()

# One export set per component of find_package, so that a user of the core never hears of CGNS.
function(gridmorph_install component)
  install(
    TARGETS ${ARGN}
    EXPORT gridmorph_${component}
    RUNTIME COMPONENT runtime
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
    ARCHIVE COMPONENT development
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development
    INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT gridmorph_${component} FILE gridmorph_${component}.cmake NAMESPACE gridmorph:: DESTINATION "${package_folder}"
          COMPONENT development)
endfunction()

gridmorph_install(core gridmorph_kernels gridmorph)
if(GRIDMORPH_ENABLE_IO)
  gridmorph_install(io gridmorph_io)
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/FindCGNS.cmake" DESTINATION "${package_folder}" COMPONENT development)
endif()
if(GRIDMORPH_ENABLE_MPI)
  gridmorph_install(mpi gridmorph_mpi)
endif()
if(GRIDMORPH_ENABLE_CLI)
  install(TARGETS gridmorph_cli COMPONENT runtime)
  if(BUILD_SHARED_LIBS)
    install(TARGETS gridmorph_tools gridmorph_case gridmorph_run LIBRARY COMPONENT runtime NAMELINK_SKIP)
  endif()
  install(FILES "${PROJECT_SOURCE_DIR}/docs/gridmorph.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT runtime)
  install(FILES "${PROJECT_SOURCE_DIR}/scripts/completion/gridmorph.bash"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME gridmorph COMPONENT runtime)
  # A script for users of the command; the others are for work on gridmorph.
  install(PROGRAMS "${PROJECT_SOURCE_DIR}/scripts/convert-mesh" DESTINATION "${data_folder}/scripts" COMPONENT runtime)
endif()

configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/gridmorphConfig.cmake.in" "${PROJECT_BINARY_DIR}/gridmorphConfig.cmake"
  INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/gridmorphConfigVersion.cmake" VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(
  FILES "${PROJECT_BINARY_DIR}/gridmorphConfig.cmake" "${PROJECT_BINARY_DIR}/gridmorphConfigVersion.cmake"
        "${PROJECT_SOURCE_DIR}/cmake/gridmorphCheckKokkos.cmake"
  DESTINATION "${package_folder}" COMPONENT development)

# Licence and notices go along with either half of the program.
foreach(component IN ITEMS runtime development)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${doc_folder}" COMPONENT ${component})
  install(FILES "${PROJECT_SOURCE_DIR}/docs/dependencies.md" DESTINATION "${doc_folder}/docs" COMPONENT ${component})
endforeach()

if(PROJECT_IS_TOP_LEVEL)
  # Pages lie as in the source tree, so that links between them, to images and to examples hold.
  foreach(page IN ITEMS README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE)
    install(FILES "${PROJECT_SOURCE_DIR}/${page}" DESTINATION "${doc_folder}" COMPONENT documentation)
  endforeach()
  install(
    DIRECTORY "${PROJECT_SOURCE_DIR}/docs/" DESTINATION "${doc_folder}/docs" COMPONENT documentation
    FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
  # Examples are run where they lie, so they are data; what pages call ../examples is a link to them.
  install(
    DIRECTORY "${PROJECT_SOURCE_DIR}/examples/" DESTINATION "${data_folder}/examples" USE_SOURCE_PERMISSIONS
    COMPONENT documentation PATTERN generators EXCLUDE)
  foreach(folder IN ITEMS data doc)
    cmake_path(ABSOLUTE_PATH ${folder}_folder BASE_DIRECTORY "/" OUTPUT_VARIABLE ${folder}_from_root)
  endforeach()
  set(links "${PROJECT_BINARY_DIR}/generated/links")
  file(MAKE_DIRECTORY "${links}")
  file(RELATIVE_PATH examples "${doc_from_root}" "${data_from_root}/examples")
  file(CREATE_LINK "${examples}" "${links}/examples" SYMBOLIC)
  install(FILES "${links}/examples" DESTINATION "${doc_folder}" COMPONENT documentation)
  # So that links from examples to pages hold too.
  file(RELATIVE_PATH docs "${data_from_root}" "${doc_from_root}/docs")
  file(CREATE_LINK "${docs}" "${links}/docs" SYMBOLIC)
  install(FILES "${links}/docs" DESTINATION "${data_folder}" COMPONENT documentation)
endif()
