// runstone-replay --keyframes: makes the keyframes that a world lacks, while no server runs it.
#pragma once
#include <iosfwd>
#include <string>

#include "server/history/keyframe_maker.hpp"

namespace runstone {

struct KeyframesRequest {
  std::string world;  // folder
  KeyframePolicy policy;
  bool progress = false;  // also where stderr is no terminal
};

/// Prints what it did; the error is one line. What was made before an error stays.
Result<void, std::string> make_keyframes(const KeyframesRequest& request, std::ostream& out);

}  // namespace runstone
