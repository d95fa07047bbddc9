#include "server/world/broadcast.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "common/core/assert.hpp"
#include "protocol/codec/commit_encoder.hpp"
#include "server/interest/audiences.hpp"
#include "server/world/delivery.hpp"
#include "server/world/followers.hpp"
#include "server/world/material_handlers.hpp"
#include "server/world/rights_handlers.hpp"
#include "server/world/stale_tiles.hpp"

namespace runstone {
namespace {

std::vector<PlayerRow> unsaved_players_of(WorldState& world,
                                          const std::vector<EditRecord>& records) {
  std::vector<PlayerRow> players;
  for (const EditRecord& record : records) {
    if (auto player = world.players.take_unsaved(record.op.author))
      players.push_back(std::move(*player));
  }
  return players;
}

/// Merges `more` into `sessions`; both ascend. Chunks in one place mostly have the same
/// subscribers, and equal lists cost one comparison.
void add_sessions(std::span<const SessionId> more, std::vector<SessionId>& sessions,
                  std::vector<SessionId>& scratch) {
  RUNSTONE_DASSERT(std::ranges::is_sorted(more));
  if (std::ranges::equal(more, sessions)) return;
  scratch.clear();
  std::ranges::set_union(sessions, more, std::back_inserter(scratch));
  sessions.swap(scratch);
}

/// Returns the session of the client that made an edit, if it is connected here.
std::optional<SessionId> author_session(const WorldState& world, const OrderedEdit& edit) {
  const auto found = world.clients.find({edit.op.author, edit.op.instance});
  return found == world.clients.end() ? std::nullopt : std::optional(found->second);
}

/// Returns for each edit the sessions that see one of its chunks, and the session of its client,
/// ascending.
std::vector<std::vector<SessionId>> receivers_of(const WorldState& world,
                                                 const OrderedBatch& batch) {
  std::vector<std::vector<SessionId>> receivers(batch.commit.edits.size());
  std::vector<SessionId> scratch;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    for (const ChunkKey& key : batch.touched[i])
      add_sessions(world.interest.subscribers(key), receivers[i], scratch);
    const auto author = author_session(world, batch.commit.edits[i]);
    if (!author) continue;
    const auto at = std::ranges::lower_bound(receivers[i], *author);
    if (at == receivers[i].end() || *at != *author) receivers[i].insert(at, *author);
  }
  return receivers;
}

/// Handles a message with these edits of a commit that did not fit the session's queue. The touched
/// chunks become stale for the session. Each edit of its client gets a small answer, because a
/// snapshot does not show whether an edit was applied.
void drop_edits_for(WorldState& world, SessionId session, const OrderedBatch& batch,
                    const std::vector<std::uint32_t>& edits, const Clocks& now) {
  for (const std::uint32_t i : edits) mark_stale(world, session, batch.touched[i], now);
  for (const std::uint32_t i : edits) {
    const OrderedEdit& edit = batch.commit.edits[i];
    const WorldSession* mine = world.find(session);
    if (mine == nullptr) return;  // too many rejects were pending: the session is closed
    if (edit.op.author != mine->author || edit.op.instance != mine->instance) continue;
    send_reject(world, session,
                {edit.op.seq, RejectReason::already_resolved,
                 "applied; its commit did not fit the queue", edit.seq});
  }
}

void send_batch(WorldState& world, const OrderedBatch& batch, const Clocks& now) {
  for (const OrderedEdit& edit : batch.commit.edits) {
    if (const auto author = author_session(world, edit))
      world.find(*author)->awaits_durable = world.authority.head();
  }
  const auto receivers = receivers_of(world, batch);
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const OrderedEdit& edit = batch.commit.edits[i];
    const std::size_t work = edit_work(edit.edit, world.config.chunk_edge);
    if (waits_for_room(work, edit.cause))
      world.large_edits.charge(work * receivers[i].size(), now.steady_us);
  }
  const std::vector<Audience> audiences = audiences_of(receivers);
  if (audiences.empty()) return;
  const CommitEncoder encoder(batch.commit);
  for (const Audience& audience : audiences) {
    const EncodedMessage encoded = encode_message(encoder, audience.edits);
    const std::vector<SessionId> full = world.output.send_to_all(audience.sessions, encoded);
    world.counters.commit_bytes += encoded.bytes->size();
    world.counters.commits_sent += audience.sessions.size() - full.size();
    world.counters.queue_full += full.size();
    for (const SessionId session : full) drop_edits_for(world, session, batch, audience.edits, now);
  }
}

/// Returns the work of large edits that the next commit may have if every session sees them. There is no
/// room while another server may own the world.
std::uint64_t large_room_of(const WorldState& world, TimeUs now_us) {
  if (!world.environment.owns_world()) return 0;
  return world.large_edits.room(now_us) / std::max<std::size_t>(1, world.sessions.size());
}

}  // namespace

bool commit_and_broadcast(WorldState& world, LargeEdits large, const Clocks& now) {
  auto batch = world.authority.commit(
      now, large == LargeEdits::all ? kAllLargeEdits : large_room_of(world, now.steady_us));
  if (!batch) return false;
  ++world.counters.commits;
  world.counters.edits_ordered += batch->records.size();
  apply_rights(world, batch->records);
  apply_materials(world, batch->records);
  std::vector<PlayerRow> players = unsaved_players_of(world, batch->records);
  append_to_log(world, std::move(players), *batch);
  publish_batch(world, *batch, now);
  return true;
}

void publish_batch(WorldState& world, const OrderedBatch& batch, const Clocks& now) {
  send_batch(world, batch, now);
  tiles_edited(world, batch.all_touched, now);
  for (const ChunkKey& key : batch.all_touched) {
    if (world.authority.chunks().stack_size(key) > world.config.stack_load_edits)
      request_load(world, key, now);
  }
}

bool has_ready_edits(const WorldState& world, TimeUs now_us) {
  return world.authority.queue().has_ready(large_room_of(world, now_us) > 0);
}

void send_durable_to_authors(WorldState& world) {
  const EncodedMessage encoded = encoded_durable(world);
  for (const SessionId session : world.open_sessions()) {
    const WorldSession& mine = *world.find(session);
    if (mine.durable_sent < mine.awaits_durable) send_durable(world, session, encoded);
  }
}

void broadcast_durable(WorldState& world, const Clocks& now) {
  if (now.steady_us < world.durable_due_us) return;
  world.durable_due_us = now.steady_us + world.config.durable_interval_us;
  const EncodedMessage encoded = encoded_durable(world);
  for (const SessionId session : world.open_sessions()) send_durable(world, session, encoded);
}

}  // namespace runstone
