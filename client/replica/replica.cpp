#include "client/replica/replica.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <set>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/view_size.hpp"

namespace runstone {

// Connection and view.

std::vector<ClientSequence> Replica::open(const SessionParameters& parameters) {
  if (parameters_ && parameters_->chunk_edge != parameters.chunk_edge) reset();
  std::optional<ServerMark> before;
  if (parameters_) before = ServerMark{parameters_->epoch, durable_, newest_};
  const bool is_other_kind = parameters_ && parameters_->is_veiled != parameters.is_veiled;
  if (is_other_kind || (before && before->epoch != parameters.epoch)) outbox_.clear();
  past_.reset();
  views_.reopen();
  claims_.clear();
  ground_.clear();
  updater_.clear_requests();
  parameters_ = parameters;
  has_resumed_ = false;
  if (view()) far_tiles_.set_view(*view(), parameters.chunk_edge);
  durable_ = parameters.durable;
  newest_ = parameters.head;
  const SharedHistory history(before, {parameters.epoch, parameters.durable, parameters.head});
  expect_all_chunks(history, is_other_kind);
  far_tiles_.reopen(parameters.tile_rules,
                    [&](const Version& version) { return history.trusts(version); });
  const auto offers = local_edits_.resume(parameters.resolved);
  for (auto& [key, chunk] : chunks_) {
    for (TrackedChunk::PendingEdit& pending : chunk.pending) {
      const LocalEdit* local = local_edits_.find(pending.seq);
      pending.until_snapshot = local == nullptr || local->state != LocalEditState::pending;
      pending.confirmed_at = 0;
    }
  }
  for (const ClientSequence seq : offers) add_pending_to_chunks(seq);
  retire_durable();
  return local_edits_.unanswered();
}

void Replica::expect_all_chunks(const SharedHistory& history, bool is_other_kind) {
  for (auto& [key, chunk] : chunks_) {
    chunks_.expect(chunk);
    chunk.inbox.clear();
    chunk.repeatable.clear();
    chunk.latest = 0;
    chunk.behind_of = {};
    // The cache has a chunk of the other kind, perhaps with the version that the chunk will get.
    if (is_other_kind) chunk.cached.reset();
    chunks_.recount(chunk);
    if (!chunk.confirmed()) continue;
    const bool is_trusted = history.trusts(chunk.confirmed()->version);
    if (is_trusted && !is_other_kind) continue;
    // The server that ordered this version may not have kept it, or its versions are of chunks of
    // the other kind. What is shown stays until the new snapshot.
    chunks_.set_confirmed(chunk, nullptr);
    if (!is_trusted) ++counters_.dropped_by_epoch;
  }
}

void Replica::reset() {
  for (const auto& [key, chunk] : chunks_) updater_.forget(chunk);
  chunks_.clear();
  far_tiles_.clear();
  claims_.clear();
  local_edits_.clear();
  ground_.clear();
  updater_.clear_requests();
  outbox_.clear();
  parameters_.reset();
}

void Replica::set_view(const View& view) {
  views_.set(view);
  if (parameters_) far_tiles_.set_view(view, parameters_->chunk_edge);
  claims_.forget_tiles_outside(view);
  chunks_.erase_if([&](const TrackedChunk& chunk) {
    if (view.contains(chunk.key.at)) return false;
    updater_.forget(chunk);
    if (!past_.is_past()) outbox_.add(chunk);
    claims_.forget(chunk.key);
    return true;
  });
}

TrackedChunk& Replica::track(const ChunkKey& key) {
  const auto [chunk, is_new] = chunks_.track(key);
  if (is_new && !past_.is_past()) {
    const VoxelBox box = box_of(key.at, parameters_->chunk_edge);
    for (const auto& [seq, local] : local_edits_.all()) {
      if (local.state == LocalEditState::pending && touches(local.edit, box)) {
        chunk->add_pending(seq, local.edit);
      }
    }
    chunks_.recount(*chunk);
  }
  return *chunk;
}

void Replica::show_moment(const std::optional<PastMoment>& past) {
  if (!parameters_) return;
  past_.show(past, chunks_);
  updater_.clear_requests();
  if (past) {
    for (auto& [key, chunk] : chunks_) {
      if (chunk.confirmed()) updater_.show(chunk);
    }
    return;
  }
  for (const auto& [seq, local] : local_edits_.all()) {
    if (local.state == LocalEditState::pending) add_pending_to_chunks(seq);
  }
}

// Local edits.

Result<ClientSequence> Replica::predict(const EditDescriptor& edit, TimeUs submitted_us,
                                        TimeUs now_us, InAction in_action) {
  if (const auto ok = check(edit); !ok) return failure(ok.error());
  std::vector<ChunkKey> keys;
  for (const ChunkCoord at : touched_chunks(edit, parameters_->chunk_edge)) {
    keys.push_back({0, at});
    if (unavailable(keys.back())) {
      return fail(ErrorCode::not_found, "edit touches a chunk that the server cannot send");
    }
  }
  const auto seq = local_edits_.add(edit, keys, submitted_us, in_action);
  if (!seq) return seq;
  EditChange& change =
      changes_.prediction({parameters_->author, parameters_->instance, *seq}, now_us);
  for (const ChunkKey& key : keys) {
    TrackedChunk* chunk = chunks_.find(key);
    if (chunk == nullptr) continue;
    chunk->add_pending(*seq, edit);
    chunks_.recount(*chunk);
    updater_.predict(*chunk, edit, change);
  }
  return seq;
}

Result<void> Replica::check(const EditDescriptor& edit) const {
  if (!parameters_) return fail(ErrorCode::bad_value, "no world is open");
  if (past_.is_past()) return fail(ErrorCode::bad_value, "the past cannot be edited");
  if (const auto ok = validate(edit); !ok) return failure(ok.error());
  switch (check_edit(edit, parameters_->edit_limits()).value_or(RejectReason{})) {
    case RejectReason::unknown_material:
      return fail(ErrorCode::not_found, "material is not in the world's table");
    case RejectReason::outside_world:
      return fail(ErrorCode::bad_value, "edit reaches above or below the world's heights");
    case RejectReason::too_large:
      return fail(ErrorCode::limit_exceeded, "edit covers more voxels or chunks than allowed");
    default:
      break;
  }
  if (ground_.refusal(edit)) return fail(ErrorCode::not_permitted, "you may not edit there");
  return {};
}

void Replica::add_pending_to_chunks(ClientSequence seq) {
  const LocalEdit& local = *local_edits_.find(seq);
  for (const ChunkKey& key : local.chunks) {
    TrackedChunk* chunk = chunks_.find(key);
    if (chunk == nullptr) continue;
    chunk->add_pending(seq, local.edit);
    chunks_.recount(*chunk);
  }
}

void Replica::confirm_local(ClientSequence seq, const Version& version) {
  if (local_edits_.confirm(seq, version) && version.seq <= durable_) retire_durable();
}

void Replica::retire_durable() {
  const LocalEdits::Retired retired = local_edits_.retire(durable_);
  changes_.durable(retired.durable);
  changes_.unseen(retired.unseen);
}

void Replica::receive(const Reject& reject, TimeUs now_us, bool is_offered_again) {
  if (!parameters_) return;
  const auto rejection = local_edits_.reject(reject, {parameters_->epoch, newest_});
  if (!rejection) return;
  for (const ChunkKey& key : rejection->edit.chunks) {
    TrackedChunk* chunk = chunks_.find(key);
    if (chunk == nullptr) continue;
    if (!rejection->is_resolved) {
      if (chunk->drop_pending(reject.client_seq) && chunk->confirmed()) updater_.show(*chunk);
      continue;
    }
    chunk->leave_to_snapshot(reject.client_seq);
    // The commit never arrived, so the confirmed chunk may lack it. If the answer was asked for
    // after a reconnection, every chunk arrives anew, but not after resume().
    const bool may_lack = rejection->edit.state == LocalEditState::pending || has_resumed_;
    if (chunk->confirmed() && may_lack && !past_.is_past()) updater_.request(*chunk, now_us);
  }
  if (rejection->is_resolved) return retire_durable();
  changes_.reject({reject.client_seq, reject.reason, reject.detail, is_offered_again});
}

std::vector<ClientSequence> Replica::resume(ClientSequence resolved) {
  has_resumed_ = true;
  local_edits_.resume(resolved);
  return local_edits_.unanswered();
}

void Replica::receive(const Durable& durable) {
  if (!parameters_ || durable.epoch < parameters_->epoch) return;
  parameters_->epoch = durable.epoch;
  durable_ = std::max(durable_, durable.seq);
  newest_ = std::max(newest_, durable.seq);
  retire_durable();
}

// Chunks and commits.

/// Returns true if an answer to this view counts for the chunk.
bool Replica::accepts(const ChunkKey& key, std::uint32_t view) {
  if (views_.accepts(key, view)) return true;
  ++counters_.answers_outside;
  return false;
}

void Replica::receive(Chunks chunks, const Arrival& arrival) {
  if (!parameters_) return;
  for (ChunkAnswer& answer : chunks.chunks) {
    if (key_of(answer).lod > 0) {
      receive_tile(answer);
      continue;
    }
    if (!accepts(key_of(answer), chunks.view)) continue;
    if (auto* snapshot = std::get_if<ChunkSnapshot>(&answer)) {
      receive_snapshot(snapshot->key, std::move(snapshot->chunk), arrival.now_us);
    } else {
      receive_missing_edits(std::get<ChunkEdits>(answer), arrival.now_us);
    }
  }
}

void Replica::receive_tile(ChunkAnswer& answer) {
  auto* const tile = std::get_if<ChunkSnapshot>(&answer);
  claims_.answer(key_of(answer));
  if (tile == nullptr || !far_tiles_.receive(tile->key, std::move(tile->chunk)))
    ++counters_.answers_outside;
}

void Replica::receive_snapshot(const ChunkKey& key, Chunk snapshot, TimeUs now_us) {
  TrackedChunk& chunk = track(key);
  claims_.answer(key);
  if (past_.is_past()) return updater_.replace(chunk, std::move(snapshot));
  const Sequence seq = snapshot.version.seq;
  if (updater_.apply_snapshot(chunk, std::move(snapshot), now_us)) newest_ = std::max(newest_, seq);
}

void Replica::receive_missing_edits(const ChunkEdits& edits, TimeUs now_us) {
  if (past_.is_past()) return;
  claims_.answer(edits.key);
  if (updater_.apply_missing_edits(track(edits.key), edits, now_us)) {
    newest_ = std::max(newest_, edits.to.seq);
  }
}

void Replica::receive(const ChunksNotModified& same, TimeUs now_us) {
  if (!parameters_) return;
  for (const UnmodifiedChunk& entry : same.chunks) {
    if (entry.key.lod > 0) {
      claims_.answer(entry.key);
      const bool is_held = far_tiles_.receive_not_modified(entry.key, entry.seq);
      ++(is_held ? counters_.tiles_same : counters_.answers_outside);
      continue;
    }
    if (past_.is_past()) return;
    if (!accepts(entry.key, same.view)) continue;
    claims_.answer(entry.key);
    updater_.apply_not_modified(track(entry.key), entry.seq, now_us);
  }
}

void Replica::receive(const UniformChunks& uniform, const Arrival& arrival) {
  if (!parameters_) return;
  const Extent extent = Extent::cube(static_cast<unsigned>(parameters_->chunk_edge));
  Chunk chunk;
  for (const UniformChunk& each : uniform.chunks) {
    if (each.key.lod > 0) {
      claims_.answer(each.key);
      if (!far_tiles_.receive_uniform(each.key, each.material)) ++counters_.answers_outside;
      continue;
    }
    if (!accepts(each.key, uniform.view)) continue;
    // Most chunks are of the material of the one before: air or stone.
    if (chunk.voxels.runs.size() == 0 || material_at(chunk.voxels, {0, 0, 0}) != each.material) {
      chunk.voxels = uniform_chunk(extent, each.material);
      chunk.digest = digest_of(chunk.voxels);
    }
    chunk.version = each.version;
    receive_snapshot(each.key, chunk, arrival.now_us);
  }
}

void Replica::receive(const ChunkUnavailable& unavailable) {
  if (!parameters_) return;
  for (const ChunkKey& key : unavailable.keys) {
    if (!accepts(key, unavailable.view)) continue;
    claims_.answer(key);
    updater_.set_unavailable(track(key), unavailable.reason);
  }
}

Result<void> Replica::receive(const Commit& commit, const Arrival& arrival) {
  if (!parameters_) return fail(ErrorCode::bad_value, "commit before ready");
  if (commit.epoch != parameters_->epoch) {
    return fail(ErrorCode::bad_value, "commit of another epoch");
  }
  ++counters_.commits;
  Touched touched;
  for (std::size_t i = 0; i < commit.edits.size(); ++i) {
    const OrderedEdit& ordered = commit.edits[i];
    const Version version{commit.epoch, ordered.seq};
    const auto chunks = touched_chunks(ordered.edit, parameters_->chunk_edge);
    if (chunks.size() != ordered.previous.size()) {
      return fail(ErrorCode::bad_value, "previous sequences do not fit the edit", i);
    }
    newest_ = std::max(newest_, version.seq);
    OrderedPtr info;  // allocated only if a chunk in view is touched, or the edit is local
    const auto shared_info = [&] {
      if (!info) info = ordered_info(ordered, version, arrival);
      return info;
    };
    if (is_local(ordered)) {
      confirm_local(ordered.op.seq, version);
      changes_.edit(*shared_info(), arrival.now_us);
    }
    for (std::size_t c = 0; c < chunks.size(); ++c) {
      const ChunkKey key{0, chunks[c]};
      if (is_in_view(key))
        add_to_chunk(key, {shared_info(), ordered.previous[c], version}, touched);
    }
  }
  advance(touched, arrival.now_us);
  return {};
}

OrderedPtr Replica::ordered_info(const OrderedEdit& ordered, const Version& version,
                                 const Arrival& arrival) const {
  return std::make_shared<const OrderedInfo>(OrderedInfo{
      ordered.op, version, ordered.edit, ordered.subject, is_local(ordered), ordered.submitted_us,
      ordered.ordered_us, arrival.received_us, arrival.unpacked_us});
}

void Replica::add_to_chunk(const ChunkKey& key, TrackedChunk::InboxEdit entry, Touched& touched) {
  TrackedChunk& chunk = track(key);
  chunk.latest = std::max(chunk.latest, entry.version.seq);
  if (entry.info && entry.info->is_local)
    chunk.confirm_pending(entry.info->op.seq, entry.version.seq);
  if (chunk.is_unavailable()) return;
  updater_.add_to_inbox(chunk, std::move(entry), !chunk.is_current() || past_.is_past());
  touched[key] = &chunk;
}

void Replica::advance(const Touched& touched, TimeUs now_us) {
  if (past_.is_past()) return;
  for (const auto& [key, chunk] : touched) updater_.advance(*chunk, now_us);
}

Result<void> Replica::receive(const VeiledCommit& commit, const Arrival& arrival) {
  if (!parameters_) return fail(ErrorCode::bad_value, "commit before ready");
  if (commit.epoch != parameters_->epoch) {
    return fail(ErrorCode::bad_value, "commit of another epoch");
  }
  ++counters_.commits;
  Touched touched;
  for (const VeiledEdit& edit : commit.edits) {
    if (const auto ok = add_veiled(edit, commit.epoch, arrival, touched); !ok) return ok;
  }
  advance(touched, arrival.now_us);
  return {};
}

Result<void> Replica::add_veiled(const VeiledEdit& edit, Epoch epoch, const Arrival& arrival,
                                 Touched& touched) {
  const OrderedEdit& ordered = edit.ordered;
  const Version version{epoch, ordered.seq};
  std::vector<ChunkCoord> chunks;
  if (edit.has_edit) chunks = touched_chunks(ordered.edit, parameters_->chunk_edge);
  if (chunks.size() != ordered.previous.size())
    return fail(ErrorCode::bad_value, "previous sequences do not fit the edit");
  newest_ = std::max(newest_, version.seq);
  const OrderedPtr info = ordered_info(ordered, version, arrival);
  std::vector<ChunkKey> predicted;  // chunks with a prediction of the edit
  if (info->is_local) {
    if (const LocalEdit* local = local_edits_.find(ordered.op.seq)) predicted = local->chunks;
    confirm_local(ordered.op.seq, version);
    changes_.edit(*info, arrival.now_us);
  }
  std::map<ChunkCoord, const ChunkPatch*> patches;
  for (const ChunkPatch& patch : edit.patches) patches.emplace(patch.at, &patch);
  const auto patch_of = [](const ChunkPatch& patch) {
    return std::make_shared<const VeilPatch>(patch.patch);
  };
  std::set<ChunkKey> changed;
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    const ChunkKey key{0, chunks[c]};
    TrackedChunk::InboxEdit entry{info, ordered.previous[c], version};
    if (const auto found = patches.find(chunks[c]); found != patches.end()) {
      if (found->second->previous != ordered.seq)
        return fail(ErrorCode::bad_value, "a patch does not follow the edit of its chunk");
      entry.patch = patch_of(*found->second);
      patches.erase(found);
    }
    if (is_in_view(key)) add_to_chunk(key, std::move(entry), touched);
    changed.insert(key);
  }
  for (const auto& [at, patch] : patches) {
    const ChunkKey key{0, at};
    if (patch->previous == ordered.seq)
      return fail(ErrorCode::bad_value, "a patch follows an edit that misses its chunk");
    if (is_in_view(key))
      add_to_chunk(key, {info, patch->previous, version, false, patch_of(*patch)}, touched);
    changed.insert(key);
  }
  // In the other chunks the edit has changed no shown voxel.
  for (const ChunkKey& key : predicted) {
    if (changed.contains(key)) continue;
    TrackedChunk* const chunk = chunks_.find(key);
    if (chunk != nullptr && chunk->drop_pending(ordered.op.seq) && chunk->confirmed() &&
        !past_.is_past())
      updater_.show(*chunk);
  }
  return {};
}

