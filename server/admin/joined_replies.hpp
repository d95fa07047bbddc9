// joined_replies: one answer of those of the parts of a command, such as a ban of several players.
#pragma once
#include <cstddef>
#include <vector>

#include "server/rollback/command_reply.hpp"

namespace runstone {

/// Returns a reply for each of `count` parts. When all parts have their last answer, `reply` gets one
/// with their texts, a line or more for each, in the order of the parts. It succeeds if all of them
/// have. If all have an answer, and some are not on disk yet, `reply` gets one that is_unsaved before.
/// Other answers that are not the last ones are passed on at once. One part has `reply` itself.
/// Requires count > 0. The replies must be called on one thread.
std::vector<CommandReply> joined_replies(const CommandReply& reply, std::size_t count);

}  // namespace runstone
