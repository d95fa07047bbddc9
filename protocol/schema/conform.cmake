# Tests that the schema conforms to the frozen schemas of released protocol versions: fields may be
# added at the end of a table and kinds at the end of the enum Kind. Nothing may move or change its
# type. tests/unit/protocol/codec/frozen_schema_test.cpp checks that nothing is removed.
file(GLOB frozen CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/protocol/schema/frozen/*.fbs)
foreach(schema ${frozen})
  get_filename_component(version ${schema} NAME_WE)
  add_test(NAME schema.conforms_to_${version}
           COMMAND flatbuffers::flatc --conform ${schema}
                   ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs)
endforeach()

# Tests the check itself: a schema in which `from` is replaced by `to` must fail it.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
             ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs)
function(runstone_check_conform_notices what from to)
  file(READ ${PROJECT_SOURCE_DIR}/protocol/schema/runstone.fbs text)
  string(REPLACE "${from}" "${to}" broken "${text}")
  if(broken STREQUAL text)
    message(FATAL_ERROR "protocol/schema/conform.cmake changes what the schema does not have: ${from}")
  endif()
  set(file ${PROJECT_BINARY_DIR}/runstone_${what}.fbs)
  file(CONFIGURE OUTPUT ${file} CONTENT "${broken}" @ONLY)
  add_test(NAME schema.${what}_are_noticed
           COMMAND flatbuffers::flatc --conform
                   ${PROJECT_SOURCE_DIR}/protocol/schema/frozen/runstone_v2.fbs ${file})
  set_tests_properties(schema.${what}_are_noticed PROPERTIES WILL_FAIL TRUE)
endfunction()
runstone_check_conform_notices(swapped_fields "table Durable { epoch:uint; seq:ulong; is_read_only:bool; }"
                               "table Durable { seq:ulong; epoch:uint; is_read_only:bool; }")
runstone_check_conform_notices(renumbered_kinds "Hello = 1, Welcome = 2," "Welcome = 1, Hello = 2,")
