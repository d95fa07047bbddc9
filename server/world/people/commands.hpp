// Commands: accepts a client's command and sends its output. WorldEnvironment carries it out. A
// client has at most one command under way and may give kCommandsPerSecond a second.
//
// Thread: the world strand.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/token_bucket.hpp"
#include "server/world/ground/ground.hpp"
#include "server/world/sessions/sessions.hpp"

namespace runstone {

/// The rate of commands is low because an undo reads the log.
inline constexpr std::uint64_t kCommandsPerSecond = 10, kCommandBurst = 20;

class Commands {
 public:
  Commands(WorldEnvironment& environment, Sessions& sessions, const Ground& ground)
      : environment_(environment), sessions_(sessions), ground_(ground) {}

  /// Carries out the command, or rejects it with a line of output.
  void on_command(Session& session, const CommandRequest& request, const Clocks& now);
  /// Sends output of the session's command under way, as lines. `is_done` ends the command. Does
  /// nothing if the session is closed or has no command under way.
  void answer(SessionId session, const std::vector<std::string>& lines, bool is_done, bool is_ok);
  /// Returns the view in which a session shows the changes of a rollback before it is applied, or
  /// nullopt if there is no such session, it has no view, or its client cannot show them.
  std::optional<View> restore_preview_view(SessionId session) const;
  /// Sends what a rollback would change, for the session's command under way. Does nothing if there
  /// is none, or if the client cannot show it. If the session's queue is full, the client gets the
  /// text of the answer alone.
  void show_restore(SessionId session, RestorePreview preview);
  void forget(SessionId session) { by_session_.erase(session); }

 private:
  struct SessionCommands {
    TokenBucket left{kCommandsPerSecond, kCommandBurst};
    std::optional<std::uint32_t> under_way;  // the id of the command
  };
  void send_lines(Session& session, std::uint32_t id, const std::vector<std::string>& lines,
                  bool is_done, bool is_ok);

  WorldEnvironment& environment_;
  Sessions& sessions_;
  const Ground& ground_;
  std::map<SessionId, SessionCommands> by_session_;  // of the sessions that have given a command
};

}  // namespace runstone
