# The command, the headers, the libraries, and what find_package(palpate) needs to find them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)

get_property(floors GLOBAL PROPERTY PALPATE_FLOORS)
install(TARGETS palpate-app)
install(TARGETS ${floors} palpate EXPORT palpateTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/palpate DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN *.h PATTERN *.inl)
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${config})
write_basic_package_version_file(palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/palpateConfig.cmake cmake/packages.cmake ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
        DESTINATION ${config})
