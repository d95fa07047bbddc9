#include "client/replica/replica.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/layer_diff.hpp"

namespace runstone {

// ---- opening, view

std::vector<ClientSequence> Replica::open(const SessionParameters& opening) {
  if (opening_ && opening_->chunk_edge != opening.chunk_edge) reset();
  std::optional<ServerMark> before;
  if (opening_) before = ServerMark{opening_->epoch, durable_, newest_};
  const KeptVersions kept(before, {opening.epoch, opening.durable, opening.head});
  if (before && before->epoch != opening.epoch) left_.clear();
  past_.reset();
  opening_ = opening;
  durable_ = opening.durable;
  newest_ = opening.head;
  requests_.clear();
  awaiting_.clear();
  current_count_ = unavailable_count_ = 0;
  for (auto& [key, chunk] : chunks_) {
    chunk.current = chunk.unavailable = chunk.claimed = false;
    chunk.inbox.clear();
    chunk.latest = 0;
    chunk.awaiting = false;
    chunk.audited_at = {};
    if (!chunk.confirmed) continue;
    if (!kept.trusts(chunk.confirmed->version)) {
      // The server that ordered this is gone and may not have kept it. What is on the screen stays until the
      // new snapshot.
      chunk.confirmed = nullptr;
      --confirmed_count_;
      ++counters_.dropped_by_epoch;
    }
  }
  const auto offers = own_.resume(opening.resolved);
  for (auto& [key, chunk] : chunks_) {
    for (TrackedChunk::Pending& pending : chunk.pending) {
      const OwnEdit* own = own_.find(pending.seq);
      pending.until_snapshot = own == nullptr || own->resolved;
      pending.decided_at = 0;
    }
  }
  for (const ClientSequence seq : offers) {
    const OwnEdit& own = *own_.find(seq);
    for (const ChunkKey& key : own.chunks) {
      if (TrackedChunk* chunk = find(key)) chunk->add_pending(seq, own.edit);
    }
    ++counters_.own_offered_again;
  }
  settle_own();
  return own_.unanswered();
}

void Replica::reset() {
  for (const auto& [key, chunk] : chunks_) {
    if (chunk.shown) news_.removed(key);
  }
  chunks_.clear();
  confirmed_count_ = current_count_ = unavailable_count_ = 0;
  own_.clear();
  requests_.clear();
  awaiting_.clear();
  left_.clear();
  opening_.reset();
}

void Replica::set_view(const View& view) {
  view_ = view;
  for (auto it = chunks_.begin(); it != chunks_.end();) {
    if (view.contains(it->first.at)) {
      ++it;
      continue;
    }
    const TrackedChunk& chunk = it->second;
    if (chunk.shown) news_.removed(it->first);
    if (keeps_ && chunk.is_to_keep() && !past_ && left_.size() < kLeftMax) {
      left_.emplace_back(it->first, chunk.confirmed);
    }
    if (it->second.confirmed) --confirmed_count_;
    if (it->second.current) --current_count_;
    if (it->second.unavailable) --unavailable_count_;
    awaiting_.erase(it->first);
    it = chunks_.erase(it);
  }
}

TrackedChunk& Replica::track(const ChunkKey& key) {
  const auto [it, fresh] = chunks_.try_emplace(key);
  if (fresh && !past_) {
    const VoxelBox box = box_of(key.at, opening_->chunk_edge);
    for (const auto& [seq, own] : own_.all()) {
      if (!own.resolved && touches(own.edit, box)) it->second.add_pending(seq, own.edit);
    }
  }
  return it->second;
}

TrackedChunk* Replica::find(const ChunkKey& key) {
  const auto it = chunks_.find(key);
  return it == chunks_.end() ? nullptr : &it->second;
}

const TrackedChunk* Replica::find(const ChunkKey& key) const {
  const auto it = chunks_.find(key);
  return it == chunks_.end() ? nullptr : &it->second;
}

// ---- own edits

Result<ClientSequence> Replica::submit(const EditDescriptor& edit, TimeUs submitted_us,
                                       TimeUs now_us) {
  if (!opening_) return fail(ErrorCode::bad_value, "no world is open");
  if (past_) return fail(ErrorCode::bad_value, "the past cannot be edited");
  if (const auto ok = validate(edit); !ok) return Unexpected<Error>{ok.error()};
  if (touched_chunks_bound(edit, opening_->chunk_edge) > kTouchedChunksMax) {
    return fail(ErrorCode::limit_exceeded, "edit touches too many chunks");
  }
  if (!within(edit, opening_->heights)) {
    return fail(ErrorCode::bad_value, "edit reaches above or below the world's heights");
  }
  if (counted_voxels(edit) > opening_->edit_volume_max) {
    return fail(ErrorCode::limit_exceeded, "edit covers more voxels than the server allows");
  }
  if (own_.full()) return fail(ErrorCode::limit_exceeded, "too many own edits wait for the server");

  OwnEdit own;
  own.edit = edit;
  own.submitted_us = submitted_us;
  for (const ChunkCoord at : touched_chunks(edit, opening_->chunk_edge)) {
    const TrackedChunk* chunk = find({0, at});
    if (chunk != nullptr && chunk->unavailable) {
      return fail(ErrorCode::not_found, "edit touches a chunk that the server cannot send");
    }
    own.chunks.push_back({0, at});
  }
  const std::vector<ChunkKey> chunks = own.chunks;
  const ClientSequence seq = own_.add(std::move(own));
  ++counters_.own_submitted;

  EditNews* const news = &news_.prediction({opening_->author, opening_->instance, seq}, now_us);
  for (const ChunkKey& key : chunks) {
    TrackedChunk* chunk = find(key);
    if (chunk == nullptr) continue;
    chunk->add_pending(seq, edit);
    if (!chunk->shown) continue;
    // On top of the stack, so it goes onto what is shown already.
    auto next = std::make_shared<RunChunk>(*chunk->shown);
    Digest unused;
    if (apply_stack(*next, unused, origin(key), {&edit, 1}, scratch_).changed) {
      show(key, *chunk, std::move(next), {&news, 1});
    }
  }
  return seq;
}

void Replica::mark_sent(ClientSequence seq, TimeUs now_us) {
  if (OwnEdit* own = own_.find(seq)) own->sent_us = now_us;
}

bool Replica::is_own(const OperationId& op) const {
  return op.author == opening_->author && op.instance == opening_->instance;
}

// ---- messages

void Replica::receive(ChunkSnapshot snapshot, const Arrival& arrival) {
  if (!opening_ || snapshot.key.lod != 0 || !view_ || !view_->contains(snapshot.key.at)) {
    ++counters_.snapshots_outside;
    return;
  }
  TrackedChunk& chunk = track(snapshot.key);
  const bool was_current = chunk.current;
  set_current(chunk);
  if (past_) {
    // Newer or older than what is held: it is what was asked for.
    if (!chunk.confirmed) ++confirmed_count_;
    ++counters_.snapshots_taken;
    chunk.confirmed = std::make_shared<const Chunk>(std::move(snapshot.chunk));
    show_predicted(snapshot.key, chunk, {});
    return;
  }
  if (chunk.confirmed) {
    const Version held = chunk.confirmed->version;
    // One version has one digest: a copy with another one has drifted.
    const bool has_drifted = snapshot.chunk.version == held &&
                             snapshot.chunk.digest != digest_of(chunk.confirmed->voxels);
    counters_.repaired += has_drifted && was_current ? 1 : 0;
    counters_.claims_refuted += has_drifted && !was_current ? 1 : 0;
    const bool repairs = has_drifted || (chunk.awaiting && snapshot.chunk.version == held);
    if (snapshot.chunk.version <= held && !repairs) {
      if (snapshot.chunk.version < held) ++counters_.snapshots_stale;
      // Nothing new, but what was answered while we could not listen is in here, and so in what we hold.
      const bool settled = chunk.settle_pending(0) != 0;
      if (!chunk.awaiting) {
        settle(snapshot.key, chunk, true, arrival.now_us);
      } else if (settled) {
        show_predicted(snapshot.key, chunk, {});
      }
      return;
    }
  } else {
    ++confirmed_count_;
  }
  ++counters_.snapshots_taken;
  const Sequence seq = snapshot.chunk.version.seq;
  newest_ = std::max(newest_, seq);
  chunk.confirmed = std::make_shared<const Chunk>(std::move(snapshot.chunk));
  set_awaiting(snapshot.key, chunk, false);
  chunk.settle_pending(seq);
  settle(snapshot.key, chunk, true, arrival.now_us);
}

void Replica::set_current(TrackedChunk& chunk) {
  if (!std::exchange(chunk.current, true)) ++current_count_;
  if (std::exchange(chunk.unavailable, false)) --unavailable_count_;
}

/// The server says that what is held was its chunk when it subscribed us: commits since then have come, or will.
void Replica::vouched_for(const ChunkKey& key, TrackedChunk& chunk, TimeUs now_us) {
  chunk.settle_pending(0);  // answered while we could not listen: it is in here
  settle(key, chunk, true, now_us);
}

void Replica::receive(const ChunksNotModified& same, TimeUs now_us) {
  if (!opening_ || past_) return;
  for (const UnmodifiedChunk& said : same.chunks) {
    if (!view_ || !view_->contains(said.key.at)) continue;
    TrackedChunk& chunk = track(said.key);
    set_current(chunk);
    ++counters_.same_taken;
    if (chunk.awaiting) continue;
    if (!chunk.confirmed || chunk.confirmed->version.seq < said.seq) {
      // It left the view and came back, and the copy that was claimed is gone.
      request(said.key, chunk, now_us);
    } else {
      vouched_for(said.key, chunk, now_us);
    }
  }
}

void Replica::receive(const ChunkEdits& update, const Arrival& arrival) {
  if (!opening_ || past_) return;
  if (!view_ || !view_->contains(update.key.at)) {
    ++counters_.snapshots_outside;
    return;
  }
  TrackedChunk& chunk = track(update.key);
  set_current(chunk);
  if (chunk.awaiting) return;
  if (!chunk.confirmed) return request(update.key, chunk, arrival.now_us);
  const Sequence held = chunk.confirmed->version.seq;
  if (held >= update.to.seq) return vouched_for(update.key, chunk, arrival.now_us);
  // Commits that came for another chunk's sake may have led part of the way.
  bool fits = held == update.from;
  std::vector<EditDescriptor> stack;
  for (const MissingEdit& missing : update.edits) {
    fits = fits || missing.seq == held;
    if (missing.seq > held) stack.push_back(missing.edit);
  }
  if (!fits) return request(update.key, chunk, arrival.now_us);
  auto next = std::make_shared<Chunk>(*chunk.confirmed);
  apply_stack(next->voxels, next->digest, origin(update.key), stack, scratch_);
  if (digest_of(next->voxels) != update.digest) {
    ++counters_.claims_refuted;  // what was kept is another server's
    return request(update.key, chunk, arrival.now_us);
  }
  counters_.confirmed_stacks.add(stack.size());
  ++counters_.updates_taken;
  next->version = update.to;
  next->digest = update.digest;
  newest_ = std::max(newest_, update.to.seq);
  chunk.confirmed = std::move(next);
  chunk.settle_pending(update.to.seq);
  settle(update.key, chunk, true, arrival.now_us);
}

void Replica::receive(const UniformChunks& uniform, const Arrival& arrival) {
  if (!opening_) return;
  const Extent extent = Extent::cube(static_cast<unsigned>(opening_->chunk_edge));
  Chunk chunk;
  for (const UniformChunk& each : uniform.chunks) {
    // Most are like the one before: all air, all stone.
    if (chunk.voxels.runs.size() == 0 || material_at(chunk.voxels, {0, 0, 0}) != each.material) {
      chunk.voxels = uniform_chunk(extent, each.material);
      chunk.digest = digest_of(chunk.voxels);
    }
    chunk.version = each.version;
    receive(ChunkSnapshot{each.key, chunk}, arrival);
  }
}

void Replica::receive(const ChunkUnavailable& unavailable) {
  if (!opening_) return;
  for (const ChunkKey& key : unavailable.keys) {
    if (key.lod != 0 || !view_ || !view_->contains(key.at)) continue;
    TrackedChunk& chunk = track(key);
    if (std::exchange(chunk.unavailable, true)) continue;
    ++unavailable_count_;
    // What was held from an earlier connection gets no more edits: better nothing than something stale.
    if (std::exchange(chunk.current, false)) --current_count_;
    if (std::exchange(chunk.confirmed, nullptr)) --confirmed_count_;
    const ShownPtr was_shown = std::exchange(chunk.shown, nullptr);
    chunk.serial = 0;
    set_awaiting(key, chunk, false);
    chunk.inbox.clear();
    news_.removed(key);  // also where nothing was shown: neighbours wait for it no longer
    for (int i = 0; was_shown && i < kDirectionCount; ++i) {
      const auto d = static_cast<Direction>(i);
      border_changed({key.lod, neighbour(key.at, d)}, opposite(d), all_layers(was_shown->extent),
                     {});
    }
    news_.unavailable({key, unavailable.reason});
  }
}

Result<void> Replica::receive(const Commit& commit, const Arrival& arrival) {
  if (!opening_) return fail(ErrorCode::bad_value, "commit before ready");
  if (commit.epoch != opening_->epoch) return fail(ErrorCode::bad_value, "commit of another epoch");
  ++counters_.commits;
  std::map<ChunkKey, TrackedChunk*> settling;
  for (std::size_t i = 0; i < commit.edits.size(); ++i) {
    const OrderedEdit& ordered = commit.edits[i];
    const Version version{commit.epoch, commit.first + i};
    const auto chunks = touched_chunks(ordered.edit, opening_->chunk_edge);
    if (chunks.size() != ordered.previous.size()) {
      return fail(ErrorCode::bad_value, "previous sequences do not fit the edit", i);
    }
    newest_ = std::max(newest_, version.seq);
    const bool own = is_own(ordered.op);
    // Most commits touch chunks in view; the others are not worth an allocation.
    OrderedPtr info;
    const auto shared_info = [&] {
      if (!info) {
        info = std::make_shared<const OrderedInfo>(OrderedInfo{
            ordered.op, version, ordered.edit, ordered.subject, own, ordered.submitted_us,
            ordered.ordered_us, arrival.received_us, arrival.unpacked_us});
      }
      return info;
    };
    if (own) {
      if (OwnEdit* held = own_.find(ordered.op.seq)) {
        if (!held->resolved) ++counters_.own_confirmed;
        held->resolved = true;
        held->asked = held->unseen = false;
        held->version = version;
        if (version.seq <= durable_) settle_own();
      }
      news_.edit(*shared_info(), arrival.now_us);
    }
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const ChunkKey key{0, chunks[c]};
      if (!view_ || !view_->contains(key.at)) continue;
      TrackedChunk& chunk = track(key);
      chunk.latest = std::max(chunk.latest, version.seq);
      if (own) {
        for (TrackedChunk::Pending& pending : chunk.pending) {
          if (pending.seq == ordered.op.seq) pending.decided_at = version.seq;
        }
      }
      if (chunk.unavailable) continue;
      chunk.inbox.push_back({shared_info(), ordered.previous[c]});
      if (!chunk.current || chunk.awaiting) {
        ++counters_.chunk_edits_buffered;
        if (chunk.inbox.size() > kInboxEditsMax) {
          // Whoever falls this far behind is served by a newer snapshot: `latest` remembers what it must
          // contain.
          chunk.inbox.clear();
          ++counters_.buffer_overflows;
        }
      }
      settling[key] = &chunk;
    }
  }
  for (const auto& [key, chunk] : settling) settle(key, *chunk, false, arrival.now_us);
  return {};
}

