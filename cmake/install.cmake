# The command, the headers, the libraries, and what find_package(palpate) needs to find them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/palpate)

get_property(floors GLOBAL PROPERTY PALPATE_FLOORS)
if(TARGET palpate-app)
    install(TARGETS palpate-app)
endif()
install(TARGETS ${floors} palpate EXPORT palpateTargets)
foreach(floor IN LISTS floors)
    string(REPLACE palpate_ palpate/ folder ${floor})
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate
            FILES_MATCHING PATTERN *.h PATTERN *.inl)
endforeach()
if(TARGET palpate::run)  # all parts are built
    install(FILES ${PROJECT_SOURCE_DIR}/palpate/palpate.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/palpate)
endif()
install(EXPORT palpateTargets NAMESPACE palpate:: DESTINATION ${config})
write_basic_package_version_file(palpateConfigVersion.cmake COMPATIBILITY SameMinorVersion)
configure_file(cmake/palpateConfig.cmake palpateConfig.cmake @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/palpateConfig.cmake cmake/packages.cmake ${CMAKE_CURRENT_BINARY_DIR}/palpateConfigVersion.cmake
        DESTINATION ${config})
