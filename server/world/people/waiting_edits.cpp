#include "server/world/people/waiting_edits.hpp"

#include <algorithm>

#include "protocol/limits.hpp"
#include "protocol/rules/window_bytes.hpp"

namespace runstone {

bool WaitingEdits::has(SessionId session, ClientSequence seq) const {
  const auto of = of_.find(session);
  if (of == of_.end()) return false;
  const auto found = std::ranges::lower_bound(of->second.edits, seq, {}, &EditRequest::client_seq);
  return found != of->second.edits.end() && found->client_seq == seq;
}

bool WaitingEdits::has_room_for(SessionId session, const EditRequest& request) const {
  const auto of = of_.find(session);
  return of == of_.end() || (of->second.edits.size() < kWaitingEditsMax &&
                             of->second.bytes + window_bytes(request.edit) <= kWaitingEditBytesMax);
}

void WaitingEdits::push(SessionId session, const EditRequest& request) {
  Of& of = of_[session];
  of.edits.push_back(request);
  of.bytes += window_bytes(request.edit);
}

void WaitingEdits::pop(SessionId session) {
  const auto at = of_.find(session);
  Of& of = at->second;
  of.bytes -= window_bytes(of.edits.front().edit);
  of.edits.pop_front();
  if (of.edits.empty()) of_.erase(at);
}

std::vector<SessionId> WaitingEdits::sessions() const {
  std::vector<SessionId> out;
  out.reserve(of_.size());
  const auto first = of_.lower_bound(turn_);
  for (auto at = first; at != of_.end(); ++at) out.push_back(at->first);
  for (auto at = of_.begin(); at != first; ++at) out.push_back(at->first);
  return out;
}

std::size_t WaitingEdits::size() const {
  std::size_t count = 0;
  for (const auto& [session, of] : of_) count += of.edits.size();
  return count;
}

}  // namespace runstone
