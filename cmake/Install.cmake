# `cmake --install`: the command with its scenes, and the libraries, which
# find_package(myowave) gives as myowave::kernels and myowave::solver.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# The headers include each other by paths from the project's root, so they are installed in their own folder.
install(TARGETS myowave_kernels myowave_solver EXPORT myowave
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/myowave)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/myowave)
install(EXPORT myowave NAMESPACE myowave:: FILE myowaveTargets.cmake DESTINATION ${package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/myowaveConfig.cmake.in
  ${PROJECT_BINARY_DIR}/generated/myowaveConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/myowaveConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/myowaveConfig.cmake
              ${PROJECT_BINARY_DIR}/generated/myowaveConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCHOLMOD.cmake DESTINATION ${package})

if(MYOWAVE_APPS)
  # Kokkos may be in .deps/, and CMake does not count folders inside the project as link paths.
  set_target_properties(myowave PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON
                        INSTALL_RPATH "$<TARGET_FILE_DIR:Kokkos::kokkoscore>")
  install(TARGETS myowave)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/apps/scenes
          DESTINATION ${CMAKE_INSTALL_DATADIR}/myowave FILES_MATCHING PATTERN *.toml)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff ${PROJECT_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
