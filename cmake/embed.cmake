# runstone_embed(server/web page/map.js page/map.css)
# compiles files into a module, byte for byte. The function runstone::map_js() returns the bytes of
# page/map.js. A header of the module declares it: std::string_view map_js();
function(runstone_embed folder)
  runstone_target_name(${folder} target)
  foreach(file ${ARGN})
    set(from ${PROJECT_SOURCE_DIR}/${folder}/${file})
    set(to ${PROJECT_BINARY_DIR}/embedded/${folder}/${file}.cpp)
    cmake_path(GET file FILENAME name)
    string(MAKE_C_IDENTIFIER ${name} name)
    add_custom_command(OUTPUT ${to}
      COMMAND ${CMAKE_COMMAND} -DFROM=${from} -DTO=${to} -DNAME=${name} -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
      DEPENDS ${from} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
    set_source_files_properties(${to} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE ${to})
  endforeach()
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  file(READ ${FROM} bytes HEX)
  string(REGEX REPLACE ".." "\\\\x\\0" bytes "${bytes}")
  file(WRITE ${TO} "#include <string_view>

namespace runstone {
std::string_view ${NAME}();
std::string_view ${NAME}() {
  static constexpr char kBytes[] = \"${bytes}\";
  return {kBytes, sizeof kBytes - 1};
}
}  // namespace runstone
")
endif()
