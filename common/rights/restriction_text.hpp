// The end and the reason of a restriction as text.
#pragma once
#include <string>

#include "common/core/utc_text.hpp"
#include "common/rights/rights_change.hpp"

namespace runstone {

/// Returns `what` with the end and the reason of the restriction, as far as it has them, such as
/// "you are banned until 2026-12-01T00:00:00Z: griefing".
inline std::string restriction_text(std::string what, const Restrict& restriction) {
  if (restriction.until_us != 0) what += " until " + utc_text(restriction.until_us);
  if (!restriction.reason.empty()) what += ": " + restriction.reason;
  return what;
}

}  // namespace runstone
