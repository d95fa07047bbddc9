// ServerNotices: makes the short texts by which a player learns what the server sent about edits,
// the past and its disk. Characters that with_unseen_replaced() replaces are question marks. One
// thread.
#pragma once
#include <string>
#include <vector>

#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"
#include "client/ui/notice_list.hpp"

namespace runstone {

/// A short text for the player.
struct PlayerNotice {
  std::string text;
  NoticeKind kind = NoticeKind::information;
};

class ServerNotices {
 public:
  /// `session` must outlive the object.
  explicit ServerNotices(const ClientSession& session) : session_(session) {}

  /// Returns the notices about the server's state that are new since the last call: why the past is
  /// not shown, and that the server is read-only, or no longer.
  std::vector<PlayerNotice> take_state();

 private:
  const ClientSession& session_;
  std::string told_refusal_;     // of the newest request to see the past
  bool told_read_only_ = false;  // the state of the server in the last notice about it
};

/// Returns the notice of a rejected edit.
PlayerNotice notice_of(const RejectedEdit& reject);

}  // namespace runstone
