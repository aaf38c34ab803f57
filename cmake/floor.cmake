# palpate_floor(NAME SOURCES ... [NEEDS floors and packages in our headers] [PRIVATE packages in our .cpp only])
# makes the static library palpate_NAME out of palpate/NAME/. A floor links only the floors it names, so the
# house that docs/architecture.md draws is also the order in which it links.
function(palpate_floor name)
    cmake_parse_arguments(FLOOR "" "" "SOURCES;NEEDS;PRIVATE" ${ARGN})
    add_library(palpate_${name} STATIC ${FLOOR_SOURCES})
    add_library(palpate::${name} ALIAS palpate_${name})
    target_compile_features(palpate_${name} PUBLIC cxx_std_20)
    set_target_properties(palpate_${name} PROPERTIES EXPORT_NAME ${name})
    set_property(GLOBAL APPEND PROPERTY PALPATE_FLOORS palpate_${name})
    target_include_directories(palpate_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                               $<INSTALL_INTERFACE:include> PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
    target_compile_options(palpate_${name} PRIVATE ${PALPATE_WARNINGS})
    target_link_libraries(palpate_${name} PUBLIC ${FLOOR_NEEDS} PRIVATE ${FLOOR_PRIVATE})
endfunction()

# Our own code compiles without a warning; other people's headers come in as system headers.
set(PALPATE_WARNINGS -Wall -Wextra -Wpedantic)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # others, which the fuzzers need, warn of other things
    list(APPEND PALPATE_WARNINGS -Wshadow=local -Werror)
endif()

# palpate_embed(TARGET FILE...) turns text files (shaders, scenes) into palpate/embedded/FILE.h, each holding one
# raw string literal to be included where a string is wanted: `const char* text =\n#include "embedded/FILE.h"\n;`
function(palpate_embed target)
    foreach(file ${ARGN})
        get_filename_component(name ${file} NAME)
        set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.h)
        add_custom_command(OUTPUT ${out}
            COMMAND ${CMAKE_COMMAND} -DIN=${CMAKE_CURRENT_SOURCE_DIR}/${file} -DOUT=${out}
                    -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
            DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
        target_sources(${target} PRIVATE ${out})
    endforeach()
endfunction()
