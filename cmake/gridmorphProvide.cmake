# pip has no Kokkos and no CGNS to give: builds of pip take what scripts/install-dependencies finds or provides. Others name prefixes themselves.
message(STATUS "What gridmorph needs, as scripts/install-dependencies finds or provides it: the first time a few minutes")
set(parts --command)
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
if(NOT Python_Development.Module_FOUND)
  list(APPEND parts --python-headers)
endif()
execute_process(
  COMMAND "${PROJECT_SOURCE_DIR}/scripts/install-dependencies" ${parts}
  OUTPUT_VARIABLE prefixes OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR
    "What gridmorph needs is not all there, and scripts/install-dependencies could not provide it (its words are above): do what it says, "
    "or install what is missing and name the prefixes in CMAKE_PREFIX_PATH.")
endif()
string(REPLACE ":" ";" prefixes "${prefixes}")
list(PREPEND CMAKE_PREFIX_PATH ${prefixes})
