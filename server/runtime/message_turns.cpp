#include "server/runtime/message_turns.hpp"

#include <utility>

namespace runstone {

void MessageTurns::push(SessionId session, Message&& message, std::size_t bytes) {
  waiting_[session].push_back({session, std::move(message), bytes});
}

std::optional<MessageTurns::Turn> MessageTurns::next() {
  if (waiting_.empty()) return std::nullopt;
  auto session = waiting_.upper_bound(last_);
  if (session == waiting_.end()) session = waiting_.begin();
  last_ = session->first;
  return take(session);
}

std::optional<MessageTurns::Turn> MessageTurns::next_of(SessionId session) {
  const auto found = waiting_.find(session);
  if (found == waiting_.end()) return std::nullopt;
  return take(found);
}

MessageTurns::Turn MessageTurns::take(Waiting::iterator session) {
  Turn turn = std::move(session->second.front());
  session->second.pop_front();
  if (session->second.empty()) waiting_.erase(session);
  return turn;
}

}  // namespace runstone
