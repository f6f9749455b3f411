# Options of our own targets; never exported. -Wno-restrict: gcc 12 sees an overlap in every "text" + std::string (gcc
# bug 105651). -Wno-psabi: vectors of four doubles are returned by functions that are always inlined. Fused multiply-adds chosen by the
# optimiser make results depend on inlining and vectorisation, so that backends, or two orientations of one line, round differently. Nobody
# asks errno about square roots; without it they are one instruction, for all lanes of a register.
add_library(gridmorph_own_options INTERFACE)
target_compile_options(
  gridmorph_own_options
  INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang,IntelLLVM>:-Wall -Wextra>
            $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict -Wno-psabi>
            $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-psabi>
            $<$<AND:$<BOOL:${GRIDMORPH_WARNINGS_AS_ERRORS}>,$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang,IntelLLVM>>:-Werror>
            $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang,AppleClang,IntelLLVM>:-ffp-contract=off -fno-math-errno>)
# The name of what rounds in public headers: see kernels/vec3.hpp.
target_compile_definitions(gridmorph_own_options INTERFACE GRIDMORPH_ARITHMETIC=own_arithmetic)
# nvcc goes by another option for device code. nvcc_wrapper is a GNU compiler to CMake, so the option itself is the question.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(--fmad=false GRIDMORPH_COMPILER_IS_NVCC)
if(GRIDMORPH_COMPILER_IS_NVCC)
  target_compile_options(gridmorph_own_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:--fmad=false>)
endif()

# What every compiled target of ours shares.
function(gridmorph_target_defaults target)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:gridmorph_own_options>)
  set_target_properties(${target} PROPERTIES CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
endfunction()

# gridmorph_precompile_headers(<target> [REUSE_FROM <other target of the same compiler options>])
#
# Kokkos and the standard library take a third of the time of most sources: with GRIDMORPH_PRECOMPILE_HEADERS they are read once
# per target. Sources include what they need all the same.
function(gridmorph_precompile_headers target)
  if(NOT GRIDMORPH_PRECOMPILE_HEADERS)
    return()
  endif()
  if(ARGN)
    target_precompile_headers(${target} ${ARGN})
  else()
    target_precompile_headers(
      ${target} PRIVATE <Kokkos_Core.hpp> <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <span> <string>
                        <variant> <vector>)
  endif()
  # The first lets ccache see through it; scripts/lib/project.sh has the other half. With precompiled headers gcc 12 no longer knows
  # which code is the system's, and warns of the impossible in "text" + std::string: these are off.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess -Wno-stringop-overflow -Wno-array-bounds>)
endfunction()

# What other libraries add to that: they read what the core has read. Compilers other than g++ refuse it where definitions differ.
set(gridmorph_reuse_core "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(gridmorph_reuse_core REUSE_FROM gridmorph)
endif()

# gridmorph_add_library(<target> EXPORT_NAME <name> FOLDERS <folder> ... HEADERS <header> ...)
#
# Makes the library <target>, known outside as gridmorph::<name>, from folders of src/gridmorph. The sources are listed in
# each folder's CMakeLists.txt. What is installed are the HEADERS.
function(gridmorph_add_library target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "EXPORT_NAME" "FOLDERS;HEADERS")
  add_library(${target})
  add_library(gridmorph::${arg_EXPORT_NAME} ALIAS ${target})
  gridmorph_target_defaults(${target})
  if(target STREQUAL "gridmorph")
    gridmorph_precompile_headers(${target})
  else()
    gridmorph_precompile_headers(${target} ${gridmorph_reuse_core})
  endif()
  set_target_properties(
    ${target} PROPERTIES EXPORT_NAME ${arg_EXPORT_NAME} VERSION ${PROJECT_VERSION}
                         SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_sources(${target} PUBLIC FILE_SET HEADERS TYPE HEADERS BASE_DIRS "${CMAKE_CURRENT_SOURCE_DIR}" FILES ${arg_HEADERS})
  foreach(folder IN LISTS arg_FOLDERS)
    add_subdirectory(gridmorph/${folder})
  endforeach()
endfunction()
