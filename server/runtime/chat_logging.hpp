// The log of the chat of a running server.
#pragma once
#include <memory>
#include <vector>

#include "server/admin/server_config.hpp"
#include "server/chat/chat_log.hpp"
#include "server/rollback/command_reply.hpp"

namespace runstone {

/// Opens the log of the chat in the world's folder and removes lines that are older than
/// `chat_days`. With chat_days = 0 it removes the whole log and returns null. `now_us`: UTC. Blocks
/// on the disk.
std::unique_ptr<ChatLog> open_chat_log(const ServerConfig& config, TimeUs now_us);

/// Returns the time before which lines are removed.
TimeUs chat_kept_from_us(const ServerConfig& config, TimeUs now_us);

/// Returns the newest lines that are not withdrawn, for players who join after a restart, or none
/// if they cannot be read. Blocks on the disk.
std::vector<ChatEntry> newest_chat(ChatLog& log);

/// Answers the command `chat log`, from the thread of the log.
void list_chat(ChatLog& log, const ChatQuery& query, const CommandReply& reply);

}  // namespace runstone
