// ChangeNotices: shows to the player, and writes to the log, what the server sent about chunks,
// edits, the past and its disk. Thread: the main thread.
#pragma once
#include <string>

#include "client/app/client_hud.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class ChangeNotices {
 public:
  /// Both must outlive this object.
  ChangeNotices(const ClientSession& session, ClientHud& hud) : session_(session), hud_(hud) {}

  /// Call it with all changes of the replica, in their order.
  void take(const ReplicaChanges& changes);

 private:
  /// Logs the text as a warning and shows it.
  void warn(const std::string& text);

  const ClientSession& session_;
  ClientHud& hud_;
  std::string told_refusal_;     // of the newest request to see the past
  bool told_read_only_ = false;  // the state of the server that was shown last
};

}  // namespace runstone
