// Resumes: tells clients to offer the edits again that have no answer, because another server
// orders now, or because the server that orders was out of reach. What a client has sent before it
// knows that is ignored.
// Thread: the world strand.
#pragma once
#include <cstdint>
#include <map>

#include "server/world/order/receipts.hpp"

namespace runstone {

class Resumes {
 public:
  explicit Resumes(Sessions& sessions) : sessions_(sessions) {}

  /// From now on the edits of an open session are ignored, until its client has answered every
  /// Resume.
  void ignore_edits(const Session& session) { by_session_[session.id].is_needed = true; }
  bool ignores_edits(const Session& session) const {
    const auto found = by_session_.find(session.id);
    return found != by_session_.end() && (found->second.is_needed || found->second.unanswered > 0);
  }
  /// Lets the client of an open session offer its edits again: `resolved` is the highest client
  /// sequence that the server has resolved which orders now. Closes the session if the client
  /// cannot.
  void send(Session& session, ClientSequence resolved);
  /// Handles the client's answer. Closes the session if there was no Resume.
  void on_resumed(Session& session);
  void forget(SessionId session) { by_session_.erase(session); }

 private:
  struct ResumeState {
    bool is_needed = false;
    std::uint32_t unanswered = 0;
  };
  Sessions& sessions_;
  std::map<SessionId, ResumeState> by_session_;
};

}  // namespace runstone
