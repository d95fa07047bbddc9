#include "server/world/cluster/resumes.hpp"

namespace runstone {

void Resumes::send(Session& session, ClientSequence resolved) {
  if (!session.has(kFeatureResume))
    return sessions_.close(session, GoodbyeReason::closing, kConnectAgain);
  ResumeState& state = by_session_[session.id];
  state.is_needed = false;
  ++state.unanswered;
  sessions_.send_or_close(session, Resume{resolved});
}

void Resumes::on_resumed(Session& session) {
  const auto found = by_session_.find(session.id);
  if (found == by_session_.end() || found->second.unanswered == 0)
    return sessions_.close(session, GoodbyeReason::unexpected_message,
                           "resumed, but there was no resume");
  --found->second.unanswered;
}

}  // namespace runstone
