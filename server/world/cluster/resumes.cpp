#include "server/world/cluster/resumes.hpp"

namespace runstone {

void Resumes::send(Session& session, ClientSequence resolved) {
  if (!session.has(kFeatureResume))
    return sessions_.close(session, GoodbyeReason::closing, kConnectAgain);
  Of& of = of_[session.id];
  of.is_needed = false;
  ++of.unanswered;
  sessions_.send_or_close(session, Resume{resolved});
}

void Resumes::on_resumed(Session& session) {
  const auto found = of_.find(session.id);
  if (found == of_.end() || found->second.unanswered == 0)
    return sessions_.close(session, GoodbyeReason::unexpected_message,
                           "resumed, but there was no resume");
  --found->second.unanswered;
}

}  // namespace runstone