void Replica::receive(const Reject& reject, TimeUs now_us) {
  OwnEdit* own = own_.find(reject.client_seq);
  if (own == nullptr || (own->resolved && !own->asked))
    return;  // applied after all, or taken back before
  const bool decided_unseen = reject.reason == RejectReason::already_resolved;
  for (const ChunkKey& key : own->chunks) {
    TrackedChunk* chunk = find(key);
    if (chunk == nullptr) continue;
    if (decided_unseen) {
      for (TrackedChunk::Pending& pending : chunk->pending) {
        if (pending.seq == reject.client_seq) pending.until_snapshot = true;
      }
      // Its commit never reached us, so this copy may lack it; after a resumption every chunk comes anew
      // anyway.
      if (chunk->confirmed && !own->asked && !past_) request(key, *chunk, now_us);
      continue;
    }
    if (chunk->drop_pending(reject.client_seq) && chunk->confirmed) show_predicted(key, *chunk, {});
  }
  if (decided_unseen) {
    own->resolved = own->unseen = true;
    own->asked = false;
    own->version = {opening_->epoch, reject.seq != 0 ? reject.seq : newest_};
    return settle_own();
  }
  own_.erase(reject.client_seq);
  ++counters_.own_rejected;
  news_.reject({reject.client_seq, reject.reason, reject.detail});
}

