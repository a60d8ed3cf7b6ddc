# find_package(gnomon) then gives gnomon::engine, gnomon::passes, gnomon::bench and gnomon::tools (the command line);
# shaders, graphs, scenes and suites go to share/gnomon.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
install(TARGETS gnomon_engine gnomon_passes gnomon_bench gnomon_tools EXPORT gnomonTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        OBJECTS DESTINATION ${CMAKE_INSTALL_LIBDIR}/gnomon)
install(TARGETS gnomon RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
set_target_properties(gnomon_engine PROPERTIES EXPORT_NAME engine)
set_target_properties(gnomon_passes PROPERTIES EXPORT_NAME passes)
set_target_properties(gnomon_bench PROPERTIES EXPORT_NAME bench)
set_target_properties(gnomon_tools PROPERTIES EXPORT_NAME tools)
install(EXPORT gnomonTargets NAMESPACE gnomon:: DESTINATION ${package_dir})

install(DIRECTORY engine passes bench tools DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon FILES_MATCHING PATTERN "*.h")
install(DIRECTORY shaders assets DESTINATION ${CMAKE_INSTALL_DATADIR}/gnomon)
install(DIRECTORY bench/suites DESTINATION ${CMAKE_INSTALL_DATADIR}/gnomon/bench)
install(DIRECTORY tools/report DESTINATION ${CMAKE_INSTALL_DATADIR}/gnomon/tools)

configure_package_config_file(cmake/gnomonConfig.cmake.in ${PROJECT_BINARY_DIR}/gnomonConfig.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gnomonConfig.cmake ${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake
        DESTINATION ${package_dir})
