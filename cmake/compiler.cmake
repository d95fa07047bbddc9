# Flags of every target of this project. None of them reaches a project that links the libraries.

if(PROJECT_IS_TOP_LEVEL)
  find_program(CCACHE_PROGRAM ccache)
  if(CCACHE_PROGRAM)
    # Paths below the source folder are hashed as relative ones, so that all clones on a machine
    # share the cache.
    set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
        CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
    set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  endif()
  find_program(MOLD_PROGRAM mold)
  if(MOLD_PROGRAM AND NOT EMSCRIPTEN)
    add_link_options(-fuse-ld=mold)
  endif()
  add_compile_options(
    $<$<COMPILE_LANGUAGE:CXX>:-Wall> $<$<COMPILE_LANGUAGE:CXX>:-Wextra> $<$<COMPILE_LANGUAGE:CXX>:-Wpedantic>
    $<$<COMPILE_LANGUAGE:CXX>:-Wshadow> $<$<COMPILE_LANGUAGE:CXX>:-Wconversion> $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()

# Fused multiply-add changes the last bit of floats between compilers and CPUs; worlds must not
# depend on it.
add_compile_options(-ffp-contract=off)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ collects garbage once a unit has 128 MiB. Most units of a unity build need ten times that,
  # so each is compiled 6 % faster if the first collection comes later.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=524288>)
  # g++ 12 reports overlapping copies in std::string where there are none (gcc bug 105651).
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
  # In a unity build g++ takes a .cpp for a header, where a member's type may not be of an unnamed
  # namespace. The preset debug compiles each file alone and keeps this warning.
  add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wno-subobject-linkage>)
endif()

if(EMSCRIPTEN)
  # All browsers with WebGL 2 and SIMD run the same code, so Highway needs no choice at run time.
  add_compile_options(-msimd128 -mbulk-memory)
  add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
  # The library of Emscripten 3.1 has no <=> for arrays, so some defaulted operators do not exist
  # there. Its difference_type is narrower than that of 64-bit machines, where indices fit.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-defaulted-function-deleted> $<$<COMPILE_LANGUAGE:CXX>:-Wno-sign-conversion>)
endif()

if(RUNSTONE_SANITIZE)
  add_compile_options(-fsanitize=${RUNSTONE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${RUNSTONE_SANITIZE})
  # Vector code is compiled for one instruction set: to instrument all of them takes minutes. On
  # x86-64 that set is AVX2, which Highway selects only with all of these flags. Without them it
  # would be the scalar set, and no vector code would be checked.
  add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
  # For tests whose figures or times a sanitizer changes.
  add_compile_definitions(RUNSTONE_SANITIZED)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    add_compile_options(-mavx2 -mbmi -mbmi2 -mfma -mf16c -mlzcnt -maes -mpclmul)
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options(-fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/cmake/undefined_behaviour_ignored.txt)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False positives of g++ 12 under AddressSanitizer: coroutine frames with a mismatched delete,
    # and vectors in the variant of an edit that count as uninitialised.
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-mismatched-new-delete>
                        $<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>)
  endif()
endif()

if(RUNSTONE_FUZZ)
  # Coverage for libFuzzer in every library; only the fuzz targets link its main.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link>)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
