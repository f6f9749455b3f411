# gridmorph_unity_build(<target> GROUPS <n> KEY <word> [KERNELS <regex>])
#
# With GRIDMORPH_UNITY_BUILD the sources of a target are compiled in n groups, each as one: headers are read and templates made once per
# group, which takes a quarter of the time of a first build and gives the same code. A change then costs the compilation of its group, so builds for
# daily work do without. CMake's own UNITY_BUILD leaves sources with options of their own alone, so groups are made here.
#
# GRIDMORPH_HOST_OPTIONS are compiler options for sources that have no kernels: their names, from the root of the project, do not match
# KERNELS. They are in n groups of their own then, and those with kernels, which are fewer, in n / 3.
#
# Two sources of one group cannot give one name of an anonymous namespace to different things. A checksum of the name of a source (with
# the key before it) decides on its group, so that a new file moves no other one; the key is one that keeps like names apart. Where a compiler complains of
# a redefinition in a new file, rename what it defines.
set(GRIDMORPH_HOST_OPTIONS "" CACHE STRING "Compiler options for sources without kernels, as -O1: the optimiser takes most of the time to build")

function(gridmorph_unity_build target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "GROUPS;KEY;KERNELS" "")
  set(groups_of_host ${arg_GROUPS})
  set(groups_of_kernels ${arg_GROUPS})
  set(of_kernels "")
  if(GRIDMORPH_HOST_OPTIONS)
    math(EXPR groups_of_kernels "(${arg_GROUPS} + 2) / 3")
    target_compile_options(${target} PRIVATE ${GRIDMORPH_HOST_OPTIONS})
    # Kernels have those of the build type again, behind them, and read their headers themselves: of a header that was precompiled with
    # other options g++ 13 and newer take nothing, and g++ 12 crashes.
    string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
    separate_arguments(options NATIVE_COMMAND "${CMAKE_CXX_FLAGS_${type}}")
    string(REPLACE ";" "\\;" options "${options}")
    set(of_kernels COMPILE_OPTIONS "${options}" SKIP_PRECOMPILE_HEADERS ON)
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  set(groups "")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE name)
    set(kind host)
    if(arg_KERNELS AND name MATCHES "${arg_KERNELS}" AND GRIDMORPH_HOST_OPTIONS)
      set(kind kernels)
    endif()
    if(GRIDMORPH_UNITY_BUILD)
      string(MD5 sum "${arg_KEY}/${name}")
      string(SUBSTRING "${sum}" 0 4 sum)
      math(EXPR group "0x${sum} % ${groups_of_${kind}}")
      list(APPEND groups ${kind}_${group})
      string(APPEND text_${kind}_${group} "#include \"${path}\"\n")
      set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES HEADER_FILE_ONLY ON)
    elseif(kind STREQUAL kernels)
      set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES ${of_kernels})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES groups)
  foreach(group IN LISTS groups)
    set(source "${CMAKE_CURRENT_BINARY_DIR}/groups/${target}_${group}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "${text_${group}}" @ONLY)
    target_sources(${target} PRIVATE "${source}")
    if(group MATCHES "^kernels")
      set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES ${of_kernels})
    endif()
  endforeach()
  if(groups)
    # A type of one source with members of its anonymous namespace is what g++ takes for a header's mistake here.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()
