// Calls of runstone.h that do not fail: versions and errors.
#include <array>

#include "bindings/c/refusal.hpp"
#include "bindings/c/runstone.h"
#include "common/core/version.hpp"

uint32_t runstone_abi(void) { return RUNSTONE_ABI; }

const char* runstone_version(void) { return runstone::version().data(); }

const char* runstone_last_error(void) { return runstone::c_interface::kept_words(); }

const char* runstone_status_name(runstone_status status) {
  static constexpr std::array kNames = {"ok",
                                        "truncated",
                                        "trailing bytes",
                                        "not canonical",
                                        "bad value",
                                        "bad version",
                                        "limit exceeded",
                                        "bad checksum",
                                        "broken invariant",
                                        "unknown kind",
                                        "not found",
                                        "io failed",
                                        "not permitted",
                                        "bad argument",
                                        "bad handle",
                                        "buffer too small",
                                        "not enough memory",
                                        "damaged",
                                        "internal",
                                        "unsupported"};
  static_assert(kNames.size() == RUNSTONE_UNSUPPORTED + 1);
  if (status < 0 || status > RUNSTONE_UNSUPPORTED) return "unknown status";
  return kNames[static_cast<std::size_t>(status)];
}