Result<void> Replica::receive(const VeilPatches& patches, const Arrival& arrival) {
  if (!parameters_) return fail(ErrorCode::bad_value, "patches before ready");
  if (patches.version.epoch > parameters_->epoch)
    return fail(ErrorCode::bad_value, "patches of another epoch");
  newest_ = std::max(newest_, patches.version.seq);
  Touched touched;
  for (const ChunkPatch& patch : patches.patches) {
    const ChunkKey key{0, patch.at};
    if (!is_in_view(key)) continue;
    add_to_chunk(key,
                 {nullptr, patch.previous, patches.version, false,
                  std::make_shared<const VeilPatch>(patch.patch)},
                 touched);
  }
  advance(touched, arrival.now_us);
  return {};
}

void Replica::receive(const DigestCheck& check, TimeUs now_us) {
  if (past_.is_past()) return;
  for (const DigestCheckEntry& entry : check.entries) {
    if (TrackedChunk* chunk = chunks_.find(entry.key)) updater_.check_digest(*chunk, entry, now_us);
  }
}

// Caches.

void Replica::adopt(const ChunkKey& key, ChunkPtr chunk, TimeUs now_us) {
  if (!parameters_ || past_.is_past()) return;
  if (key.lod > 0) {
    counters_.tiles_adopted += far_tiles_.adopt(key, std::move(chunk)) ? 1 : 0;
    return;
  }
  if (!is_in_view(key)) return;
  TrackedChunk& tracked = track(key);
  const bool is_answered = is_vouched(tracked.state()) || tracked.is_unavailable();
  if (!tracked.confirmed() && !is_answered) updater_.adopt(tracked, std::move(chunk), now_us);
}

