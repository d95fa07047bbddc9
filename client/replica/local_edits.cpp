#include "client/replica/local_edits.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/descriptor/edit_memory.hpp"
#include "protocol/rules/window_bytes.hpp"

namespace runstone {

Result<ClientSequence> LocalEdits::add(const EditDescriptor& edit, std::vector<ChunkKey> chunks,
                                       TimeUs submitted_us, InAction in_action) {
  if (edits_.size() >= kLocalEditsMax) {
    return fail(ErrorCode::limit_exceeded, "too many local edits wait for the server");
  }
  LocalEdit local;
  local.edit = edit;
  local.action = in_action.action == kBeginsAction ? last_ + 1 : in_action.action;
  local.is_optional = in_action.is_optional;
  local.has_sender = in_action.has_sender;
  local.again_of = in_action.again_of;
  local.chunks = std::move(chunks);
  local.submitted_us = submitted_us;
  bytes_ += bytes_of(local);
  edits_.emplace_hint(edits_.end(), ++last_, std::move(local));
  ++counters_.submitted;
  return last_;
}

void LocalEdits::mark_sent(ClientSequence seq, TimeUs now_us) {
  if (const auto it = edits_.find(seq); it != edits_.end())
    set(it->second, now_us, it->second.state);
}

std::optional<LocalEditState> LocalEdits::confirm(ClientSequence seq, const Version& version) {
  const auto it = edits_.find(seq);
  if (it == edits_.end()) return std::nullopt;
  LocalEdit& local = it->second;
  if (local.needs_answer()) ++counters_.confirmed;
  local.version = version;
  const LocalEditState before = local.state;
  set(local, local.sent_us, LocalEditState::confirmed);
  return before;
}

std::optional<LocalEdits::Rejection> LocalEdits::reject(const Reject& reject,
                                                        const Version& newest) {
  const auto it = edits_.find(reject.client_seq);
  if (it == edits_.end() || !it->second.needs_answer()) return std::nullopt;
  if (reject.reason != RejectReason::already_resolved) {
    Rejection out{it->second, false};
    erase(it);
    ++counters_.rejected;
    return out;
  }
  Rejection out{it->second, true};
  set(it->second, it->second.sent_us, LocalEditState::unseen);
  it->second.version = {newest.epoch, reject.seq != 0 ? reject.seq : newest.seq};
  return out;
}

std::vector<ClientSequence> LocalEdits::resume(ClientSequence resolved) {
  std::vector<ClientSequence> offers;
  for (auto& [seq, local] : edits_) {
    if (seq > resolved) {
      set(local, LocalEdit::kNever, LocalEditState::pending);
      local.version = {};
      offers.push_back(seq);
    } else if (local.needs_answer()) {
      set(local, LocalEdit::kNever, LocalEditState::asking);
    }
  }
  counters_.offered_again += offers.size();
  return offers;
}

LocalEdits::Retired LocalEdits::retire(Sequence durable) {
  Retired out;
  for (auto it = edits_.begin(); it != edits_.end();) {
    const LocalEdit& local = it->second;
    if (local.needs_answer() || local.version.seq > durable) {
      ++it;
      continue;
    }
    (local.state == LocalEditState::unseen ? out.unseen : out.durable).push_back(it->first);
    it = erase(it);
  }
  counters_.durable += out.durable.size();
  counters_.unseen += out.unseen.size();
  return out;
}

std::size_t LocalEdits::bytes_of(const LocalEdit& local) {
  return sizeof(LocalEdit) + memory_bytes(local.edit) + local.chunks.size() * sizeof(ChunkKey);
}

void LocalEdits::set(LocalEdit& local, TimeUs sent_us, LocalEditState state) {
  count_under_way(local, false);
  local.sent_us = sent_us;
  local.state = state;
  count_under_way(local, true);
}

void LocalEdits::count_under_way(const LocalEdit& local, bool is_added) {
  if (local.sent_us == LocalEdit::kNever || !local.needs_answer()) return;
  const std::size_t bytes = window_bytes(local.edit);
  under_way_.edits += is_added ? 1 : std::size_t{0} - 1;
  under_way_.bytes += is_added ? bytes : std::size_t{0} - bytes;
}

LocalEdits::Map::iterator LocalEdits::erase(Map::iterator it) {
  count_under_way(it->second, false);
  bytes_ -= bytes_of(it->second);
  return edits_.erase(it);
}

const LocalEdit* LocalEdits::find(ClientSequence seq) const {
  const auto it = edits_.find(seq);
  return it == edits_.end() ? nullptr : &it->second;
}

std::vector<ClientSequence> LocalEdits::unanswered() const {
  std::vector<ClientSequence> out;
  for (const auto& [seq, local] : edits_) {
    if (local.needs_answer()) out.push_back(seq);
  }
  return out;
}

std::vector<ClientSequence> LocalEdits::overdue(TimeUs sent_us_max) const {
  std::vector<ClientSequence> out;
  for (const auto& [seq, local] : edits_) {
    if (!local.needs_answer()) continue;
    if (local.sent_us == LocalEdit::kNever || local.sent_us > sent_us_max) break;
    out.push_back(seq);
  }
  return out;
}

std::size_t LocalEdits::pending_count() const {
  return static_cast<std::size_t>(std::count_if(
      edits_.begin(), edits_.end(),
      [](const auto& entry) { return entry.second.state == LocalEditState::pending; }));
}

}  // namespace runstone
