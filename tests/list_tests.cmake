# CTest includes this file when it starts. It makes a ctest entry of each test case of a program.

# Adds the test cases of a program with the properties given behind. Their names begin with prefix.
# The cases are read from the file PROGRAM_tests.cmake. The program is run to write that file if it is
# newer than the file, or if CMake has changed the properties since. A program that is not built
# gets one entry, which fails.
# With RUNSTONE_TEST_UNITS=whole in the environment, a program of unit tests gets one entry, too: the start
# of a process takes longer than most cases, with sanitizers by far.
function(runstone_list_tests name prefix)
  set(program ${CMAKE_CURRENT_LIST_DIR}/${name})
  set(list ${program}_tests.cmake)
  if(NOT EXISTS ${program})
    add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)
    return()
  endif()
  set(properties ${ARGN})
  list(FIND properties unit label)
  if("$ENV{RUNSTONE_TEST_UNITS}" STREQUAL whole AND label GREATER -1)
    string(REGEX REPLACE "[.]$" "" entry ${prefix})
    add_test(${entry} ${program})
    set_tests_properties(${entry} PROPERTIES WORKING_DIRECTORY ${CMAKE_CURRENT_LIST_DIR} ${ARGN} COST 20)  # the longest ones
    return()
  endif()
  if(${program} IS_NEWER_THAN ${list} OR ${CMAKE_CURRENT_LIST_FILE} IS_NEWER_THAN ${list})
    # The program returns the number of its cases.
    execute_process(COMMAND ${program} --list-test-names-only OUTPUT_VARIABLE cases RESULT_VARIABLE count)
    if(NOT count GREATER 0)
      message(FATAL_ERROR "${program} does not list its tests: ${count}\n${cases}")
    endif()
    string(REGEX REPLACE "\n$" "" cases "${cases}")
    string(REPLACE "\n" ";" cases "${cases}")
    set(script "")
    foreach(case IN LISTS cases)
      string(REPLACE "," "\\," pattern "${case}")
      string(APPEND script "add_test([==[${prefix}${case}]==] [==[${program}]==] [==[${pattern}]==])\n"
             "set_tests_properties([==[${prefix}${case}]==] PROPERTIES WORKING_DIRECTORY [==[${CMAKE_CURRENT_LIST_DIR}]==]")
      foreach(word IN LISTS ARGN)
        string(APPEND script " [==[${word}]==]")
      endforeach()
      string(APPEND script ")\n")
    endforeach()
    file(WRITE ${list}.new "${script}")
    file(RENAME ${list}.new ${list})
  endif()
  include(${list})
endfunction()
