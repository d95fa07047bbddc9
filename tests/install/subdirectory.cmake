# Configures a C++17 project that takes Runstone with add_subdirectory(), and builds and runs its
# program. Every package but Highway is hidden from it.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})

set(hidden "")
foreach(package Threads PkgConfig FlatBuffers spdlog fmt SQLite3 zstd CLI11 tomlplusplus nlohmann_json Catch2 benchmark
        ZLIB glfw3 glm)
  list(APPEND hidden -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/parent -B ${WORK} -G ${GENERATOR} -DRUNSTONE=${SOURCE}
    -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" ${hidden})
run(${CMAKE_COMMAND} --build ${WORK} --target count_runs)
run(${WORK}/count_runs)
expect("3 runs")
file(REMOVE_RECURSE ${WORK})