void Replica::receive(const Durable& durable) {
  if (!opening_ || durable.epoch != opening_->epoch) return;
  durable_ = std::max(durable_, durable.seq);
  newest_ = std::max(newest_, durable.seq);
  settle_own();
}

void Replica::settle_own() {
  const auto settled = own_.take_durable(durable_);
  counters_.own_durable += settled.durable.size();
  news_.durable(settled.durable);
  news_.unseen(settled.unseen);
}

void Replica::receive(const DigestCheck& audit, TimeUs now_us) {
  if (past_) return;
  for (const DigestCheckEntry& theirs : audit.entries) {
    TrackedChunk* chunk = find(theirs.key);
    if (chunk == nullptr || !chunk->confirmed || chunk->awaiting) continue;
    const Chunk& ours = *chunk->confirmed;
    if (ours.version < theirs.version) {
      // An audit may overtake commits, but not by a whole round: what the last one told has got lost.
      if (ours.version < chunk->audited_at) {
        ++counters_.fell_behind;
        request(theirs.key, *chunk, now_us);
      }
      chunk->audited_at = theirs.version;
      continue;
    }
    if (ours.version != theirs.version) continue;
    ++counters_.audited;
    // From the runs, not from the digest that followed the edits: the runs are what is meshed.
    if (digest_of(ours.voxels) == theirs.digest) continue;
    ++counters_.drifted;
    request(theirs.key, *chunk, now_us);
  }
}

