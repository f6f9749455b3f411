# cmake -DSOURCE=<root> -DFOLDER=<scratch> -P quick_preset.cmake
#
# What scripts/demo builds with has options of its own for sources with kernels and for those without, and a precompiled header between them,
# of which a compiler has crashed. Compiles one group of each.
execute_process(COMMAND "${CMAKE_COMMAND}" --preset quick -B "${FOLDER}" WORKING_DIRECTORY "${SOURCE}" COMMAND_ERROR_IS_FATAL ANY)
set(objects)
foreach(kind kernels host)
  file(GLOB groups RELATIVE "${FOLDER}/src" "${FOLDER}/src/groups/gridmorph_${kind}_*.cpp")
  if(NOT groups)
    message(FATAL_ERROR "${FOLDER}/src/groups has no gridmorph_${kind}_*.cpp: this test is to look elsewhere")
  endif()
  list(GET groups 0 group)
  list(APPEND objects "src/CMakeFiles/gridmorph.dir/${group}.o")
endforeach()
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${FOLDER}" --target ${objects} COMMAND_ERROR_IS_FATAL ANY)
