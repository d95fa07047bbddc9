# The libraries of the browser client (preset web), under the names that the rooms link. Debian has
# them for the machine's own processor only.
#   - What is headers alone is used as Debian installs it, through links: the folder /usr/include has
#     other headers too, which are not those of Emscripten.
#   - The others are compiled again from Debian's sources (scripts/web-sources).
set(web_include ${PROJECT_BINARY_DIR}/native-headers)
file(MAKE_DIRECTORY ${web_include})
foreach(name flatbuffers fmt glm hwy nlohmann stb toml++ xxhash.h)
  if(NOT EXISTS /usr/include/${name})
    message(FATAL_ERROR "/usr/include/${name} is missing; scripts/packages lists the packages of the sets build and web")
  endif()
  file(CREATE_LINK /usr/include/${name} ${web_include}/${name} SYMBOLIC)
endforeach()
add_library(runstone_native_headers INTERFACE)
target_include_directories(runstone_native_headers SYSTEM INTERFACE ${web_include})

function(web_headers name)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${name} INTERFACE runstone_native_headers)
endfunction()
web_headers(hwy::hwy)
web_headers(flatbuffers::flatbuffers)
web_headers(glm::glm)
web_headers(nlohmann_json::nlohmann_json)
web_headers(tomlplusplus::tomlplusplus)
web_headers(fmt::fmt)
set_property(TARGET fmt::fmt PROPERTY INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY)
web_headers(PkgConfig::XXHASH)
set_property(TARGET PkgConfig::XXHASH PROPERTY INTERFACE_COMPILE_DEFINITIONS XXH_INLINE_ALL)
# One thread: what others run in threads, the browser client runs in slices of a frame.
add_library(Threads::Threads INTERFACE IMPORTED GLOBAL)
find_program(FLATC flatc REQUIRED)
add_executable(flatbuffers::flatc IMPORTED GLOBAL)
set_target_properties(flatbuffers::flatc PROPERTIES IMPORTED_LOCATION ${FLATC})

set(web_sources ${PROJECT_BINARY_DIR}/library-sources)
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/web-sources ${web_sources} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "scripts/web-sources could not fetch the sources of Dear ImGui, libsodium, zstd and utf8proc")
endif()

# Makes NAME of sources in C or C++. HEADERS is the folder that its users include from.
function(web_library name alias)
  cmake_parse_arguments(ARG "" "" "SOURCES;HEADERS;PRIVATE_HEADERS;DEFINITIONS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  target_include_directories(${name} SYSTEM PUBLIC ${ARG_HEADERS} PRIVATE ${ARG_PRIVATE_HEADERS})
  target_compile_definitions(${name} PRIVATE ${ARG_DEFINITIONS})
  target_compile_options(${name} PRIVATE -w)
  add_library(${alias} ALIAS ${name})
endfunction()

file(GLOB zstd_sources ${web_sources}/libzstd/lib/common/*.c ${web_sources}/libzstd/lib/compress/*.c
     ${web_sources}/libzstd/lib/decompress/*.c)
web_library(web_zstd zstd::libzstd_shared SOURCES ${zstd_sources} HEADERS ${web_sources}/libzstd/lib
            DEFINITIONS ZSTD_DISABLE_ASM ZSTD_LEGACY_SUPPORT=0)

# Its header with the version is made by its own build; Debian's package has the same version.
file(COPY /usr/include/sodium/version.h DESTINATION ${web_sources}/libsodium/src/libsodium/include/sodium)
# The parts of libsodium for processors without special instructions. Parts that no code here calls
# are left out, because each file costs a start of Emscripten.
file(GLOB_RECURSE sodium_sources ${web_sources}/libsodium/src/libsodium/*.c)
list(FILTER sodium_sources EXCLUDE REGEX "(avx|sse|neon|aesni|_xmm|sandy2x)")
list(FILTER sodium_sources EXCLUDE REGEX "/crypto_(auth|box|kdf|kx|secretbox|secretstream|shorthash)/|scryptsalsa")
list(FILTER sodium_sources EXCLUDE REGEX "hsalsa20|salsa20(8|12)|xsalsa20\\.c|/core_(ed25519|ristretto255)\\.c|/scalarmult_(ed25519|ristretto255)_ref10")
list(FILTER sodium_sources EXCLUDE REGEX "/(crypto_hash|crypto_scalarmult|crypto_stream|obsolete)\\.c|/sha256/")
web_library(web_sodium PkgConfig::SODIUM SOURCES ${sodium_sources}
            HEADERS ${web_sources}/libsodium/src/libsodium/include
            PRIVATE_HEADERS ${web_sources}/libsodium/src/libsodium/include/sodium
            DEFINITIONS CONFIGURED=1 SODIUM_STATIC NATIVE_LITTLE_ENDIAN=1 HAVE_WEAK_SYMBOLS=1)

web_library(web_utf8proc PkgConfig::UTF8PROC SOURCES ${web_sources}/utf8proc/utf8proc.c HEADERS ${web_sources}/utf8proc
            DEFINITIONS UTF8PROC_STATIC)
target_compile_definitions(web_utf8proc PUBLIC UTF8PROC_STATIC)

set(imgui ${web_sources}/imgui)
web_library(web_imgui PkgConfig::IMGUI
            SOURCES ${imgui}/imgui.cpp ${imgui}/imgui_draw.cpp ${imgui}/imgui_tables.cpp ${imgui}/imgui_widgets.cpp
                    ${imgui}/misc/cpp/imgui_stdlib.cpp
            HEADERS ${imgui} ${imgui}/misc/cpp DEFINITIONS IMGUI_DISABLE_DEMO_WINDOWS IMGUI_DISABLE_METRICS_WINDOW)
