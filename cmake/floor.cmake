# palpate_floor(NAME SOURCES ... [NEEDS floors and packages in our headers] [PRIVATE packages in our .cpp only])
# makes the static library palpate_NAME out of palpate/NAME/. A floor links only the floors it names, so
# the order of floors in docs/architecture.md is also the link order.
function(palpate_floor name)
    cmake_parse_arguments(FLOOR "" "" "SOURCES;NEEDS;PRIVATE" ${ARGN})
    add_library(palpate_${name} STATIC ${FLOOR_SOURCES})
    add_library(palpate::${name} ALIAS palpate_${name})
    target_compile_features(palpate_${name} PUBLIC cxx_std_20)
    set_target_properties(palpate_${name} PROPERTIES EXPORT_NAME ${name})
    set_property(GLOBAL APPEND PROPERTY PALPATE_FLOORS palpate_${name})
    target_include_directories(palpate_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                               $<INSTALL_INTERFACE:include> PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
    target_compile_options(palpate_${name} PRIVATE ${PALPATE_WARNINGS} ${PALPATE_CODE})
    target_link_libraries(palpate_${name} PUBLIC ${FLOOR_NEEDS} PRIVATE ${FLOOR_PRIVATE})
    palpate_common_headers(palpate_${name})
endfunction()

# Our own code compiles without a warning; other people's headers come in as system headers. Other and newer
# compilers warn of other things, which must not stop a build. Both ./demo and ./check are strict, so they share objects.
set(PALPATE_WARNINGS -Wall -Wextra -Wpedantic)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 warns falsely of copies beyond the ends of its own std::string.
    list(APPEND PALPATE_WARNINGS -Wshadow=local -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
         -Wno-stringop-overread)
    if(CMAKE_UNITY_BUILD)  # GCC takes the files of a unity build for headers
        list(APPEND PALPATE_WARNINGS -Wno-subobject-linkage)
    endif()
    if(PALPATE_STRICT AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        list(APPEND PALPATE_WARNINGS -Werror)
    endif()
endif()

# A square root that need not set errno is one instruction. (No -ffast-math, which would reorder sums.) Without semantic
# interposition, calls within a file can be inlined in a shared object too.
set(PALPATE_CODE -fno-math-errno -fno-semantic-interposition)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # collecting garbage only from 512 MB on saves a tenth of GCC's time
    list(APPEND PALPATE_CODE "SHELL:--param ggc-min-heapsize=524288")
endif()

# Without optimisation GCC passes wide registers to functions compiled for narrow ones: the code it makes is wrong.
set(PALPATE_REGISTERS $<$<CONFIG:Debug>:-O1>)

# Precompiled headers: what nearly every file includes is parsed once for all libraries, which saves a quarter of the build
# time. They need the same flags everywhere, so only the libraries share them, not the programs. The preset "debug" does
# without, so each file must include what it needs. The other presets also compile eight files of a library as one (a unity
# build), which saves a third: names in unnamed namespaces must differ from those in neighbouring files.
function(palpate_common_headers target)
    if(target STREQUAL "palpate_base")
        target_precompile_headers(palpate_base PRIVATE <glm/glm.hpp> <fmt/format.h> <algorithm> <array> <atomic> <cmath>
            <filesystem> <functional> <limits> <map> <memory> <numeric> <optional> <ranges> <set>
            <span> <string> <thread> <variant> <vector>)
    else()
        target_precompile_headers(${target} REUSE_FROM palpate_base)
    endif()
endfunction()

# palpate_embed(TARGET FILE...) turns text files (shaders, scenes) into palpate/embedded/FILE.h, each holding one
# raw string literal to be included where a string is wanted: `const char* text =\n#include "embedded/FILE.h"\n;`
function(palpate_embed target)
    foreach(file ${ARGN})
        get_filename_component(name ${file} NAME)
        set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.h)
        file(STRINGS ${file} included REGEX "^#include \"")
        list(TRANSFORM included REPLACE "^#include \"(.*)\"$" "${PROJECT_SOURCE_DIR}/\\1")
        add_custom_command(OUTPUT ${out}
            COMMAND ${CMAKE_COMMAND} -DIN=${CMAKE_CURRENT_SOURCE_DIR}/${file} -DOUT=${out} -DROOT=${PROJECT_SOURCE_DIR}
                    -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
            DEPENDS ${file} ${included} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
        target_sources(${target} PRIVATE ${out})
    endforeach()
endfunction()
