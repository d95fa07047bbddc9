#include "client/replica/local_edits.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {

ClientSequence LocalEdits::add(OwnEdit edit) {
  RUNSTONE_ASSERT(!full());
  edits_.emplace_hint(edits_.end(), ++last_, std::move(edit));
  return last_;
}

OwnEdit* LocalEdits::find(ClientSequence seq) {
  const auto it = edits_.find(seq);
  return it == edits_.end() ? nullptr : &it->second;
}

LocalEdits::Settled LocalEdits::take_durable(Sequence durable) {
  Settled out;
  for (auto it = edits_.begin(); it != edits_.end();) {
    const OwnEdit& own = it->second;
    if (own.resolved && !own.asked && own.version.seq <= durable) {
      (own.unseen ? out.unseen : out.durable).push_back(it->first);
      it = edits_.erase(it);
    } else {
      ++it;
    }
  }
  return out;
}

std::vector<ClientSequence> LocalEdits::resume(ClientSequence resolved) {
  std::vector<ClientSequence> offers;
  for (auto& [seq, own] : edits_) {
    if (seq > resolved) {
      own.resolved = own.asked = own.unseen = false;
      own.version = {};
      own.sent_us = OwnEdit::kNever;
      offers.push_back(seq);
    } else if (!own.resolved) {
      own.resolved = own.asked = true;
      own.sent_us = OwnEdit::kNever;
    }
  }
  return offers;
}

std::vector<ClientSequence> LocalEdits::unanswered() const {
  std::vector<ClientSequence> out;
  for (const auto& [seq, own] : edits_) {
    if (!own.resolved || own.asked) out.push_back(seq);
  }
  return out;
}

std::size_t LocalEdits::undecided() const {
  return static_cast<std::size_t>(std::count_if(
      edits_.begin(), edits_.end(), [](const auto& entry) { return !entry.second.resolved; }));
}

}  // namespace runstone
