# Installs the libraries of a build into a prefix, moves the prefix, and builds the examples against
# it in a clean folder: once by find_package(), once by pkg-config.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})

run(${CMAKE_COMMAND} --install ${BUILD} --component runstone --prefix ${WORK}/installed)
run(${CMAKE_COMMAND} --install ${BUILD} --component runstone_c --prefix ${WORK}/installed)
file(RENAME ${WORK}/installed ${WORK}/prefix)

run(${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build --no-tests=error)
set(tests 4)
set(has_client OFF)
if(EXISTS ${WORK}/prefix/include/runstone/client/api/world_client.hpp)
  set(tests 5)
  set(has_client ON)
  expect("examples.join_and_edit")
endif()
expect("examples.array_to_quads" "examples.edit_layers" "examples.walk_on_runs" "examples.c_hill"
       "100% tests passed, 0 tests failed out of ${tests}")

# No flag of this project reaches the user, and no header of the source tree does.
file(READ ${WORK}/build/compile_commands.json output)
expect("${WORK}/prefix/include/runstone")
foreach(text "-Wconversion" "-Werror" "-ffp-contract" "-I${SOURCE}" "${SOURCE}/common")
  string(FIND "${output}" "${text}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${text} reaches a user of the installed libraries:\n${output}")
  endif()
endforeach()

# pkg-config names all that a compiler needs.
find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB folders ${WORK}/prefix/*/pkgconfig ${WORK}/prefix/*/*/pkgconfig)
set(ENV{PKG_CONFIG_PATH} ${folders})
run(${PKG_CONFIG} --cflags --libs runstone-edits)
separate_arguments(options UNIX_COMMAND "${FLAGS} ${output}")
run(${COMPILER} -std=c++20 ${SOURCE}/examples/edit_layers.cpp -o ${WORK}/edit_layers ${options})
run(${WORK}/edit_layers)
expect("voxels changed")

# The client joins a server, once as CMake has built it and once as pkg-config says.
if(has_client)
  run(${PKG_CONFIG} --cflags --libs runstone-client)
  separate_arguments(options UNIX_COMMAND "${FLAGS} ${output}")
  run(${COMPILER} -std=c++20 ${SOURCE}/examples/join_and_edit.cpp -o ${WORK}/join_and_edit ${options})
  file(GLOB_RECURSE headers ${WORK}/prefix/include/runstone/client/*)
  foreach(header ${headers})
    file(READ ${header} output)
    if(output MATCHES "#include [<\"](asio|spdlog|openssl|GL|client/[^a]|protocol)")
      message(FATAL_ERROR "${header} includes ${CMAKE_MATCH_1}")
    endif()
  endforeach()
  foreach(program ${WORK}/build/example-join-and-edit ${WORK}/join_and_edit)
    run(${CMAKE_CURRENT_LIST_DIR}/join_server.sh ${BUILD}/bin/runstone-server ${program} ${WORK})
    expect("quads" "the edit is number ")
  endforeach()
endif()

# The C interface needs a C compiler alone.
run(${PKG_CONFIG} --cflags --libs runstone-c)
separate_arguments(options UNIX_COMMAND "${output}")
find_program(C_COMPILER NAMES cc gcc clang REQUIRED)
run(${C_COMPILER} -std=c99 -pedantic -Wall -Wextra -Werror ${SOURCE}/examples/c/hill.c -o ${WORK}/hill ${options})
cmake_path(GET folders PARENT_PATH libraries)
set(ENV{LD_LIBRARY_PATH} ${libraries})
run(${WORK}/hill)
expect("6528 voxels of stone")

# CMake finds it without the packages that the C++ libraries need.
set(without -DCMAKE_DISABLE_FIND_PACKAGE_hwy=ON -DCMAKE_DISABLE_FIND_PACKAGE_zstd=ON)
foreach(components "" "COMPONENTS c")
  string(MD5 folder "${components}")
  file(WRITE ${WORK}/${folder}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(hill LANGUAGES C)
find_package(runstone 0.2 REQUIRED ${components})
if(TARGET runstone::runs)
  message(FATAL_ERROR \"a library was found without its dependencies\")
endif()
add_executable(hill ${SOURCE}/examples/c/hill.c)
target_link_libraries(hill PRIVATE runstone::c)
")
  run(${CMAKE_COMMAND} -S ${WORK}/${folder} -B ${WORK}/${folder}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
      ${without})
  run(${CMAKE_COMMAND} --build ${WORK}/${folder}/build)
  run(${WORK}/${folder}/build/hill)
  expect("6528 voxels of stone")
endforeach()
file(REMOVE_RECURSE ${WORK})
