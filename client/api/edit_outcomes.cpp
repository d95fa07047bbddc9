#include "client/api/edit_outcomes.hpp"

#include <string>
#include <utility>

namespace runstone {

EditNumber EditOutcomes::number_of(ClientSequence seq) const {
  const auto found = again_.find(seq);
  return found == again_.end() ? seq : found->second;
}

/// Forgets an edit. Returns false if it was not followed.
bool EditOutcomes::end(EditNumber edit, ClientSequence seq) {
  again_.erase(seq);
  return open_.erase(edit) != 0;
}

void EditOutcomes::take(const ReplicaChanges& changes, const ClientSession& session,
                        EventQueue& events) {
  for (const EditChange& change : changes.edits) {
    if (change.predicted || !change.is_local) continue;
    const EditNumber edit = number_of(change.op.seq);
    const auto found = open_.find(edit);
    // An edit whose chunks arrive in parts is reported with each part.
    if (found == open_.end() || found->second == Stage::confirmed) continue;
    found->second = Stage::confirmed;
    events.push(EditConfirmed{edit, change.seq});
  }
  for (const RejectedEdit& reject : changes.rejects) {
    const EditNumber edit = number_of(reject.seq);
    const auto found = open_.find(edit);
    if (found == open_.end()) continue;
    if (reject.is_offered_again) {
      again_.erase(reject.seq);
      found->second = Stage::is_lost;
      ++lost_;
      continue;
    }
    end(edit, reject.seq);
    std::string text = reject.detail.empty() ? "the server rejected the edit" : reject.detail;
    events.push(EditRejected{edit, to_string(reject.reason), std::move(text)});
  }
  for (const ClientSequence seq : changes.durable) {
    const EditNumber edit = number_of(seq);
    if (end(edit, seq)) events.push(EditDurable{edit});
  }
  for (const ClientSequence seq : changes.unseen) {
    const EditNumber edit = number_of(seq);
    if (end(edit, seq)) events.push(EditUnseen{edit});
  }
  if (lost_ != 0) note_offers(session, events);
}

/// Looks for lost edits that were offered again, or that can never be offered again.
void EditOutcomes::note_offers(const ClientSession& session, EventQueue& events) {
  for (const auto& [seq, local] : session.replica().local_edits().all()) {
    if (local.again_of == 0) continue;
    const auto found = open_.find(local.again_of);
    if (found == open_.end() || found->second != Stage::is_lost) continue;
    found->second = Stage::waits;
    again_[seq] = local.again_of;
    --lost_;
  }
  for (auto it = open_.begin(); it != open_.end() && lost_ != 0;) {
    const auto [edit, stage] = *it++;
    if (stage != Stage::is_lost || session.keeps_lost_edit(edit)) continue;
    --lost_;
    open_.erase(edit);
    events.push(EditRejected{edit, "busy", "the edit was lost and cannot be offered again"});
  }
}

void EditOutcomes::world_changed(EventQueue& events) {
  for (const auto& [edit, stage] : open_)
    events.push(EditRejected{edit, "another_world", "the server has opened another world"});
  open_.clear();
  again_.clear();
  lost_ = 0;
}

}  // namespace runstone
