# Tests that the schema conforms to the frozen schemas of earlier protocol versions: fields may be added at the end of a
# table and members at the end of a union. Nothing may move, change its type or be removed.
file(GLOB frozen CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/protocol/schema/frozen/*.fbs)
foreach(schema ${frozen})
  get_filename_component(version ${schema} NAME_WE)
  add_test(NAME schema.conforms_to_${version}
           COMMAND flatbuffers::flatc --conform ${schema} ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs)
endforeach()

# Tests the check itself: a schema with two swapped fields must fail it.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs)
file(READ ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs text)
string(REPLACE "table Durable { epoch:uint; seq:ulong; }" "table Durable { seq:ulong; epoch:uint; }" broken "${text}")
if(broken STREQUAL text)
  message(FATAL_ERROR "protocol/schema/conform.cmake swaps fields that the schema no longer has")
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/runstone_broken.fbs CONTENT "${broken}" @ONLY)
add_test(NAME schema.swapped_fields_are_noticed
         COMMAND flatbuffers::flatc --conform ${PROJECT_SOURCE_DIR}/protocol/schema/frozen/runstone_v1.fbs
                 ${PROJECT_BINARY_DIR}/runstone_broken.fbs)
set_tests_properties(schema.swapped_fields_are_noticed PROPERTIES WILL_FAIL TRUE)