void Replica::begin_moment(const std::optional<PastMoment>& past) {
  if (!opening_) return;
  const bool from_past = past_.has_value();
  past_ = past;
  requests_.clear();
  awaiting_.clear();
  unavailable_count_ = 0;
  if (!from_past || !past)
    current_count_ = 0;  // from moment to moment, what is not sent again is the same
  for (auto& [key, chunk] : chunks_) {
    chunk.unavailable = chunk.awaiting = false;
    chunk.audited_at = {};
    chunk.kept.reset();
    if (!from_past || !past) chunk.current = false;
    if (past) {
      chunk.pending.clear();
      chunk.inbox.clear();
      chunk.latest = 0;
      if (chunk.confirmed) show_predicted(key, chunk, {});
    }
  }
  if (past) return;
  for (const auto& [seq, own] : own_.all()) {
    if (own.resolved) continue;
    for (const ChunkKey& key : own.chunks) {
      if (TrackedChunk* chunk = find(key)) chunk->add_pending(seq, own.edit);
    }
  }
}

// ---- chunks kept for later

void Replica::adopt(const ChunkKey& key, ChunkPtr chunk, TimeUs now_us) {
  if (!opening_ || past_ || !view_ || !view_->contains(key.at)) return;
  TrackedChunk& mine = track(key);
  if (mine.confirmed || mine.current || mine.unavailable) return;
  mine.kept = chunk->version;
  mine.confirmed = std::move(chunk);
  ++confirmed_count_;
  ++counters_.adopted;
  settle(key, mine, false, now_us);
}

