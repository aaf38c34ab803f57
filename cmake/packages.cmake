# All packages that the library needs, by its parts (`palpate_parts`). The build reads this list with `palpate_needs` as
# find_package; the installed palpateConfig.cmake, with find_dependency, so that dependents find the same packages.
palpate_needs(glm)
palpate_needs(fmt)
palpate_needs(Threads)

# Some of the following report at length on optional programs that are not installed.
set(palpate_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)

palpate_needs(PkgConfig)

# body, solver
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET GLOBAL libhwy)

if("voxels" IN_LIST palpate_parts)
    list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)  # where Debian puts it
    palpate_needs(OpenVDB)
endif()
if("voxels" IN_LIST palpate_parts OR "files" IN_LIST palpate_parts)
    palpate_needs(meshoptimizer)
endif()
if("files" IN_LIST palpate_parts)
    palpate_needs(ZLIB)
    palpate_needs(EXPAT)
    pkg_check_modules(libzip REQUIRED IMPORTED_TARGET GLOBAL libzip)  # its own CMake file requires its programs too
    palpate_needs(assimp)
    pkg_check_modules(draco REQUIRED IMPORTED_TARGET GLOBAL draco)
    palpate_needs(Boost COMPONENTS iostreams)
    palpate_needs(GDCM)
    palpate_needs(nlohmann_json)
endif()
if("opengl" IN_LIST palpate_parts)
    pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
endif()
if("voxels" IN_LIST palpate_parts AND "files" IN_LIST palpate_parts)  # scene
    pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET GLOBAL tomlplusplus)  # its CMake file offers only the header-only library
endif()

# viewer; optional
pkg_check_modules(imgui IMPORTED_TARGET GLOBAL imgui)
pkg_check_modules(glfw IMPORTED_TARGET GLOBAL glfw3)

set(CMAKE_MESSAGE_LOG_LEVEL "${palpate_log_level}")
