// Tool words: the commands of a script that work the building tools. Internal to the parser.
#pragma once
#include <optional>
#include <string_view>

#include "client/script/script.hpp"
#include "client/script/script_words.hpp"

namespace runstone {

/// Parses a command of the tools. Returns nullopt if `verb` is none. Throws LineError.
std::optional<script::Step> tool_step(std::string_view verb, ScriptWords& words);

}  // namespace runstone
