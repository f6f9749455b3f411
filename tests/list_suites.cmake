# Read by ctest once per GoogleTest program: asks the program for its tests and makes one ctest test per suite, since one
# process per test takes longer than most tests; where split is on, one per test, or per value of a suite's parameter. Asking when ctest runs, not
# when the program is built, lets machines build what they cannot run.
#
# Given are name, program, split, shared_setup and threads, a list of which the first is every day's. With shared_setup, sanitizers run a suite in one process: what it sets up is made once.
cmake_policy(VERSION 3.25)
if(NOT EXISTS "${program}")
  add_test("${name}.is_not_built" "${program}")
  return()
endif()
execute_process(COMMAND "${program}" --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE failure TIMEOUT 60)
if(failure)
  message(FATAL_ERROR "${program} does not list its tests (${failure}):\n${listing}")
endif()

# A suite stands at the start of its line and ends with a dot, its tests follow indented. What parameters print comes after
# a '#' and may hold anything.
string(REGEX REPLACE " +#[^\n]*" "" listing "${listing}")
string(REGEX MATCHALL "[^\n]+" lines "${listing}")
set(filters "")
# Sanitizers find in one thread nothing that they do not find in several.
set(counts "${threads}")
list(GET threads 0 every_day)
if(DEFINED ENV{GRIDMORPH_TEST_REDUCED})
  set(counts ${every_day})
  if(shared_setup)
    set(split FALSE)
  endif()
endif()
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)[.]$")
    set(suite "${CMAKE_MATCH_1}")
    continue()
  endif()
  if(split AND line MATCHES "^  [A-Za-z0-9_]+(/[A-Za-z0-9_]+)$")
    set(filter "${suite}.*${CMAKE_MATCH_1}")
  elseif(split AND line MATCHES "^  ([A-Za-z0-9_]+)$")
    set(filter "${suite}.${CMAKE_MATCH_1}")
  elseif(line MATCHES "^  [A-Za-z0-9_/]+$")
    set(filter "${suite}.*")
  else()
    continue()
  endif()
  if(filter IN_LIST filters)
    continue()
  endif()
  list(APPEND filters "${filter}")
  string(REGEX REPLACE "[.][*]/?" "." group "${filter}") # Suite.value, Suite.Test
  string(REGEX REPLACE "[.]$" "" group "${group}")
  foreach(n IN LISTS counts)
    set(test "${name}.${group}")
    set(label "")
    if(NOT n EQUAL every_day)
      set(test "${name}_threads_${n}.${group}")
      set(label nightly)
    endif()
    add_test("${test}" "${program}" "--gtest_filter=${filter}" --gtest_brief=1)
    # Skipped: where no test passed and none failed. A program says so in its last lines.
    set_tests_properties(
      "${test}" PROPERTIES LABELS "${label}" ENVIRONMENT "OMP_NUM_THREADS=${n};OMP_PROC_BIND=false;OMP_WAIT_POLICY=passive"
                           SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$")
  endforeach()
endforeach()
