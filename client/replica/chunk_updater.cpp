#include "client/replica/chunk_updater.hpp"

#include <algorithm>

namespace runstone {

bool ChunkUpdater::apply_snapshot(TrackedChunk& chunk, Chunk snapshot, TimeUs now_us) {
  const bool was_vouched = is_vouched(chunk.state());
  chunks_.answer(chunk);
  if (chunk.confirmed() && !is_needed(chunk, snapshot, was_vouched)) {
    // The snapshot brings nothing new. The confirmed chunk contains the local edits whose answers
    // were missed, so these edits are removed.
    const bool has_dropped = chunk.drop_answered(0) != 0;
    if (chunk.is_current()) {
      advance(chunk, true, now_us);
    } else if (has_dropped) {
      show(chunk);
    }
    return false;
  }
  ++counters_.snapshots_taken;
  const Sequence seq = snapshot.version.seq;
  chunk.repeat_patches(snapshot.version);
  chunks_.set_current(chunk, std::make_shared<const Chunk>(std::move(snapshot)));
  chunk.drop_answered(seq);
  advance(chunk, true, now_us);
  return true;
}

/// Returns true if the snapshot must replace the confirmed chunk: it is newer, or it repairs a
/// chunk in doubt.
bool ChunkUpdater::is_needed(TrackedChunk& chunk, const Chunk& snapshot, bool was_vouched) {
  const Chunk& held = *chunk.confirmed();
  if (snapshot.version > held.version) return true;
  if (snapshot.version < held.version) {
    ++counters_.snapshots_stale;
    return false;
  }
  // One version has one digest: a copy with another digest has drifted.
  const bool has_drifted = snapshot.digest != digest_of(held.voxels);
  if (has_drifted) ++(was_vouched ? counters_.repaired : counters_.claims_refuted);
  return has_drifted || is_awaiting(chunk.state());
}

void ChunkUpdater::replace(TrackedChunk& chunk, Chunk snapshot) {
  ++counters_.snapshots_taken;
  chunks_.set_current(chunk, std::make_shared<const Chunk>(std::move(snapshot)));
  show(chunk);
}

/// The confirmed chunk was the server's when it subscribed this client: later commits have arrived,
/// or will.
void ChunkUpdater::vouch(TrackedChunk& chunk, TimeUs now_us) {
  chunk.drop_answered(0);
  advance(chunk, true, now_us);
}

void ChunkUpdater::apply_not_modified(TrackedChunk& chunk, Sequence seq, TimeUs now_us) {
  chunks_.answer(chunk);
  ++counters_.same_taken;
  if (!chunk.is_current()) return;
  if (chunk.confirmed() && chunk.confirmed()->version.seq >= seq) return vouch(chunk, now_us);
  // The copy that was claimed is not held any more.
  request(chunk, now_us);
}

bool ChunkUpdater::apply_missing_edits(TrackedChunk& chunk, const ChunkEdits& update,
                                       TimeUs now_us) {
  chunks_.answer(chunk);
  if (!chunk.is_current()) return false;
  if (!chunk.confirmed()) {
    request(chunk, now_us);
    return false;
  }
  const Sequence held = chunk.confirmed()->version.seq;
  if (held >= update.to.seq) {
    vouch(chunk, now_us);
    return false;
  }
  // Commits that arrived before may have brought the chunk part of the way.
  bool follows = held == update.from;
  std::vector<EditDescriptor> stack;
  for (const MissingEdit& missing : update.edits) {
    follows = follows || missing.seq == held;
    if (missing.seq > held) stack.push_back(missing.edit);
  }
  if (!follows) {
    request(chunk, now_us);
    return false;
  }
  auto next = std::make_shared<Chunk>(*chunk.confirmed());
  apply_stack(next->voxels, next->digest, chunk.origin(next->voxels), stack, scratch_);
  if (digest_of(next->voxels) != update.digest) {
    ++counters_.claims_refuted;  // the cached chunk is another server's
    request(chunk, now_us);
    return false;
  }
  counters_.confirmed_stacks.add(stack.size());
  ++counters_.updates_taken;
  next->version = update.to;
  next->digest = update.digest;
  chunks_.set_confirmed(chunk, std::move(next));
  chunk.drop_answered(update.to.seq);
  advance(chunk, true, now_us);
  return true;
}

void ChunkUpdater::set_unavailable(TrackedChunk& chunk, UnavailableReason reason) {
  if (chunk.is_unavailable()) return;
  // A copy of an earlier connection would get no more edits: showing nothing is better than showing
  // something stale.
  chunks_.set_unavailable(chunk);
  shown_.hide(chunk);
  changes_.unavailable({chunk.key, reason});
}

void ChunkUpdater::adopt(TrackedChunk& chunk, ChunkPtr cached, TimeUs now_us) {
  chunk.cached = cached->version;
  chunks_.set_confirmed(chunk, std::move(cached));
  ++counters_.adopted;
  advance(chunk, false, now_us);
}

void ChunkUpdater::add_to_inbox(TrackedChunk& chunk, TrackedChunk::InboxEdit edit, bool may_wait) {
  chunk.inbox.push_back(std::move(edit));
  if (!may_wait) return;
  ++counters_.chunk_edits_buffered;
  const bool has_patch = chunk.inbox.back().patch != nullptr;
  if (chunk.inbox.size() > kInboxEditsMax ||
      (has_patch && TrackedChunk::span_count(chunk.inbox) > kPatchSpansMax)) {
    // chunk.latest remembers what the next snapshot must contain.
    chunk.inbox.clear();
    ++counters_.buffer_overflows;
  }
  chunks_.recount(chunk);
}

void ChunkUpdater::advance(TrackedChunk& chunk, bool from_snapshot, TimeUs now_us) {
  if (!chunk.confirmed() || is_awaiting(chunk.state())) return;
  const TrackedChunk::ReadyEdits taken = chunk.take_ready_edits();
  counters_.chunk_edits_applied += taken.applied.size();
  counters_.chunk_edits_contained += taken.contained.size();
  std::vector<EditChange*> cause;
  // An edit that a snapshot brings before its commit was applied is a change. Any other contained
  // edit is a duplicate.
  if (from_snapshot) {
    for (const OrderedPtr& info : taken.contained) {
      cause.push_back(&changes_.edit(*info, now_us));
      cause.back()->in_snapshot = true;
    }
  }
  for (const OrderedPtr& info : taken.applied) cause.push_back(&changes_.edit(*info, now_us));
  if (!taken.stack.empty() || !taken.patches.empty()) {
    auto next = std::make_shared<Chunk>(*chunk.confirmed());
    apply_ready(taken, chunk.origin(next->voxels), *next);
    next->version = taken.version;
    chunks_.set_confirmed(chunk, std::move(next));
  }
  // Before the server answers for the chunk, a gap is expected: commits overtook the snapshot that
  // closes it.
  if (chunk.latest > taken.version.seq && chunk.is_current()) {
    ++counters_.gaps;
    // A requested snapshot that leaves a gap was made too early. tick() requests the next one after
    // a pause.
    if (from_snapshot && chunk.requested_us && now_us - *chunk.requested_us < kRequestAgainUs) {
      chunks_.request(chunk);
    } else {
      request(chunk, now_us);
    }
  }
  show(chunk, cause);
}

/// Applies edits, and the patches between them.
void ChunkUpdater::apply_ready(const TrackedChunk::ReadyEdits& taken, VoxelPos origin,
                               Chunk& chunk) {
  const std::span<const EditDescriptor> stack(taken.stack);
  std::size_t applied = 0;
  bool is_patched = false;
  const auto apply_up_to = [&](std::size_t end) {
    if (end == applied) return;
    apply_stack(chunk.voxels, chunk.digest, origin, stack.subspan(applied, end - applied),
                scratch_);
    counters_.confirmed_stacks.add(end - applied);
    applied = end;
  };
  for (const TrackedChunk::ReadyEdits::Patch& each : taken.patches) {
    apply_up_to(each.edits);
    is_patched = apply_patch(*each.patch, chunk.voxels) || is_patched;
    ++counters_.patches_applied;
  }
  apply_up_to(stack.size());
  // Once for all patches: it costs O(runs).
  if (is_patched) chunk.digest = digest_of(chunk.voxels);
}

void ChunkUpdater::check_digest(TrackedChunk& chunk, const DigestCheckEntry& check, TimeUs now_us) {
  if (!chunk.confirmed() || is_awaiting(chunk.state())) return;
  const Chunk& held = *chunk.confirmed();
  if (held.version < check.version) {
    // A digest check may overtake commits, but not by a whole round: the commits before the last
    // check are lost.
    if (held.version < chunk.behind_of) {
      ++counters_.fell_behind;
      request(chunk, now_us);
    }
    chunk.behind_of = check.version;
    return;
  }
  if (held.version != check.version) return;
  ++counters_.digests_checked;
  // Computed from the runs, not the digest that followed the edits: the runs are what is meshed.
  if (digest_of(held.voxels) == check.digest) return;
  ++counters_.drifted;
  // The server makes the snapshot after this check, so the snapshot contains every patch that the
  // chunk has. A patch that it lacks must not be applied again.
  chunk.repeatable.clear();
  chunks_.recount(chunk);
  request(chunk, now_us);
}

void ChunkUpdater::predict(TrackedChunk& chunk, const EditDescriptor& edit, EditChange& cause) {
  if (!chunk.shown) return;
  auto next = std::make_shared<RunChunk>(*chunk.shown);
  Digest unused;
  if (!apply_stack(*next, unused, chunk.origin(*next), {&edit, 1}, scratch_).changed) return;
  EditChange* const only = &cause;
  shown_.show(chunk, std::move(next), {&only, 1});
}

void ChunkUpdater::show(TrackedChunk& chunk, std::span<EditChange* const> cause) {
  counters_.predicted_stacks.add(chunk.pending.size());
  shown_.show(chunk, chunk.predicted(scratch_), cause);
}

void ChunkUpdater::request(TrackedChunk& chunk, TimeUs now_us) {
  chunks_.request(chunk);
  chunk.requested_us = now_us;
  const auto place = std::lower_bound(requests_.begin(), requests_.end(), chunk.key);
  if (place != requests_.end() && *place == chunk.key) return;
  requests_.insert(place, chunk.key);
  ++counters_.requests;
}

void ChunkUpdater::tick(TimeUs now_us) {
  for (const ChunkKey& key : chunks_.awaiting()) {
    TrackedChunk& chunk = *chunks_.find(key);
    if (now_us - *chunk.requested_us >= kRequestAgainUs) request(chunk, now_us);
  }
}

}  // namespace runstone