std::vector<CachedChunk> Replica::take_claims() {
  std::vector<CachedChunk> claims;
  if (!opening_ || past_) return claims;
  std::size_t waiting = 0;
  for (const auto& [key, chunk] : chunks_) waiting += chunk.claimed && !chunk.current ? 1 : 0;
  for (auto& [key, chunk] : chunks_) {
    if (waiting + claims.size() >= kClaimsMax) break;
    if (!chunk.confirmed || chunk.current || chunk.claimed || chunk.awaiting) continue;
    chunk.claimed = true;
    claims.push_back(
        {key, chunk.confirmed->version, claim_digest(digest_of(chunk.confirmed->voxels))});
  }
  counters_.claimed += claims.size();
  return claims;
}

std::vector<ChunkKey> Replica::missing() const {
  std::vector<ChunkKey> keys;
  if (!opening_ || past_ || !view_) return keys;
  const std::int32_t limit = kWorldLimit / opening_->chunk_edge;
  const auto is_inside = [limit](std::int32_t c) { return c >= -limit && c < limit; };
  const View& v = *view_;
  const std::int32_t h = v.radius_h, up = v.radius_v;
  for (std::int32_t x = v.centre.x - h; x <= v.centre.x + h; ++x) {
    for (std::int32_t y = v.centre.y - up; y <= v.centre.y + up; ++y) {
      for (std::int32_t z = v.centre.z - h; z <= v.centre.z + h; ++z) {
        const ChunkKey key{0, {x, y, z}};
        if (!v.contains(key.at) || !is_inside(x) || !is_inside(y) || !is_inside(z)) continue;
        const TrackedChunk* chunk = find(key);
        if (chunk == nullptr || (!chunk->confirmed && !chunk->current && !chunk->unavailable))
          keys.push_back(key);
      }
    }
  }
  return keys;
}

