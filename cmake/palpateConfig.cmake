# find_package(palpate) in a program outside: the targets palpate::palpate (all that was built) and palpate::FLOOR (one
# floor with those below it: base, mesh, voxels, files, body, scene, solver, touch, gl, render, run, viewer).
include(CMakeFindDependencyMacro)
macro(palpate_needs)
    find_dependency(${ARGV})
endmacro()

set(palpate_parts "@palpate_parts@")
include(${CMAKE_CURRENT_LIST_DIR}/packages.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/palpateTargets.cmake)
