# The core reads no headers and links no libraries of packages other than its own, and once installed it is found where
# other packages are missing.
#     cmake -D BUILD=the tree built -D PROGRAM=core_alone -D SOURCE=this folder -D FLAGS=its flags -D WORK=a folder -P ...
function(run)
    execute_process(COMMAND ${ARGV} WORKING_DIRECTORY ${WORK} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Fails if a line names a folder or a file of another package.
function(refuse_others what text)
    string(REGEX MATCHALL "[^\n]*(openvdb|tbb|assimp|gdcm|draco|expat|zip|zlib|libz\\.|boost|meshopt|stb_|nlohmann|toml|epoxy|libGL|EGL/|GL/)[^\n]*"
           others "${text}")
    if(others)
        message(FATAL_ERROR "The core's ${what}: ${others}")
    endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

execute_process(COMMAND ninja -C ${BUILD} -t deps OUTPUT_VARIABLE headers COMMAND_ERROR_IS_FATAL ANY)
if(NOT headers MATCHES "glm/glm.hpp")
    message(FATAL_ERROR "It is not known which headers were read")
endif()
refuse_others("headers" "${headers}")
execute_process(COMMAND ldd ${PROGRAM} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
refuse_others("libraries" "${libraries}")

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
file(WRITE ${WORK}/guest/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(guest LANGUAGES CXX)
find_package(palpate REQUIRED)
add_executable(guest ${SOURCE}/core_alone.cpp)
target_link_libraries(guest PRIVATE palpate::palpate)
")
foreach(package OpenVDB TBB meshoptimizer assimp GDCM ZLIB EXPAT Boost nlohmann_json)
    list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -G Ninja -S guest -B found -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_CXX_FLAGS=${FLAGS} ${hidden})
run(${CMAKE_COMMAND} --build found)
run(found/guest)
