// runstone-replay keyframes: makes the keyframes that a world lacks, while no server runs it.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/core/result.hpp"
#include "server/replay/subcommand_options.hpp"

namespace runstone {

struct KeyframesOptions {
  CommonOptions common;
  std::uint64_t keyframe_edits = 32'768;  // least number of edits between two keyframes, 1..10^9
};

void declare_keyframes(SubcommandOptions& command_line, KeyframesOptions& options);
/// Makes the keyframes and prints their number. The keyframes made before an error stay.
Result<int, std::string> run_keyframes(const KeyframesOptions& options, std::ostream& out);

}  // namespace runstone
