// The edits of a ToolAction, made one after another.
#pragma once
#include <memory>

#include "client/build/edit_source.hpp"
#include "client/tools/tool_action.hpp"
#include "protocol/rules/edit_check.hpp"
#include "protocol/rules/paste_limits.hpp"

namespace runstone {

/// Returns a paste as an action: as one edit if a descriptor can hold it.
ToolAction paste_of_build(BuildPaste paste, const EditLimits& limits);

/// Returns true if the edits of the action are legal as they are, so that no source is needed.
bool is_small(const ToolAction& action, const EditLimits& limits);

/// Returns true if the action clears voxels after something else, as a move does. What it clears is
/// needed elsewhere first.
bool clears_at_end(const ToolAction& action);

/// Returns a source of the edits of an action in a world with these limits: those of the pattern,
/// those of the pastes, and then the other edits. If the action clears at its end, a barrier stands
/// before the first edit that clears. Requires an action that is not empty.
std::unique_ptr<EditSource> source_of(const ToolAction& action, const EditLimits& limits);

}  // namespace runstone
