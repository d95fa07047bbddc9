# Every dependency is a Debian 12 package; scripts/packages lists them by name.
set(runstone_highway hwy::hwy)
if(EMSCRIPTEN)
  enable_language(C)
  include(cmake/web_packages.cmake)
  return()
endif()
if(RUNSTONE_HIGHWAY_HEADERS)
  # Links, because the folder may have headers of another system beside those of Highway.
  if(NOT EXISTS ${RUNSTONE_HIGHWAY_HEADERS}/hwy/highway.h)
    message(FATAL_ERROR "RUNSTONE_HIGHWAY_HEADERS is ${RUNSTONE_HIGHWAY_HEADERS}, which has no hwy/highway.h")
  endif()
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/highway-headers)
  file(CREATE_LINK ${RUNSTONE_HIGHWAY_HEADERS}/hwy ${PROJECT_BINARY_DIR}/highway-headers/hwy SYMBOLIC)
  add_library(runstone_highway INTERFACE)
  target_include_directories(runstone_highway SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/highway-headers)
  # The vector code is compiled once, so no code of Highway chooses at run time.
  target_compile_definitions(runstone_highway INTERFACE HWY_COMPILE_ONLY_STATIC)
  add_library(hwy::hwy ALIAS runstone_highway)
  set(runstone_highway $<BUILD_INTERFACE:hwy::hwy>)  # programs do not link it
else()
  find_package(hwy REQUIRED CONFIG)
endif()
if(RUNSTONE_LIBRARY_ONLY)
  find_package(zstd CONFIG QUIET)
  return()
endif()
enable_language(C)  # the OpenGL loader
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(FlatBuffers 2.0.8 REQUIRED CONFIG)
find_package(spdlog 1.10 REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(SQLite3 REQUIRED)
find_package(OpenSSL 3.0 REQUIRED)
find_package(zstd REQUIRED CONFIG)
find_package(ZLIB REQUIRED)
find_package(PNG REQUIRED)  # reads height maps
find_package(assimp 5.2 REQUIRED CONFIG)  # of runstone-read-model alone
find_package(CLI11 REQUIRED CONFIG)
find_package(tomlplusplus REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
pkg_check_modules(PQ REQUIRED IMPORTED_TARGET libpq)
pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(DEFLATE REQUIRED IMPORTED_TARGET libdeflate)
pkg_check_modules(UTF8PROC REQUIRED IMPORTED_TARGET libutf8proc)
pkg_check_modules(ICU REQUIRED IMPORTED_TARGET icu-i18n)

# Reads maps of Luanti. Its CMake file also asks for the files to build with Snappy, which the shared library
# links itself and Debian's package does not depend on.
find_library(LEVELDB_LIBRARY leveldb REQUIRED)
find_path(LEVELDB_INCLUDE_DIR leveldb/db.h REQUIRED)
add_library(runstone_leveldb UNKNOWN IMPORTED)
set_target_properties(runstone_leveldb PROPERTIES IMPORTED_LOCATION ${LEVELDB_LIBRARY}
                      INTERFACE_INCLUDE_DIRECTORIES ${LEVELDB_INCLUDE_DIR})

# Asio 1.22 comes without a CMake file, and keeps coroutines off under clang unless told otherwise.
find_path(ASIO_INCLUDE_DIR asio.hpp REQUIRED)
add_library(runstone_asio STATIC cmake/asio.cpp)
target_include_directories(runstone_asio SYSTEM PUBLIC ${ASIO_INCLUDE_DIR})
# ASIO_HAS_STD_ALIGNED_ALLOC: left alone, Asio decides by whether a standard header came before it,
# so translation units disagree on how the memory of an operation is freed.
# ASIO_SEPARATE_COMPILATION: a unit that uses Asio compiles in five sixths of the time.
target_compile_definitions(runstone_asio PUBLIC ASIO_STANDALONE ASIO_SEPARATE_COMPILATION ASIO_NO_DEPRECATED
                           ASIO_HAS_STD_ALIGNED_ALLOC=1)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_definitions(runstone_asio PUBLIC ASIO_HAS_CO_AWAIT=1 ASIO_HAS_STD_COROUTINE=1)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 pairs Asio's recycled coroutine frames with the wrong delete in this warning (false
  # positive).
  target_compile_options(runstone_asio PUBLIC $<$<COMPILE_LANGUAGE:CXX>:-Wno-mismatched-new-delete>)
endif()
target_link_libraries(runstone_asio PUBLIC Threads::Threads)

# Boost is used for Beast, with the Asio that is part of it. Its types never meet those of the
# standalone Asio.
find_package(Boost 1.74 REQUIRED)
find_package(prometheus-cpp REQUIRED CONFIG)
add_library(runstone_beast INTERFACE)
target_compile_definitions(runstone_beast INTERFACE BOOST_ASIO_NO_DEPRECATED BOOST_ASIO_HAS_STD_ALIGNED_ALLOC=1)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_definitions(runstone_beast INTERFACE BOOST_ASIO_HAS_CO_AWAIT=1 BOOST_ASIO_HAS_STD_COROUTINE=1)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(runstone_beast INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-mismatched-new-delete>)
endif()
target_link_libraries(runstone_beast INTERFACE Boost::headers OpenSSL::SSL OpenSSL::Crypto Threads::Threads)

if(RUNSTONE_TESTS)
  find_package(Catch2 2.13 REQUIRED CONFIG)
  if(RUNSTONE_BENCH)
    find_package(benchmark 1.7 REQUIRED CONFIG)
  endif()
endif()
