// OperatorActions: commands that the program or the runtime around a world carries out.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "server/admin/backup_state.hpp"
#include "server/admin/retention_state.hpp"
#include "server/admin/server_health.hpp"
#include "server/chat/chat_query.hpp"
#include "server/rollback/command_reply.hpp"

namespace runstone {

class AccessTokenStore;

/// The actions are called on the world strand and must return at once. Replies may be called from
/// any thread, until the server is destroyed. A command whose action is empty is refused.
struct OperatorActions {
  std::function<void()> stop;
  /// Reads the settings again and passes them to Server::reload().
  std::function<void(CommandReply)> reload;
  /// Copies the world to a new folder.
  std::function<void(const std::string& folder, CommandReply)> back_up;
  /// Lets another server take the world over: the one of this number, or nullopt: the one with the
  /// most players. The last reply has the outcome.
  std::function<void(std::optional<SessionId> successor, CommandReply)> hand_over;
  /// Returns why a wall clock of this time (UTC), which is behind the time of the log, may be wrong, as
  /// a part of a sentence, or nullopt. The runtime sets it, because the world reads no clock.
  std::function<std::optional<std::string>(TimeUs wall_us)> doubt_clock;
  /// Writes the file of a build, under a content number, before the record that adds the build. `done`
  /// gets an empty text, or why it failed. Returns false if another file is being written, or if the
  /// log cannot be written any more; `done` is not called then. The runtime sets it.
  std::function<bool(std::uint64_t content, std::shared_ptr<const Bytes> file,
                     std::function<void(const std::string&)> done)>
      save_build_file;
  /// Returns how many damaged rows the check of the world has found. The runtime sets it.
  std::function<std::uint64_t()> row_faults;
  /// Returns the state of the backups that the server makes by itself. Empty: it makes none. Unlike the
  /// others it may be called from any thread.
  std::function<BackupState()> backup_state;
  /// Returns how the server is, for `status`. The runtime sets it.
  std::function<ServerHealth()> health;
  /// The retention of the log. The runtime sets these. `run_retention` begins a run that keeps the
  /// edits of so many days. It returns false if a run is under way or the log cannot be written.
  /// `stop_retention` ends the run under way. It returns false if there is none.
  std::function<RetentionState()> retention_state;
  std::function<bool(std::uint64_t days)> run_retention;
  std::function<bool()> stop_retention;
  /// Writes a line into the log of the server. The runtime sets it.
  std::function<void(const std::string&)> log_line;
  /// The tokens of the operators' page, and the address of the gateway in links to it. Null: the server
  /// has no such page.
  std::shared_ptr<AccessTokenStore> tokens;
  std::string page_base;
  /// Answers with lines of the log of the chat. The runtime sets it.
  std::function<void(const ChatQuery&, CommandReply)> list_chat;
};

}  // namespace runstone
