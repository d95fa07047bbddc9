# runstone::client: one archive with the code of client/api and of all rooms below it that are not
# installed as libraries of their own. Its headers are the headers of client/api that include no
# other room of the client.

# Sets `out` to the static libraries of this project that a target links, itself included, but those
# that are installed.
function(runstone_library_parts target out)
  set(parts "")
  set(waiting ${target})
  while(waiting)
    list(POP_FRONT waiting part)
    get_target_property(type ${part} TYPE)
    get_target_property(installed ${part} EXPORT_NAME)
    if(NOT type STREQUAL STATIC_LIBRARY OR installed OR part IN_LIST parts)
      continue()
    endif()
    list(APPEND parts ${part})
    get_target_property(links ${part} LINK_LIBRARIES)
    foreach(link ${links})
      if(link MATCHES "^runstone_" AND TARGET ${link})
        list(APPEND waiting ${link})
      endif()
    endforeach()
  endwhile()
  set(${out} ${parts} PARENT_SCOPE)
endfunction()

runstone_library_parts(runstone_client_api parts)
list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>")
add_library(runstone_client STATIC ${parts})
add_library(runstone::client ALIAS runstone_client)
set_target_properties(runstone_client PROPERTIES EXPORT_NAME client LINKER_LANGUAGE CXX)
target_compile_features(runstone_client PUBLIC cxx_std_20)
target_sources(runstone_client PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES
  ${PROJECT_SOURCE_DIR}/client/api/mesh_source.hpp ${PROJECT_SOURCE_DIR}/client/api/world_client.hpp
  ${PROJECT_SOURCE_DIR}/client/api/world_client_options.hpp ${PROJECT_SOURCE_DIR}/client/api/world_event.hpp)
# Another project has no targets for the packages of pkg-config.
target_link_libraries(runstone_client
  PUBLIC runstone_common_edits runstone_common_collision runstone_common_tiles runstone_protocol_chunks
  INTERFACE $<LINK_ONLY:OpenSSL::SSL> $<LINK_ONLY:OpenSSL::Crypto> $<LINK_ONLY:SQLite::SQLite3> $<LINK_ONLY:Threads::Threads>
            "$<BUILD_INTERFACE:$<LINK_ONLY:PkgConfig::SODIUM>;$<LINK_ONLY:PkgConfig::XXHASH>;$<LINK_ONLY:PkgConfig::UTF8PROC>;$<LINK_ONLY:tomlplusplus::tomlplusplus>>"
            "$<INSTALL_INTERFACE:sodium;xxhash;utf8proc;tomlplusplus>")
if(NOT RUNSTONE_INSTALL)
  return()
endif()
install(TARGETS runstone_client EXPORT runstone-client COMPONENT runstone
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runstone
        FILE_SET HEADERS DESTINATION ${runstone_includes} COMPONENT runstone)
runstone_install_pc(client "the networked replica of a world" "-I\${prefix}/${runstone_includes}" runstone_client
                    runstone-edits runstone-collision runstone-tiles runstone-codec openssl sqlite3 libsodium
                    libxxhash libutf8proc tomlplusplus)
runstone_install_export(runstone-client)
