#include "server/world/order/checkpointer.hpp"

#include <algorithm>

#include "common/core/assert.hpp"

namespace runstone {

Checkpointer::Checkpointer(const SnapshotPolicy& policy, Sequence checkpoint)
    : policy_(policy), checkpoint_(checkpoint), last_target_(checkpoint) {}

bool Checkpointer::is_clean(const Authority& authority) const {
  return !round_ && !in_flight_ && authority.chunks().dirty().empty() &&
         last_target_ == authority.head();
}

bool Checkpointer::is_due(const Authority& authority, const Clocks& now) const {
  if (authority.head() == last_target_ && authority.chunks().dirty().empty()) return false;
  return finishing_ || authority.head() - last_target_ >= policy_.edits_max ||
         authority.chunks().stack_bytes() >= policy_.stack_bytes_max ||
         now.steady_us - *last_round_us_ >= policy_.interval_us;
}

void Checkpointer::next_slice() {
  Round& r = *round_;
  const std::size_t end = std::min(r.keys.size(), r.next + policy_.slice_chunks);
  r.missing.assign(r.keys.begin() + static_cast<std::ptrdiff_t>(r.next),
                   r.keys.begin() + static_cast<std::ptrdiff_t>(end));
  r.captured.clear();
  r.next = end;
}

std::vector<ChunkKey> Checkpointer::step(Authority& authority, Sequence durable, const Clocks& now,
                                         WorldEnvironment& environment) {
  std::vector<ChunkKey> to_load;
  if (!last_round_us_) last_round_us_ = now.steady_us;
  if (in_flight_ || is_abandoned_) return to_load;
  WorldChunks& chunks = authority.chunks();
  if (!round_) {
    if (!is_due(authority, now)) return to_load;
    round_ = Round{};
    round_->target = authority.head();
    round_->keys.assign(chunks.dirty().begin(), chunks.dirty().end());
    last_round_us_ = now.steady_us;
    last_target_ = round_->target;
    ++rounds_;
    next_slice();
  }
  Round& r = *round_;
  std::erase_if(r.missing, [&](const ChunkKey& key) {
    const Residency residency = chunks.residency(key);
    if (residency == Residency::quarantined) return true;
    if (residency == Residency::absent) to_load.push_back(key);
    if (residency != Residency::resident) return false;
    r.captured.emplace_back(key, chunks.find(key));
    return true;
  });
  if (!r.missing.empty()) return to_load;

  const bool is_last = r.next == r.keys.size();
  Sequence needed = is_last ? r.target : 0;
  for (const auto& [key, chunk] : r.captured) needed = std::max(needed, chunk->version.seq);
  if (durable < needed) return to_load;

  Sequence checkpoint = checkpoint_;
  if (is_last) {
    const auto only_in_log = chunks.first_quarantined_edit();
    checkpoint =
        std::max(checkpoint_, only_in_log ? std::min(r.target, *only_in_log - 1) : r.target);
  }
  in_flight_ = InFlight{{}, checkpoint};
  for (const auto& [key, chunk] : r.captured) in_flight_->chunks.emplace_back(key, chunk->version);
  environment.save_snapshots(std::move(r.captured), checkpoint);
  if (is_last) {
    round_.reset();
  } else {
    next_slice();
  }
  return to_load;
}

void Checkpointer::abandon() {
  is_abandoned_ = true;
  round_.reset();
}

void Checkpointer::saved(WorldChunks& chunks) {
  RUNSTONE_ASSERT(in_flight_.has_value());
  for (const auto& [key, version] : in_flight_->chunks) chunks.mark_saved(key, version);
  checkpoint_ = in_flight_->checkpoint;
  in_flight_.reset();
}

}  // namespace runstone
