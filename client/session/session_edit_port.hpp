// SessionEditPort: the EditPort of a ClientSession.
// One thread.
#pragma once
#include <limits>
#include <string>

#include "client/build/edit_port.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

class SessionEditPort final : public EditPort {
 public:
  /// The session must outlive the port.
  explicit SessionEditPort(ClientSession& session) : session_(session) {}

  std::string why_closed() const override {
    if (!session_.is_open()) return "the connection";
    if (session_.replica().past()) return "the live world: you look at the past";
    if (session_.is_server_read_only()) return "space on the server's disk";
    return {};
  }
  std::size_t action_edits_max() const override {
    return session_.has_large_actions() ? std::numeric_limits<std::size_t>::max() : kActionEditsMax;
  }
  bool has_room(const EditDescriptor& edit) const override { return session_.has_window_for(edit); }
  TimeUs wait_us(const EditDescriptor& edit, TimeUs now_us) override {
    return session_.action_wait_us(edit, now_us);
  }
  Result<ClientSequence, std::string> offer(const EditDescriptor& edit, const InAction& in_action,
                                            TimeUs now_us) override {
    const auto seq = session_.offer(edit, now_us, now_us, in_action);
    if (seq) return *seq;
    return failure(session_.refusal_text(edit, seq.error()));
  }
  bool is_answered(ClientSequence seq) const override {
    const LocalEdit* const local = session_.replica().local_edits().find(seq);
    return local == nullptr || !local->needs_answer();
  }

 private:
  ClientSession& session_;
};

}  // namespace runstone
