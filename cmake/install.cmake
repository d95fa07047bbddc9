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
# makes runstone::runs of the module common/runs, or of MODULE, installed or not. REQUIRES are the pkg-config
# names it needs. EXPORT is the file of targets that names it: a library with a dependency of its own has its
# own file, so that programs without that dependency can use the others.
function(runstone_installed library)
  cmake_parse_arguments(ARG "" "DESCRIPTION;MODULE;EXPORT" "REQUIRES" ${ARGN})
  if(NOT ARG_MODULE)
    set(ARG_MODULE common/${library})
  endif()
  if(NOT ARG_EXPORT)
    set(ARG_EXPORT runstone)
  endif()
  runstone_target_name(${ARG_MODULE} target)
  add_library(runstone::${library} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${library} OUTPUT_NAME runstone_${library})
  if(NOT RUNSTONE_INSTALL)
    return()
  endif()
  install(TARGETS ${target} EXPORT ${ARG_EXPORT} COMPONENT runstone
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runstone
          FILE_SET HEADERS DESTINATION ${runstone_includes} COMPONENT runstone)
  runstone_install_pc(${library} "${ARG_DESCRIPTION}" "-I\${prefix}/${runstone_includes}" runstone_${library}
                      ${ARG_REQUIRES})
endfunction()

# Installs runstone-LIBRARY.pc, for a library file and the pkg-config names that it needs.
function(runstone_install_pc library description flags file)
  list(JOIN ARGN ", " requires)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/runstone.pc.in runstone-${library}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/runstone-${library}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT runstone)
endfunction()

# Installs the targets of an export as runstone::NAME.
function(runstone_install_export export)
  install(EXPORT ${export} NAMESPACE runstone:: DESTINATION ${runstone_package} COMPONENT runstone
          FILE ${export}-targets.cmake)
endfunction()

# A build with the headers of Highway alone needs no library of it.
if(RUNSTONE_HIGHWAY_HEADERS)
  set(runstone_needs_highway OFF)
  set(highway_pc "")
else()
  set(runstone_needs_highway ON)
  set(highway_pc libhwy)
endif()
runstone_installed(core DESCRIPTION "positions, bytes, digests and results")
runstone_installed(runs REQUIRES runstone-core DESCRIPTION "voxel chunks stored as runs of one material")
runstone_installed(rights DESCRIPTION "roles, bans and protected boxes" REQUIRES runstone-core)
runstone_installed(edits REQUIRES runstone-rights runstone-runs ${highway_pc} DESCRIPTION "edits of run chunks and the layers they change")
runstone_installed(shapes REQUIRES runstone-core DESCRIPTION "voxels that are no cubes: boxes and their surface")
runstone_installed(collision REQUIRES runstone-runs runstone-shapes DESCRIPTION "boxes that move through run chunks")
runstone_installed(mesh REQUIRES runstone-runs runstone-shapes ${highway_pc} DESCRIPTION "quads from run chunks")
runstone_installed(veil REQUIRES runstone-mesh DESCRIPTION "chunks without what nobody can see")
runstone_installed(tiles REQUIRES runstone-veil DESCRIPTION "levels of detail of run chunks")
if(TARGET runstone_protocol_chunks)
  runstone_installed(codec MODULE protocol/chunks EXPORT runstone-codec REQUIRES runstone-runs libzstd
                     DESCRIPTION "bytes of run chunks on wire and disk")
endif()
if(TARGET runstone_bindings_c)
  add_library(runstone::c ALIAS runstone_bindings_c)
  set_target_properties(runstone_bindings_c PROPERTIES EXPORT_NAME c)
endif()

if(RUNSTONE_INSTALL)
  runstone_install_export(runstone)
  if(TARGET runstone_protocol_chunks)
    runstone_install_export(runstone-codec)
  endif()
  if(TARGET runstone_bindings_c)
    # The library is a component of its own, because programs need it without the files for compilers.
    install(TARGETS runstone_bindings_c EXPORT runstone-c
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runstone_c NAMELINK_COMPONENT runstone
            FILE_SET c_headers DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT runstone)
    runstone_install_pc(c "the C interface" "-I\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}" runstone)
    runstone_install_export(runstone-c)
  endif()
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/runstone-config.cmake.in runstone-config.cmake
                                INSTALL_DESTINATION ${runstone_package})
  write_basic_package_version_file(runstone-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/runstone-config.cmake
                ${CMAKE_CURRENT_BINARY_DIR}/runstone-config-version.cmake
          DESTINATION ${runstone_package} COMPONENT runstone)
endif()