std::vector<CachedChunk> Replica::take_claims() {
  if (!parameters_ || past_.is_past()) return {};
  auto claims = claims_.take(chunks_, far_tiles_);
  counters_.claimed += claims.size();
  return claims;
}

bool Replica::is_expected(const ChunkKey& key) const {
  return parameters_ && view() &&
         has_chunk(*view(), CoordLimit::of(parameters_->chunk_edge), key.at) && !unavailable(key);
}

std::vector<ChunkKey> Replica::missing() const {
  std::vector<ChunkKey> keys;
  if (!parameters_ || past_.is_past() || !view()) return keys;
  const CoordLimit world = CoordLimit::of(parameters_->chunk_edge);
  const View& v = *view();
  const std::int32_t h = v.radius_h, up = v.radius_v;
  for (std::int32_t x = v.centre.x - h; x <= v.centre.x + h; ++x) {
    for (std::int32_t y = v.centre.y - up; y <= v.centre.y + up; ++y) {
      for (std::int32_t z = v.centre.z - h; z <= v.centre.z + h; ++z) {
        const ChunkKey key{0, {x, y, z}};
        if (!has_chunk(v, world, key.at)) continue;
        const TrackedChunk* chunk = chunks_.find(key);
        const bool is_expected = chunk == nullptr || chunk->state() == ChunkState::expected ||
                                 chunk->state() == ChunkState::requested;
        if (is_expected && (chunk == nullptr || !chunk->confirmed())) keys.push_back(key);
      }
    }
  }
  return keys;
}

