#include "server/runtime/message_turns.hpp"

#include <variant>

namespace runstone {

MessageTurns::Lane MessageTurns::lane_of(SessionId session, const Message& message) {
  if (const auto* relay = std::get_if<Relay>(&message)) return {session, relay->sessions.front()};
  if (const auto* open = std::get_if<RelayOpen>(&message)) return {session, open->session};
  if (const auto* close = std::get_if<RelayClose>(&message)) return {session, close->session};
  return {session, 0};
}

void MessageTurns::push(SessionId session, Message&& message, std::size_t bytes) {
  waiting_[lane_of(session, message)].push_back({session, std::move(message), bytes});
}

std::optional<MessageTurns::Turn> MessageTurns::next() {
  if (waiting_.empty()) return std::nullopt;
  auto lane = waiting_.upper_bound(last_);
  if (lane == waiting_.end()) lane = waiting_.begin();
  last_ = lane->first;
  return take(lane);
}

std::optional<MessageTurns::Turn> MessageTurns::next_of(SessionId session) {
  const auto found = waiting_.lower_bound({session, 0});
  if (found == waiting_.end() || found->first.first != session) return std::nullopt;
  return take(found);
}

MessageTurns::Turn MessageTurns::take(Waiting::iterator lane) {
  Turn turn = std::move(lane->second.front());
  lane->second.pop_front();
  if (lane->second.empty()) waiting_.erase(lane);
  return turn;
}

}  // namespace runstone
