# Palpate in other projects: once installed, it is found by the programs of examples/, and as a folder of another project
# it builds there.  cmake -D BUILD=a built tree -D SOURCE=its sources -D FLAGS=its flags -D WORK=a folder -P ...
function(run)
    execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${WORK}/prefix/bin/palpate list scenes)
file(COPY ${SOURCE}/examples/programs DESTINATION ${WORK})
run(${CMAKE_COMMAND} -G Ninja -S programs -B found -D CMAKE_PREFIX_PATH=${WORK}/prefix
    -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build found --target first_touch show_a_body)
run(found/first_touch)
if(NOT EXISTS ${WORK}/pressed.ply)
    message(FATAL_ERROR "first_touch wrote nothing")
endif()

# All of it in one shared object, like a plug-in or a Python module: all of it must be position-independent.
file(WRITE ${WORK}/plugin/plugin.cpp "#include <palpate/palpate.h>
bool works() { return palpate::names(palpate::Backend{}).size() > 1; }
")
file(WRITE ${WORK}/plugin/main.cpp "bool works();
int main() { return works() ? 0 : 1; }
")
file(WRITE ${WORK}/plugin/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(plugin LANGUAGES CXX)
find_package(palpate REQUIRED)
add_library(plugin SHARED plugin.cpp)
file(GLOB floors ${WORK}/prefix/lib*/libpalpate_*.a ${WORK}/prefix/lib/*/libpalpate_*.a)
target_link_libraries(plugin PRIVATE -Wl,--whole-archive \${floors} -Wl,--no-whole-archive palpate::viewer)
add_executable(host main.cpp)
target_link_libraries(host PRIVATE plugin)
")
run(${CMAKE_COMMAND} -G Ninja -S plugin -B shared -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build shared)
run(shared/host)

# The build itself shows that the rest compiles; this checks that all targets are found from outside.
file(WRITE ${WORK}/host/main.cpp "#include <palpate/base/files.h>
int main() { palpate::write_text(\"said\", \"hello\"); }
")
file(WRITE ${WORK}/host/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(host LANGUAGES CXX)
add_subdirectory(${SOURCE} palpate)
add_executable(small main.cpp)
target_link_libraries(small PRIVATE palpate::base)
add_executable(whole main.cpp)
target_link_libraries(whole PRIVATE palpate::palpate)
if(TARGET palpate-app OR TARGET test_base)
    message(FATAL_ERROR \"more is built than was asked for\")
endif()
get_property(floors GLOBAL PROPERTY PALPATE_FLOORS)
foreach(floor IN LISTS floors)
    get_target_property(options \${floor} COMPILE_OPTIONS)
    if(\"\${options}\" MATCHES Werror)
        message(FATAL_ERROR \"a warning in \${floor} would stop its host\")
    endif()
endforeach()
")
run(${CMAKE_COMMAND} -G Ninja -S host -B within -D CMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build within --target small)
run(within/small)
