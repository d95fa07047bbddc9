#include "client/bots/replica_bot.hpp"

#include <utility>

namespace runstone {
namespace {

constexpr TimeUs kTickUs = 10'000;  // see ClientSession::tick()

}  // namespace

ReplicaBot::ReplicaBot(BotConfig config, FleetStatistics& fleet)
    : Bot(std::move(config)), fleet_(fleet), session_(config_.session) {}

TimeUs ReplicaBot::tick_due_us(TimeUs now_us) const { return now_us + kTickUs; }

bool ReplicaBot::offer(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) {
  const auto sequence = session_.offer(edit, due_us, now_us);
  if (!sequence) return false;
  fleet_.due.add(config_.session.instance, *sequence, due_us);
  placed_.add(edit);
  open_[*sequence] = {due_us, edit};
  is_answered_ = false;
  return true;
}

void ReplicaBot::drain_changes() {
  const ReplicaChanges changes = session_.replica().drain_changes();
  for (const EditChange& edit : changes.edits) {
    if (edit.predicted) continue;
    // An edit whose chunks arrive in parts is reported, and counted, with each part.
    if (const auto due_us = fleet_.due.find(edit.op.instance, edit.op.seq)) {
      fleet_.see(*due_us, edit.applied_us);
    } else {
      fleet_.see_unknown();
    }
    if (!edit.is_local) {
      ++counts_.others;
      continue;
    }
    const auto found = open_.find(edit.op.seq);
    if (found == open_.end()) continue;  // a later part of the edit
    counts_.confirm_us.add(edit.applied_us - found->second.due_us);
    ++counts_.confirmed;
    open_.erase(found);
  }
  for (const RejectedEdit& reject : changes.rejects) {
    ++counts_.rejected;
    if (const auto found = open_.find(reject.seq); found != open_.end()) {
      placed_.forget(found->second.edit);
      open_.erase(found);
    }
  }
  counts_.durable += changes.durable.size();
  is_answered_ = session_.replica().local_edits().all().empty();
}

BotCounts ReplicaBot::counts() const {
  BotCounts counts = counts_;
  for (std::size_t i = 0; i < open_.size(); ++i) counts.confirm_us.add_infinite();
  return counts;
}

}  // namespace runstone
