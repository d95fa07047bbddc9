# Writes OUT, a header that names the commit the sources in SOURCE stand at, "-dirty" if what the
# benchmarks are made of differs from it; leaves the file alone if nothing moved.
execute_process(COMMAND git rev-parse --short HEAD WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
else()
  execute_process(COMMAND git diff --quiet HEAD -- common protocol process server client bench tests/support
                  WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE differs)
  if(differs)
    string(APPEND commit -dirty)
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#pragma once
namespace runstone::bench {
inline constexpr const char* kCommit = "@commit@";
}
]])
