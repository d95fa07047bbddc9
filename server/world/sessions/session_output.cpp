#include "server/world/sessions/session_output.hpp"

#include <algorithm>
#include <utility>

namespace runstone {

SessionId SessionOutput::add(const RelayedSession& relayed) {
  relayed_[next_] = relayed;
  return next_++;
}

const RelayedSession* SessionOutput::relayed(SessionId session) const {
  const auto found = relayed_.find(session);
  return found == relayed_.end() ? nullptr : &found->second;
}

bool SessionOutput::send(SessionId session, const EncodedMessage& message) {
  const RelayedSession* there = relayed(session);
  if (there == nullptr) return environment_.send(session, message);
  if (message.bytes->size() > kRelayBodyBytesMax) return false;
  return environment_.send(there->link, encode_message(Relay{{there->remote}, message}));
}

std::vector<SessionId> SessionOutput::send_to_all(std::span<const SessionId> sessions,
                                                  const EncodedMessage& message) {
  if (relayed_.empty()) return environment_.send_to_all(sessions, message);
  std::vector<SessionId> here, full;
  std::map<SessionId, std::vector<SessionId>> there;  // by link
  for (const SessionId session : sessions) {
    if (const RelayedSession* relayed_session = relayed(session)) {
      there[relayed_session->link].push_back(session);
    } else {
      here.push_back(session);
    }
  }
  full = environment_.send_to_all(here, message);
  for (const auto& [link, all] : there) {
    for (std::size_t first = 0; first < all.size(); first += kRelaySessionsMax) {
      const auto part =
          std::span(all).subspan(first, std::min(kRelaySessionsMax, all.size() - first));
      Relay relay{{}, message};
      for (const SessionId session : part) relay.sessions.push_back(relayed(session)->remote);
      const bool fits = message.bytes->size() <= kRelayBodyBytesMax;
      if (!fits || !environment_.send(link, encode_message(std::move(relay))))
        full.insert(full.end(), part.begin(), part.end());
    }
  }
  return full;
}

void SessionOutput::close(SessionId session, GoodbyeReason reason, const std::string& text) {
  const RelayedSession* there = relayed(session);
  if (there == nullptr) return environment_.close(session, reason, text);
  const RelayClose close{there->remote, static_cast<std::uint8_t>(reason), text};
  // A link whose queue is full is closed, with all of its sessions.
  if (!environment_.send(there->link, encode_message(close)))
    environment_.close(there->link, GoodbyeReason::timed_out, "the link is too slow");
}

void SessionOutput::charge_reading(SessionId session, std::size_t bytes) {
  const RelayedSession* there = relayed(session);
  if (there == nullptr) return environment_.charge_reading(session, bytes);
  static_cast<void>(
      environment_.send(there->link, encode_message(RelayCharge{there->remote, bytes})));
}

}  // namespace runstone