std::vector<ChunkKey> Replica::take_missing_tiles() {
  return !parameters_ || past_.is_past() ? std::vector<ChunkKey>{} : far_tiles_.take_not_held();
}

std::vector<KeyedChunk> Replica::take_for_cache(std::size_t count_max) {
  std::vector<KeyedChunk> out = outbox_.take(past_.is_past() ? nullptr : &chunks_, count_max);
  std::vector<KeyedChunk> tiles = far_tiles_.take_for_cache(count_max - out.size());
  std::move(tiles.begin(), tiles.end(), std::back_inserter(out));
  return out;
}

ReplicaChanges Replica::drain_changes() {
  ReplicaChanges out = changes_.drain();
  out.tiles = far_tiles_.drain_changes();
  return out;
}

// Reading.

ChunkPtr Replica::confirmed(const ChunkKey& key) const {
  const TrackedChunk* chunk = chunks_.find(key);
  return chunk == nullptr ? nullptr : chunk->confirmed();
}

ShownPtr Replica::shown(const ChunkKey& key) const {
  const TrackedChunk* chunk = chunks_.find(key);
  return chunk == nullptr ? nullptr : chunk->shown;
}

std::uint64_t Replica::shown_serial(const ChunkKey& key) const {
  const TrackedChunk* chunk = chunks_.find(key);
  return chunk == nullptr ? 0 : chunk->serial;
}

std::optional<Material> Replica::shown_at(VoxelPos at) const {
  if (!parameters_) return std::nullopt;
  const ShownPtr chunk = shown({0, chunk_of(at, parameters_->chunk_edge)});
  if (!chunk) return std::nullopt;
  return material_at(*chunk, local_of(at, parameters_->chunk_edge));
}

bool Replica::unavailable(const ChunkKey& key) const {
  const TrackedChunk* chunk = chunks_.find(key);
  return chunk != nullptr && chunk->is_unavailable();
}

std::vector<ChunkKey> Replica::confirmed_keys() const {
  std::vector<ChunkKey> keys;
  keys.reserve(confirmed_count());
  for (const auto& [key, chunk] : chunks_) {
    if (chunk.confirmed()) keys.push_back(key);
  }
  return keys;
}

}  // namespace runstone
