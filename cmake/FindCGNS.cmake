# Finds CGNS 3.4 or 4.x, with or without a CMake package of its own, and defines one target for it.
#
#   CGNS::CGNS      headers and library, with the HDF5 that both CGNS and gridmorph use, and what a static CGNS needs
#   CGNS_VERSION    e.g. 4.5.0
#   CGNS_FOUND
#
# Set CGNS_ROOT or CMAKE_PREFIX_PATH to the prefix where CGNS is installed. Targets that a parent project has made are
# taken as they are. CGNS's own package file is not used: most distributions do not have it, and it names HDF5 targets
# that it does not look for.
include(FindPackageHandleStandardArgs)

set(_cgns_target "")
foreach(_cgns_candidate IN ITEMS CGNS::cgns_static CGNS::cgns_shared CGNS::cgns-static CGNS::cgns-shared)
  if(NOT _cgns_target AND TARGET ${_cgns_candidate})
    set(_cgns_target ${_cgns_candidate})
  endif()
endforeach()

if(TARGET CGNS::CGNS)
  set(_cgns_required CGNS_VERSION)
elseif(_cgns_target)
  set(_cgns_required _cgns_target)
  if(NOT CGNS_VERSION)
    set(CGNS_VERSION 4)  # only CGNS 4 and newer make these targets
  endif()
else()
  foreach(_cgns_path IN ITEMS CGNS_INCLUDE_DIR CGNS_LIBRARY)
    if(DEFINED CACHE{${_cgns_path}} AND NOT EXISTS "${${_cgns_path}}")
      unset(${_cgns_path} CACHE)  # it was there when the build folder was made
    endif()
  endforeach()
  find_path(CGNS_INCLUDE_DIR cgnslib.h)
  find_library(CGNS_LIBRARY NAMES cgns cgnsdll)
  mark_as_advanced(CGNS_INCLUDE_DIR CGNS_LIBRARY)
  set(_cgns_required CGNS_LIBRARY CGNS_INCLUDE_DIR)
  set(_cgns_links "")

  if(CGNS_LIBRARY AND CGNS_INCLUDE_DIR)
    # "#define CGNS_VERSION 4500"
    file(STRINGS "${CGNS_INCLUDE_DIR}/cgnslib.h" _cgns_line REGEX "^#define +CGNS_VERSION +[0-9]+")
    if(_cgns_line MATCHES " ([0-9])([0-9])([0-9])[0-9]$")
      set(CGNS_VERSION "${CMAKE_MATCH_1}.${CMAKE_MATCH_2}.${CMAKE_MATCH_3}")
    endif()
    file(READ "${CGNS_INCLUDE_DIR}/cgnsconfig.h" _cgns_config)
    if(_cgns_config MATCHES "#define +CG_BUILD_HDF5 +0")
      list(APPEND _cgns_required CGNS_WITH_HDF5)  # never set: this CGNS opens ADF files only
    endif()
    if(_cgns_config MATCHES "#define +(CG_BUILD_PARALLEL|HDF5_NEED_MPI) +1")
      set(HDF5_PREFER_PARALLEL TRUE)
    endif()
    if(CGNS_LIBRARY MATCHES "\\${CMAKE_STATIC_LIBRARY_SUFFIX}$")
      find_package(ZLIB QUIET)
      list(APPEND _cgns_required ZLIB_FOUND)
      set(_cgns_links ZLIB::ZLIB ${CMAKE_DL_LIBS})
    endif()
  endif()
endif()

# It must be the one that CGNS was built with: HDF5 ends programs whose headers and library differ.
if(NOT TARGET HDF5::HDF5)
  enable_language(C)  # FindHDF5 compiles a C program
  find_package(HDF5 QUIET COMPONENTS C)
endif()
if(NOT TARGET HDF5::HDF5)
  list(APPEND _cgns_required HDF5_FOUND)
endif()

find_package_handle_standard_args(
  CGNS REQUIRED_VARS ${_cgns_required} VERSION_VAR CGNS_VERSION
  REASON_FAILURE_MESSAGE
    "gridmorph reads and writes meshes with CGNS 3.4 or newer, built with HDF5. Name its prefix with -DCGNS_ROOT=<prefix>, take the one that scripts/install-dependencies provides, or build without files: -DGRIDMORPH_ENABLE_IO=OFF.")

if(CGNS_FOUND AND NOT TARGET CGNS::CGNS)
  if(_cgns_target)
    add_library(CGNS::CGNS INTERFACE IMPORTED)
    target_link_libraries(CGNS::CGNS INTERFACE ${_cgns_target} HDF5::HDF5)
  else()
    add_library(CGNS::CGNS UNKNOWN IMPORTED)
    set_target_properties(
      CGNS::CGNS PROPERTIES IMPORTED_LOCATION "${CGNS_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${CGNS_INCLUDE_DIR}"
                            INTERFACE_LINK_LIBRARIES "HDF5::HDF5;${_cgns_links}")
    if(HDF5_PREFER_PARALLEL)
      find_package(MPI QUIET COMPONENTS C)
      if(MPI_C_FOUND)
        target_link_libraries(CGNS::CGNS INTERFACE MPI::MPI_C)
      endif()
    endif()
  endif()
endif()
