#include "server/world/people/waiting_edits.hpp"

#include <algorithm>

#include "protocol/limits.hpp"
#include "protocol/rules/window_bytes.hpp"

namespace runstone {

bool WaitingEdits::has(SessionId session, ClientSequence seq) const {
  const auto queue = queues_.find(session);
  if (queue == queues_.end()) return false;
  const auto found =
      std::ranges::lower_bound(queue->second.edits, seq, {}, &EditRequest::client_seq);
  return found != queue->second.edits.end() && found->client_seq == seq;
}

bool WaitingEdits::has_room_for(SessionId session, const EditRequest& request) const {
  const auto queue = queues_.find(session);
  return queue == queues_.end() ||
         (queue->second.edits.size() < kWaitingEditsMax &&
          queue->second.bytes + window_bytes(request.edit) <= kWaitingEditBytesMax);
}

void WaitingEdits::push(SessionId session, const EditRequest& request) {
  Queue& queue = queues_[session];
  queue.edits.push_back(request);
  queue.bytes += window_bytes(request.edit);
}

void WaitingEdits::pop(SessionId session) {
  const auto at = queues_.find(session);
  Queue& queue = at->second;
  queue.bytes -= window_bytes(queue.edits.front().edit);
  queue.edits.pop_front();
  if (queue.edits.empty()) queues_.erase(at);
}

std::vector<SessionId> WaitingEdits::sessions() const {
  std::vector<SessionId> out;
  out.reserve(queues_.size());
  const auto first = queues_.lower_bound(turn_);
  for (auto at = first; at != queues_.end(); ++at) out.push_back(at->first);
  for (auto at = queues_.begin(); at != first; ++at) out.push_back(at->first);
  return out;
}

std::size_t WaitingEdits::size() const {
  std::size_t count = 0;
  for (const auto& [session, queue] : queues_) count += queue.edits.size();
  return count;
}

}  // namespace runstone
