#include "server/world/broadcast.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>

#include "common/core/assert.hpp"
#include "server/world/delivery.hpp"

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

/// Adds ascending sessions to ascending ones. Chunks in one place mostly have the same subscribers: those cost a
/// comparison.
void add_sessions(std::span<const SessionId> more, std::vector<SessionId>& sessions,
                  std::vector<SessionId>& scratch) {
  RUNSTONE_DASSERT(std::ranges::is_sorted(more));
  if (std::ranges::equal(more, sessions)) return;
  scratch.clear();
  std::ranges::set_union(sessions, more, std::back_inserter(scratch));
  sessions.swap(scratch);
}

/// Ascending. Also notes whose edits these are.
std::vector<SessionId> receivers_of(WorldState& world, const OrderedBatch& batch) {
  std::set<std::pair<AuthorId, ClientInstance>> authors;
  for (const OrderedEdit& edit : batch.commit.edits)
    authors.emplace(edit.op.author, edit.op.instance);
  std::vector<SessionId> receivers, own, scratch;
  for (const ChunkKey& key : batch.touched)
    add_sessions(world.interest.subscribers(key), receivers, scratch);
  for (auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open &&
        authors.contains({session.author, session.instance})) {
      own.push_back(id);
      session.awaits_durable = world.authority.head();
    }
  }
  add_sessions(own, receivers, scratch);
  return receivers;
}

/// The commit did not fit. The session's chunks become stale; its own edits in it are answered by a small
/// message, for the client cannot tell from a snapshot that they were applied.
void drop_commit_for(WorldState& world, SessionId session, const OrderedBatch& batch,
                     const Clocks& now) {
  mark_stale(world, session, batch.touched, now);
  const WorldSession& mine = *world.find(session);
  const OperationId own{mine.author, mine.instance, 0};
  for (std::size_t i = 0; i < batch.commit.edits.size(); ++i) {
    const OrderedEdit& edit = batch.commit.edits[i];
    if (edit.op.author != own.author || edit.op.instance != own.instance) continue;
    answer(world, session,
           {edit.op.seq, RejectReason::already_resolved,
            "applied; its commit did not fit the queue", batch.commit.first + i});
  }
}

}  // namespace

void commit_and_broadcast(WorldState& world, const Clocks& now) {
  while (auto batch = world.authority.commit(now)) {
    const EncodedMessage encoded = encode_message(batch->commit);
    ++world.counters.commits;
    world.counters.commit_bytes += encoded.bytes->size();
    world.counters.edits_ordered += batch->records.size();
    std::vector<PlayerRow> players = unsaved_players_of(world, batch->records);
    world.ports.log_append(std::move(players), std::move(batch->records));
    const std::vector<SessionId> receivers = receivers_of(world, *batch);
    const std::vector<SessionId> full = world.ports.send_to_all(receivers, encoded);
    world.counters.commits_sent += receivers.size() - full.size();
    world.counters.queue_full += full.size();
    for (const SessionId session : full) drop_commit_for(world, session, *batch, now);
    for (const ChunkKey& key : batch->touched) {
      if (world.authority.chunks().stack_size(key) > world.config.restack_load_edits)
        ask_load(world, key);
    }
  }
}

void tell_durable_to_authors(WorldState& world) {
  const EncodedMessage encoded = encode_message(Durable{world.authority.epoch(), world.durable});
  for (const SessionId session : world.open_sessions()) {
    const WorldSession& mine = *world.find(session);
    if (mine.durable_told < mine.awaits_durable) tell_durable(world, session, encoded);
  }
}

void broadcast_durable(WorldState& world, const Clocks& now) {
  if (now.steady_us - world.durable_us < world.config.durable_interval_us) return;
  world.durable_us = now.steady_us;
  const EncodedMessage encoded = encode_message(Durable{world.authority.epoch(), world.durable});
  for (const SessionId session : world.open_sessions()) tell_durable(world, session, encoded);
}

}  // namespace runstone
