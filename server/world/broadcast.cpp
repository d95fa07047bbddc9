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

/// Returns the receivers of a commit, ascending. Sessions of its authors now await durability up to
/// it.
std::vector<SessionId> receivers_of(WorldState& world, const OrderedBatch& batch) {
  std::set<std::pair<AuthorId, ClientInstance>> authors;
  for (const OrderedEdit& edit : batch.commit.edits)
    authors.emplace(edit.op.author, edit.op.instance);
  std::vector<SessionId> receivers, author_sessions, scratch;
  for (const ChunkKey& key : batch.touched)
    add_sessions(world.interest.subscribers(key), receivers, scratch);
  for (auto& [id, session] : world.sessions) {
    if (session.state == SessionStage::open &&
        authors.contains({session.author, session.instance})) {
      author_sessions.push_back(id);
      session.awaits_durable = world.authority.head();
    }
  }
  add_sessions(author_sessions, receivers, scratch);
  return receivers;
}

/// Handles a commit that did not fit the session's queue. The touched chunks become stale for the
/// session. Each edit of its client gets a small answer, because a snapshot does not show whether
/// an edit was applied.
void drop_commit_for(WorldState& world, SessionId session, const OrderedBatch& batch,
                     const Clocks& now) {
  mark_stale(world, session, batch.touched, now);
  for (std::size_t i = 0; i < batch.commit.edits.size(); ++i) {
    const OrderedEdit& edit = batch.commit.edits[i];
    const WorldSession* mine = world.find(session);
    if (mine == nullptr) return;  // too many rejects were pending: the session is closed
    if (edit.op.author != mine->author || edit.op.instance != mine->instance) continue;
    send_reject(world, session,
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
    world.environment.log_append(std::move(players), std::move(batch->records));
    const std::vector<SessionId> receivers = receivers_of(world, *batch);
    const std::vector<SessionId> full = world.environment.send_to_all(receivers, encoded);
    world.counters.commits_sent += receivers.size() - full.size();
    world.counters.queue_full += full.size();
    for (const SessionId session : full) drop_commit_for(world, session, *batch, now);
    for (const ChunkKey& key : batch->touched) {
      if (world.authority.chunks().stack_size(key) > world.config.stack_load_edits)
        request_load(world, key);
    }
  }
}

void send_durable_to_authors(WorldState& world) {
  const EncodedMessage encoded = encode_message(Durable{world.authority.epoch(), world.durable});
  for (const SessionId session : world.open_sessions()) {
    const WorldSession& mine = *world.find(session);
    if (mine.durable_sent < mine.awaits_durable) send_durable(world, session, encoded);
  }
}

void broadcast_durable(WorldState& world, const Clocks& now) {
  if (now.steady_us - world.durable_us < world.config.durable_interval_us) return;
  world.durable_us = now.steady_us;
  const EncodedMessage encoded = encode_message(Durable{world.authority.epoch(), world.durable});
  for (const SessionId session : world.open_sessions()) send_durable(world, session, encoded);
}

}  // namespace runstone
