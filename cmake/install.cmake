# What `cmake --install` puts into a prefix: the libraries for embedders, their headers below
# include/runstone, a package file for find_package(runstone) and one pkg-config file per library.
# docs/library.md describes their use.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(runstone_includes ${CMAKE_INSTALL_INCLUDEDIR}/runstone)
set(runstone_package ${CMAKE_INSTALL_LIBDIR}/cmake/runstone)
# From lib/pkgconfig up to the prefix: the files hold no absolute path, so that the prefix can be
# moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY
           ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig OUTPUT_VARIABLE runstone_prefix_from_pc)

# runstone_installed(runs REQUIRES core DESCRIPTION "...")
# makes runstone::runs of the module common/runs, installed or not. REQUIRES are the pkg-config
# names it needs, where a name without a dash is one of these libraries.
function(runstone_installed library)
  cmake_parse_arguments(ARG "" "DESCRIPTION" "REQUIRES" ${ARGN})
  set(target runstone_common_${library})
  add_library(runstone::${library} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${library} OUTPUT_NAME runstone_${library})
  if(NOT RUNSTONE_INSTALL)
    return()
  endif()
  install(TARGETS ${target} EXPORT runstone COMPONENT runstone
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runstone
          FILE_SET HEADERS DESTINATION ${runstone_includes} COMPONENT runstone)
  list(JOIN ARG_REQUIRES ", " requires)
  set(description "${ARG_DESCRIPTION}")
  configure_file(${PROJECT_SOURCE_DIR}/cmake/runstone.pc.in runstone-${library}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/runstone-${library}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT runstone)
endfunction()

runstone_installed(core DESCRIPTION "positions, bytes, digests and results")
runstone_installed(runs REQUIRES runstone-core DESCRIPTION "voxel chunks stored as runs of one material")
runstone_installed(rights DESCRIPTION "roles, bans and protected boxes" REQUIRES runstone-core)
runstone_installed(shapes DESCRIPTION "the surface of voxels that are no cubes" REQUIRES runstone-core)
runstone_installed(edits REQUIRES runstone-rights runstone-runs runstone-shapes libhwy DESCRIPTION "edits of run chunks and the layers they change")
runstone_installed(collision REQUIRES runstone-runs DESCRIPTION "boxes that move through run chunks")
runstone_installed(mesh REQUIRES runstone-runs runstone-shapes libhwy DESCRIPTION "quads from run chunks")

if(RUNSTONE_INSTALL)
  install(EXPORT runstone NAMESPACE runstone:: DESTINATION ${runstone_package} COMPONENT runstone
          FILE runstone-targets.cmake)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/runstone-config.cmake.in runstone-config.cmake
                                INSTALL_DESTINATION ${runstone_package})
  write_basic_package_version_file(runstone-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/runstone-config.cmake
                ${CMAKE_CURRENT_BINARY_DIR}/runstone-config-version.cmake
          DESTINATION ${runstone_package} COMPONENT runstone)
endif()
