# Read by ctest when it starts: each suite of a test program is one test and one process. So what a suite shares
# (a context, compiled shaders, loaded pages of the program) is made once, and a report still says where it
# failed. The including file sets `program` and `floor`.
if(NOT EXISTS ${program})
    add_test(${floor}/is-not-built ${program})
    return()
endif()
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE list COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\.[ \n]" suites "${list}")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n. ]" "" suite "${suite}")
    add_test(${floor}/${suite} ${program} --gtest_brief=1 --gtest_filter=${suite}.*)
    set_tests_properties(${floor}/${suite} PROPERTIES TIMEOUT 7200)  # s; only a hang takes so long, even on the slowest machine
endforeach()
