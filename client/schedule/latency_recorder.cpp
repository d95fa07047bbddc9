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

const char* to_string(EditPath way) {
  constexpr std::array<const char*, kLatencyWayCount> kNames = {"own_predicted", "own_confirmed",
                                                                "remote"};
  return kNames[static_cast<std::size_t>(way)];
}

void LatencyRecorder::not_submitted() {
  for (const EditPath way : {EditPath::own_predicted, EditPath::own_confirmed}) {
    WayReport& report = done_.ways[static_cast<std::size_t>(way)];
    ++report.edits;
    const LatencyStage end = way == EditPath::own_confirmed ? LatencyStage::applied : last_;
    for (std::size_t s = index(LatencyStage::applied); s <= index(end); ++s)
      report.since_submit[s].add_infinite();
  }
}

void LatencyRecorder::take(const ReplicaChanges& news, const ClockOffset& clock, TimeUs now_us) {
  std::map<ChunkKey, std::uint64_t> serials;
  for (const ChunkNews& chunk : news.chunks) {
    if (!chunk.removed) {
      serials[chunk.key] = chunk.serial;
      continue;
    }
    const auto it = waiters_.find(chunk.key);
    if (it == waiters_.end()) continue;
    const auto gone = std::move(it->second);
    waiters_.erase(it);
    for (const Waiter& waiter : gone) chunk_done(waiter.edit, false);
  }
  for (const EditNews& edit : news.edits) take_edit(edit, serials, clock);
  for (const RejectNews& reject : news.rejects) {
    ++done_.rejected;
    own_.erase(reject.seq);
    unconfirmed_.erase(reject.seq);
  }
  for (const ClientSequence seq : news.unseen) {
    ++done_.unseen;
    own_.erase(seq);
    unconfirmed_.erase(seq);
  }
  for (const ClientSequence seq : news.durable) {
    const auto own = own_.find(seq);
    if (own == own_.end()) continue;
    done_.durable.add(now_us - own->second);
    own_.erase(own);
  }
}

void LatencyRecorder::take_edit(const EditNews& news,
                                const std::map<ChunkKey, std::uint64_t>& serials,
                                const ClockOffset& clock) {
  const EditKey key{news.op, news.predicted};
  const auto own = news.own ? own_.find(news.op.seq) : own_.end();
  const bool is_own = own != own_.end();
  if (finished_.contains(key) || (news.own && !is_own)) return;
  const auto [it, fresh] = open_.try_emplace(key);
  OpenEdit& edit = it->second;
  if (fresh) {
    edit.way = news.predicted ? EditPath::own_predicted
               : news.own     ? EditPath::own_confirmed
                              : EditPath::remote;
    if (is_own) {
      edit.submitted_us = own->second;
    } else if (news.submitted_us != 0) {
      edit.submitted_us = clock.to_local(news.submitted_us);
    }
    if (news.predicted) {
      unconfirmed_.insert(news.op.seq);
    } else {
      if (const auto ordered = clock.to_local(news.ordered_us))
        reach(edit, LatencyStage::ordered, *ordered);
      reach(edit, LatencyStage::received, news.received_us);
      reach(edit, LatencyStage::unpacked, news.unpacked_us);
    }
    reach(edit, LatencyStage::applied, news.applied_us);
  }
  if (edit.way == EditPath::own_confirmed) {
    unconfirmed_.erase(news.op.seq);
    finish(edit);
    open_.erase(it);
    remember(key);
    return;
  }
  for (const ChunkKey& chunk : news.chunks) {
    const auto serial = serials.find(chunk);
    if (serial == serials.end()) continue;  // out of view again before anybody looked
    waiters_[chunk].push_back({key, serial->second, false, false});
    ++edit.chunks_left;
  }
  if (edit.chunks_left == 0) {
    ++done_.ways[static_cast<std::size_t>(edit.way)].without_effect;
    finish(edit);
    open_.erase(it);
    remember(key);
  }
}

void LatencyRecorder::meshed(const ChunkKey& key, std::uint64_t serial, TimeUs at_us) {
  const auto it = waiters_.find(key);
  if (it == waiters_.end()) return;
  std::vector<EditKey> through;
  for (Waiter& waiter : it->second) {
    if (waiter.meshed || waiter.serial > serial) continue;
    waiter.meshed = true;
    reach(open_.at(waiter.edit), LatencyStage::meshed, at_us);
    if (last_ == LatencyStage::meshed) through.push_back(waiter.edit);
  }
  if (last_ != LatencyStage::meshed) return;
  std::erase_if(it->second, [](const Waiter& waiter) { return waiter.meshed; });
  if (it->second.empty()) waiters_.erase(it);
  for (const EditKey& edit : through) chunk_done(edit, true);
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
  std::vector<EditKey> through;
  for (auto it = waiters_.begin(); it != waiters_.end();) {
    for (const Waiter& waiter : it->second) {
      if (!waiter.uploaded) continue;
      reach(open_.at(waiter.edit), LatencyStage::presented, at_us);
      through.push_back(waiter.edit);
    }
    std::erase_if(it->second, [](const Waiter& waiter) { return waiter.uploaded; });
    it = it->second.empty() ? waiters_.erase(it) : std::next(it);
  }
  for (const EditKey& edit : through) chunk_done(edit, true);
}

void LatencyRecorder::chunk_done(const EditKey& key, bool drawn) {
  const auto it = open_.find(key);
  if (it == open_.end()) return;
  OpenEdit& edit = it->second;
  edit.drawn = edit.drawn || drawn;
  if (--edit.chunks_left != 0) return;
  if (!edit.drawn) ++done_.ways[static_cast<std::size_t>(edit.way)].left_view;
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
  WayReport& report = done_.ways[static_cast<std::size_t>(edit.way)];
  ++report.edits;
  if (!edit.submitted_us) ++report.unknown_submit;
  std::optional<TimeUs> before = edit.submitted_us;
  for (std::size_t s = 0; s < kLatencyStageCount; ++s) {
    if (!edit.reached[s]) continue;
    if (before) report.step[s].add(edit.at[s] - *before);
    if (edit.submitted_us) report.since_submit[s].add(edit.at[s] - *edit.submitted_us);
    before = edit.at[s];
  }
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
    WayReport& way = report.ways[static_cast<std::size_t>(edit.way)];
    ++way.edits;
    // What it reached counts as it is; the chunks still missing make the rest infinite.
    const bool all_meshed = !unmeshed.contains(key);
    for (std::size_t s = 0; s <= index(last_); ++s) {
      const auto stage = static_cast<LatencyStage>(s);
      const bool final =
          stage < LatencyStage::meshed || (stage == LatencyStage::meshed && all_meshed);
      if (final && edit.reached[s]) {
        if (edit.submitted_us) way.since_submit[s].add(edit.at[s] - *edit.submitted_us);
      } else if (stage >= LatencyStage::meshed) {
        way.since_submit[s].add_infinite();
      }
    }
  }
  WayReport& confirmed = report.ways[static_cast<std::size_t>(EditPath::own_confirmed)];
  for (std::size_t i = 0; i < unconfirmed_.size(); ++i) {
    ++confirmed.edits;
    for (std::size_t s = 0; s <= index(LatencyStage::applied); ++s)
      confirmed.since_submit[s].add_infinite();
  }
  for (std::size_t i = 0; i < own_.size(); ++i) report.durable.add_infinite();
  return report;
}

}  // namespace runstone
