# Writes OUT, a header that names the commit the sources in SOURCE stand at; leaves it alone if nothing moved.
execute_process(COMMAND git describe --always --dirty --exclude=* WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} @ONLY CONTENT [[
#pragma once
namespace runstone::bench {
inline constexpr const char* kCommit = "@commit@";
}
]])
