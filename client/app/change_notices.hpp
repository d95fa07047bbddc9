// ChangeNotices: shows to the player, and writes to the log, what the server sent about chunks,
// edits, the past and its disk. Thread: the main thread.
#pragma once
#include "client/app/client_hud.hpp"
#include "client/play/server_notices.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class ChangeNotices {
 public:
  /// Both must outlive this object.
  ChangeNotices(const ClientSession& session, ClientHud& hud) : notices_(session), hud_(hud) {}

  /// Call it with all changes of the replica, in their order.
  void take(const ReplicaChanges& changes);

 private:
  void show(const ServerNotice& notice);

  ServerNotices notices_;
  ClientHud& hud_;
};

}  // namespace runstone
