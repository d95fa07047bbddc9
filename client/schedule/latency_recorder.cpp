#include "client/schedule/latency_recorder.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr std::size_t kFinishedMax = 1 << 16;

constexpr std::size_t index(LatencyStage stage) { return static_cast<std::size_t>(stage); }

}  // namespace

const char* to_string(LatencyStage stage) {
  constexpr std::array<const char*, kLatencyStageCount> kNames = {
      "ordered", "received", "unpacked", "applied", "meshed", "uploaded", "presented"};
  return kNames[index(stage)];
}

const char* to_string(EditPath path) {
  constexpr std::array<const char*, kEditPathCount> kNames = {"local_predicted", "local_confirmed",
                                                              "remote"};
  return kNames[static_cast<std::size_t>(path)];
}

void LatencyRecorder::not_submitted() {
  for (const EditPath path : {EditPath::local_predicted, EditPath::local_confirmed}) {
    PathReport& report = done_.paths[static_cast<std::size_t>(path)];
    ++report.edits;
    const LatencyStage end = path == EditPath::local_confirmed ? LatencyStage::applied : last_;
    for (std::size_t s = index(LatencyStage::applied); s <= index(end); ++s)
      report.since_submit[s].add_infinite();
  }
}

void LatencyRecorder::take(const ReplicaChanges& changes, const ClockOffset& clock, TimeUs now_us) {
  std::map<ChunkKey, std::uint64_t> serials;
  for (const ChunkChange& chunk : changes.chunks) {
    if (!chunk.removed) {
      serials[chunk.key] = chunk.serial;
      continue;
    }
    const auto it = waiters_.find(chunk.key);
    if (it == waiters_.end()) continue;
    const auto removed = std::move(it->second);
    waiters_.erase(it);
    for (const Waiter& waiter : removed) chunk_done(waiter.edit, false);
  }
  for (const EditChange& edit : changes.edits) take_edit(edit, serials, clock);
  for (const RejectedEdit& reject : changes.rejects) {
    ++done_.rejected;
    local_.erase(reject.seq);
    unconfirmed_.erase(reject.seq);
  }
  for (const ClientSequence seq : changes.unseen) {
    ++done_.unseen;
    local_.erase(seq);
    unconfirmed_.erase(seq);
  }
  for (const ClientSequence seq : changes.durable) {
    const auto local = local_.find(seq);
    if (local == local_.end()) continue;
    done_.durable.add(now_us - local->second);
    local_.erase(local);
  }
}

void LatencyRecorder::take_edit(const EditChange& change,
                                const std::map<ChunkKey, std::uint64_t>& serials,
                                const ClockOffset& clock) {
  const EditKey key{change.op, change.predicted};
  const auto local = change.is_local ? local_.find(change.op.seq) : local_.end();
  const bool is_submitted = local != local_.end();
  if (finished_.contains(key) || (change.is_local && !is_submitted)) return;
  const auto [it, is_new] = open_.try_emplace(key);
  OpenEdit& edit = it->second;
  if (is_new) {
    edit.path = change.predicted  ? EditPath::local_predicted
                : change.is_local ? EditPath::local_confirmed
                                  : EditPath::remote;
    if (is_submitted) {
      edit.submitted_us = local->second;
    } else if (change.submitted_us != 0) {
      edit.submitted_us = clock.to_local(change.submitted_us);
    }
    if (change.predicted) {
      unconfirmed_.insert(change.op.seq);
    } else {
      if (const auto ordered = clock.to_local(change.ordered_us))
        reach(edit, LatencyStage::ordered, *ordered);
      reach(edit, LatencyStage::received, change.received_us);
      reach(edit, LatencyStage::unpacked, change.unpacked_us);
    }
    reach(edit, LatencyStage::applied, change.applied_us);
  }
  if (edit.path == EditPath::local_confirmed) {
    unconfirmed_.erase(change.op.seq);
    finish(edit);
    open_.erase(it);
    remember(key);
    return;
  }
  for (const ChunkKey& chunk : change.chunks) {
    const auto serial = serials.find(chunk);
    // The chunk left the view before the changes were drained.
    if (serial == serials.end()) continue;
    waiters_[chunk].push_back({key, serial->second, false, false});
    ++edit.chunks_left;
  }
  if (edit.chunks_left == 0) {
    ++done_.paths[static_cast<std::size_t>(edit.path)].without_effect;
    finish(edit);
    open_.erase(it);
    remember(key);
  }
}

void LatencyRecorder::meshed(const ChunkKey& key, std::uint64_t serial, TimeUs at_us) {
  const auto it = waiters_.find(key);
  if (it == waiters_.end()) return;
  std::vector<EditKey> finished;
  for (Waiter& waiter : it->second) {
    if (waiter.meshed || waiter.serial > serial) continue;
    waiter.meshed = true;
    reach(open_.at(waiter.edit), LatencyStage::meshed, at_us);
    if (last_ == LatencyStage::meshed) finished.push_back(waiter.edit);
  }
  if (last_ != LatencyStage::meshed) return;
  std::erase_if(it->second, [](const Waiter& waiter) { return waiter.meshed; });
  if (it->second.empty()) waiters_.erase(it);
  for (const EditKey& edit : finished) chunk_done(edit, true);
}

