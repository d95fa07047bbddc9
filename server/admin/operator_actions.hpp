// OperatorActions: commands that the program around a server carries out, not the world.
#pragma once
#include <functional>
#include <string>

#include "server/rollback/command_reply.hpp"

namespace runstone {

/// The actions are called on the world strand and must return at once. Replies may be called from any
/// thread, until the server is destroyed. A command whose action is empty is refused.
struct OperatorActions {
  std::function<void()> stop;
  /// Reads the settings again and passes them to Server::reload().
  std::function<void(CommandReply)> reload;
  /// Copies the world to a new folder.
  std::function<void(const std::string& folder, CommandReply)> back_up;
};

}  // namespace runstone
