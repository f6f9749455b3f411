include(CMakeFindDependencyMacro)
find_dependency(gridmorph)
include("${CMAKE_CURRENT_LIST_DIR}/warpTargets.cmake")