std::vector<std::pair<ChunkKey, ChunkPtr>> Replica::take_unkept(std::size_t count_max) {
  const std::size_t left = std::min(count_max, left_.size());
  const auto end = left_.begin() + static_cast<std::ptrdiff_t>(left);
  std::vector<std::pair<ChunkKey, ChunkPtr>> out(left_.begin(), end);
  left_.erase(left_.begin(), end);
  if (past_) return out;
  for (auto& [key, chunk] : chunks_) {
    if (out.size() >= count_max) break;
    if (!chunk.is_to_keep()) continue;
    chunk.kept = chunk.confirmed->version;
    out.emplace_back(key, chunk.confirmed);
  }
  return out;
}

void Replica::tick(TimeUs now_us) {
  for (const ChunkKey& key : awaiting_) {
    TrackedChunk& chunk = *find(key);
    if (now_us - *chunk.requested_us >= kRequestAgainUs) request(key, chunk, now_us);
  }
}

// ---- one chunk

/// Applies what the inbox holds in order, asks for a snapshot at a gap, and shows the outcome.
void Replica::settle(const ChunkKey& key, TrackedChunk& chunk, bool from_snapshot, TimeUs now_us) {
  if (!chunk.confirmed || chunk.awaiting || past_) return;
  const TrackedChunk::InOrder in_order = chunk.take_in_order();
  counters_.chunk_edits_applied += in_order.applied.size();
  counters_.chunk_edits_contained += in_order.contained.size();
  std::vector<EditNews*> cause;
  // A duplicate is no news; an edit that a snapshot brings before its commit could be applied is.
  if (from_snapshot) {
    for (const OrderedPtr& info : in_order.contained) {
      cause.push_back(&news_.edit(*info, now_us));
      cause.back()->in_snapshot = true;
    }
  }
  for (const OrderedPtr& info : in_order.applied) cause.push_back(&news_.edit(*info, now_us));
  if (!in_order.stack.empty()) {
    auto next = std::make_shared<Chunk>(*chunk.confirmed);
    apply_stack(next->voxels, next->digest, origin(key), in_order.stack, scratch_);
    counters_.confirmed_stacks.add(in_order.stack.size());
    next->version = in_order.version;
    chunk.confirmed = std::move(next);
  }
  // Without a snapshot of this connection a gap is no surprise: it was overtaken, and closes what is missing.
  if (chunk.latest > in_order.version.seq && chunk.current) {
    ++counters_.gaps;
    // A snapshot that still leaves a gap was taken too early; the next one is asked for after a pause, by
    // tick().
    if (from_snapshot && chunk.requested_us && now_us - *chunk.requested_us < kRequestAgainUs) {
      set_awaiting(key, chunk, true);
    } else {
      request(key, chunk, now_us);
    }
  }
  show_predicted(key, chunk, cause);
}

