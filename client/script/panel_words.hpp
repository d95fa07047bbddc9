// The commands of a script for the windows about the world: map, timeline, rollback and the library of
// builds. Internal to the parser.
#pragma once
#include <optional>
#include <string_view>

#include "client/script/script.hpp"
#include "client/script/script_words.hpp"

namespace runstone {

/// Returns the command, or nullopt if the verb is another one. Throws LineError.
std::optional<script::Step> panel_step(std::string_view verb, ScriptWords& words);

}  // namespace runstone
