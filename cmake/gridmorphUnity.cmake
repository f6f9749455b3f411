# gridmorph_unity_build(<target> GROUPS <n> KEY <word>)
#
# With GRIDMORPH_UNITY_BUILD the sources of a target are compiled in n groups, each as one: headers are read and templates made once per
# group, which takes a quarter of the time of a first build and gives the same code. A change then costs the compilation of its group, so builds for
# daily work do without.
#
# Two sources of one group cannot give one name of an anonymous namespace to different things. A checksum of the name of a source (with
# the key before it) decides on its group, so that a new file moves no other one; the key is one that keeps like names apart. Where a compiler complains of
# a redefinition in a new file, rename what it defines. Sources with options of their own stay alone.
function(gridmorph_unity_build target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "GROUPS;KEY" "")
  if(NOT GRIDMORPH_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # A type of one source with members of its anonymous namespace is what g++ takes for a header's mistake here.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE name)
    cmake_path(RELATIVE_PATH name BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
    string(MD5 sum "${arg_KEY}/${name}")
    string(SUBSTRING "${sum}" 0 4 sum)
    math(EXPR group "0x${sum} % ${arg_GROUPS}")
    set_source_files_properties("${source}" TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP "${target}_${group}")
  endforeach()
endfunction()