void Replica::set_awaiting(const ChunkKey& key, TrackedChunk& chunk, bool awaiting) {
  if (std::exchange(chunk.awaiting, awaiting) == awaiting) return;
  if (awaiting) {
    awaiting_.insert(key);
  } else {
    awaiting_.erase(key);
  }
}

void Replica::request(const ChunkKey& key, TrackedChunk& chunk, TimeUs now_us) {
  set_awaiting(key, chunk, true);
  chunk.requested_us = now_us;
  const auto place = std::lower_bound(requests_.begin(), requests_.end(), key);
  if (place != requests_.end() && *place == key) return;
  requests_.insert(place, key);
  ++counters_.requests;
}

void Replica::show_predicted(const ChunkKey& key, TrackedChunk& chunk,
                             std::span<EditNews* const> cause) {
  counters_.predicted_stacks.add(chunk.pending.size());
  show(key, chunk, chunk.predicted(origin(key), scratch_), cause);
}

/// Replaces the shown runs, and tells the mesher if any voxel differs.
void Replica::show(const ChunkKey& key, TrackedChunk& chunk, ShownPtr next,
                   std::span<EditNews* const> cause) {
  const bool whole = chunk.shown == nullptr;
  const Extent extent = next->extent;
  const DirtyLayers dirty = whole                 ? all_layers(extent)
                            : chunk.shown == next ? DirtyLayers{}
                                                  : changed_layers(*chunk.shown, *next);
  chunk.shown = std::move(next);
  if (!dirty.any()) return;
  chunk.serial = ++last_serial_;

  ChunkNews& own = news_.chunk(key);
  own.serial = chunk.serial;
  own.layers.dirty |= dirty;
  own.whole = own.whole || whole;
  own.removed = false;
  ChangeQueue::attribute(own, cause);
  // Neighbours learn of a new chunk by its news: whether they waited for it is theirs to know.
  if (whole) return;
  for (int i = 0; i < kDirectionCount; ++i) {
    const auto d = static_cast<Direction>(i);
    if (border_dirty(dirty, d, extent.sides()[static_cast<std::size_t>(axis_of(d))])) {
      border_changed({key.lod, neighbour(key.at, d)}, opposite(d), dirty, cause);
    }
  }
}

/// Tells the mesher that what lies beside a chunk on this side is different now, in these of its layers.
void Replica::border_changed(const ChunkKey& key, Direction side, const DirtyLayers& dirty,
                             std::span<EditNews* const> cause) {
  TrackedChunk* chunk = find(key);
  if (chunk == nullptr || !chunk->shown) return;
  chunk->serial = ++last_serial_;
  ChunkNews& border = news_.chunk(key);
  border.serial = chunk->serial;
  border.layers.beyond[static_cast<std::size_t>(side)] |= dirty;
  ChangeQueue::attribute(border, cause);
}

std::vector<ChunkKey> Replica::take_requests() { return std::exchange(requests_, {}); }

// ---- reading

ChunkPtr Replica::confirmed(const ChunkKey& key) const {
  const TrackedChunk* chunk = find(key);
  return chunk == nullptr ? nullptr : chunk->confirmed;
}

ShownPtr Replica::shown(const ChunkKey& key) const {
  const TrackedChunk* chunk = find(key);
  return chunk == nullptr ? nullptr : chunk->shown;
}

std::uint64_t Replica::shown_serial(const ChunkKey& key) const {
  const TrackedChunk* chunk = find(key);
  return chunk == nullptr ? 0 : chunk->serial;
}

std::optional<Material> Replica::shown_at(VoxelPos at) const {
  if (!opening_) return std::nullopt;
  const ShownPtr chunk = shown({0, chunk_of(at, opening_->chunk_edge)});
  if (!chunk) return std::nullopt;
  return material_at(*chunk, local_of(at, opening_->chunk_edge));
}

std::vector<ChunkKey> Replica::confirmed_keys() const {
  std::vector<ChunkKey> keys;
  keys.reserve(confirmed_count_);
  for (const auto& [key, chunk] : chunks_) {
    if (chunk.confirmed) keys.push_back(key);
  }
  return keys;
}

}  // namespace runstone
