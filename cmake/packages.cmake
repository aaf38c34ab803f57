# All that the library stands on, by its parts (`palpate_parts`). The build reads this list, and so does whoever finds the
# installed library: so the libraries that ours are linked with are found there again. `palpate_needs` is find_package or
# find_dependency.
palpate_needs(glm)
palpate_needs(fmt)
palpate_needs(Threads)

# Some of the following go on about optional programs that are not installed.
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
    pkg_check_modules(libzip REQUIRED IMPORTED_TARGET GLOBAL libzip)  # its own CMake file wants its programs too
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
    pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET GLOBAL tomlplusplus)  # its CMake file knows the headers alone
endif()

# viewer, which does without
pkg_check_modules(imgui IMPORTED_TARGET GLOBAL imgui)
pkg_check_modules(glfw IMPORTED_TARGET GLOBAL glfw3)

set(CMAKE_MESSAGE_LOG_LEVEL "${palpate_log_level}")
