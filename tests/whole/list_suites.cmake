# Writes a CTest test for each suite of a GoogleTest program: the tests of a suite share a process, and with it what
# they prepare once. A single test: --gtest_filter of the program.
#   cmake -DPROGRAM=<program> -DOUT=<file for CTest to include> -DSECONDS=<limit for a suite> -P list_suites.cmake
cmake_minimum_required(VERSION 3.24)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." suites "${listed}")
set(tests "")
foreach(suite IN LISTS suites)
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" suite "${suite}")
  set(cost 1)
  if(suite MATCHES "^(NumberSweep|Planted|SimulatorFrame|StudyCommandTest|Tolerance)$")
    set(cost 100)  # the longest ones first, so that none is left to run alone
  endif()
  string(APPEND tests "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                      "set_tests_properties([=[${suite}]=] PROPERTIES TIMEOUT ${SECONDS} COST ${cost})\n")
endforeach()
file(WRITE ${OUT} "${tests}")