void LatencyRecorder::uploaded(const ChunkKey& key, std::uint64_t serial, TimeUs at_us) {
  const auto it = waiters_.find(key);
  if (it == waiters_.end()) return;
  for (Waiter& waiter : it->second) {
    if (waiter.uploaded || waiter.serial > serial) continue;
    waiter.uploaded = true;
    reach(open_.at(waiter.edit), LatencyStage::uploaded, at_us);
  }
}

void LatencyRecorder::presented(TimeUs at_us) {
  std::vector<EditKey> finished;
  for (auto it = waiters_.begin(); it != waiters_.end();) {
    for (const Waiter& waiter : it->second) {
      if (!waiter.uploaded) continue;
      reach(open_.at(waiter.edit), LatencyStage::presented, at_us);
      finished.push_back(waiter.edit);
    }
    std::erase_if(it->second, [](const Waiter& waiter) { return waiter.uploaded; });
    it = it->second.empty() ? waiters_.erase(it) : std::next(it);
  }
  for (const EditKey& edit : finished) chunk_done(edit, true);
}

void LatencyRecorder::chunk_done(const EditKey& key, bool drawn) {
  const auto it = open_.find(key);
  if (it == open_.end()) return;
  OpenEdit& edit = it->second;
  edit.drawn = edit.drawn || drawn;
  if (--edit.chunks_left != 0) return;
  if (!edit.drawn) ++done_.paths[static_cast<std::size_t>(edit.path)].left_view;
  finish(edit);
  open_.erase(it);
  remember(key);
}

void LatencyRecorder::reach(OpenEdit& edit, LatencyStage stage, TimeUs at_us) {
  TimeUs& at = edit.at[index(stage)];
  at = edit.reached[index(stage)] ? std::max(at, at_us) : at_us;
  edit.reached[index(stage)] = true;
}

void LatencyRecorder::finish(const OpenEdit& edit) {
  PathReport& report = done_.paths[static_cast<std::size_t>(edit.path)];
  ++report.edits;
  if (!edit.submitted_us) ++report.unknown_submit;
  std::optional<TimeUs> before = edit.submitted_us;
  for (std::size_t s = 0; s < kLatencyStageCount; ++s) {
    if (!edit.reached[s]) continue;
    if (before) report.step[s].add(edit.at[s] - *before);
    if (edit.submitted_us) report.since_submit[s].add(edit.at[s] - *edit.submitted_us);
    before = edit.at[s];
  }
  if (!edit.submitted_us) return;
  recent_.push_back({edit.path, *edit.submitted_us, edit.at, edit.reached});
  if (recent_.size() > kRecentMax) recent_.pop_front();
}

void LatencyRecorder::remember(const EditKey& key) {
  finished_.insert(key);
  finished_order_.push_back(key);
  if (finished_order_.size() <= kFinishedMax) return;
  finished_.erase(finished_order_.front());
  finished_order_.pop_front();
}

LatencyReport LatencyRecorder::report() const {
  LatencyReport report = done_;
  std::set<EditKey> unmeshed;
  for (const auto& [chunk, waiters] : waiters_) {
    for (const Waiter& waiter : waiters) {
      if (!waiter.meshed) unmeshed.insert(waiter.edit);
    }
  }
  for (const auto& [key, edit] : open_) {
    PathReport& path = report.paths[static_cast<std::size_t>(edit.path)];
    ++path.edits;
    // Stages that all chunks reached count as they are. The chunks that are missing make the other
    // stages infinite.
    const bool all_meshed = !unmeshed.contains(key);
    for (std::size_t s = 0; s <= index(last_); ++s) {
      const auto stage = static_cast<LatencyStage>(s);
      const bool final =
          stage < LatencyStage::meshed || (stage == LatencyStage::meshed && all_meshed);
      if (final && edit.reached[s]) {
        if (edit.submitted_us) path.since_submit[s].add(edit.at[s] - *edit.submitted_us);
      } else if (stage >= LatencyStage::meshed) {
        path.since_submit[s].add_infinite();
      }
    }
  }
  PathReport& confirmed = report.paths[static_cast<std::size_t>(EditPath::local_confirmed)];
  for (std::size_t i = 0; i < unconfirmed_.size(); ++i) {
    ++confirmed.edits;
    for (std::size_t s = 0; s <= index(LatencyStage::applied); ++s)
      confirmed.since_submit[s].add_infinite();
  }
  for (std::size_t i = 0; i < local_.size(); ++i) report.durable.add_infinite();
  return report;
}

}  // namespace runstone
