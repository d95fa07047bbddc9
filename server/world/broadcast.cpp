#include "server/world/broadcast.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "common/core/key_text.hpp"
#include "server/world/delivery.hpp"

namespace runstone {
namespace {

std::vector<PlayerRow> unsaved_players_of(WorldState& world, const std::vector<EditRecord>& records) {
  std::vector<PlayerRow> players;
  for (const EditRecord& record : records) {
    if (auto player = world.players.take_unsaved(record.op.author)) players.push_back(std::move(*player));
  }
  return players;
}

std::vector<SessionId> receivers_of(const WorldState& world, const OrderedBatch& batch) {
  std::set<std::pair<AuthorId, ClientInstance>> authors;
  for (const OrderedEdit& edit : batch.commit.edits) authors.emplace(edit.op.author, edit.op.instance);
  std::vector<SessionId> receivers;
  for (const ChunkKey& key : batch.touched) {
    const auto subscribers = world.interest.subscribers(key);
    receivers.insert(receivers.end(), subscribers.begin(), subscribers.end());
  }
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionState::open && authors.contains({session.author, session.instance})) {
      receivers.push_back(id);
    }
  }
  std::sort(receivers.begin(), receivers.end());
  receivers.erase(std::unique(receivers.begin(), receivers.end()), receivers.end());
  return receivers;
}

/// The commit did not fit. The session's chunks become stale; its own edits in it are answered by a small
/// message, for the client cannot tell from a snapshot that they were applied.
void drop_commit_for(WorldState& world, SessionId session, const OrderedBatch& batch, const Now& now) {
  mark_stale(world, session, batch.touched, now);
  const WorldSession& mine = *world.find(session);
  const OperationId own{mine.author, mine.instance, 0};
  for (std::size_t i = 0; i < batch.commit.edits.size(); ++i) {
    const OrderedEdit& edit = batch.commit.edits[i];
    if (edit.op.author != own.author || edit.op.instance != own.instance) continue;
    answer(world, session,
           {edit.op.seq, RejectReason::already_decided, "applied; its commit did not fit the queue",
            batch.commit.first + i});
  }
}

std::vector<SessionId> open_sessions(const WorldState& world) {
  std::vector<SessionId> open;
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionState::open) open.push_back(id);
  }
  return open;
}

}  // namespace

void commit_and_broadcast(WorldState& world, const Now& now) {
  while (auto batch = world.authority.commit(now)) {
    const EncodedMessage encoded = encode_message(batch->commit);
    ++world.counters.commits;
    world.counters.commit_bytes += encoded.bytes->size();
    world.counters.edits_ordered += batch->records.size();
    std::vector<PlayerRow> players = unsaved_players_of(world, batch->records);
    world.ports.log_append(std::move(players), std::move(batch->records));
    for (const SessionId session : receivers_of(world, *batch)) {
      if (world.ports.send(session, encoded)) {
        ++world.counters.commits_sent;
        continue;
      }
      ++world.counters.queue_full;
      drop_commit_for(world, session, *batch, now);
    }
    for (const ChunkKey& key : batch->touched) {
      if (world.authority.chunks().stack_size(key) > world.config.restack_load_edits) ask_load(world, key);
    }
  }
}

void broadcast_durable(WorldState& world) {
  const EncodedMessage encoded = encode_message(Durable{world.authority.epoch(), world.durable});
  for (const SessionId session : open_sessions(world)) {
    if (!send_or_skip(world, session, encoded)) world.find(session)->owes_durable = true;
  }
}

void broadcast_roster(WorldState& world) {
  if (!world.roster_changed) return;
  world.roster_changed = false;
  std::map<AuthorId, std::string> names;  // two clients of one player are one line
  for (const auto& [id, session] : world.sessions) {
    if (session.state == SessionState::open) names[session.author] = session.name;
  }
  Roster roster;
  for (const auto& [author, name] : names) roster.players.push_back({author, name});
  const EncodedMessage encoded = encode_message(roster);
  for (const SessionId session : open_sessions(world)) {
    if (!send_or_skip(world, session, encoded)) world.roster_changed = true;  // once more, next time
  }
}

void broadcast_poses(WorldState& world) {
  PlayerPoses poses;
  for (auto& [id, session] : world.sessions) {
    if (session.state != SessionState::open || !session.pose_changed) continue;
    session.pose_changed = false;
    poses.players.push_back({session.author, session.pose});
  }
  if (poses.players.empty()) return;
  const EncodedMessage encoded = encode_message(poses);
  for (const SessionId session : open_sessions(world)) send_or_skip(world, session, encoded);
}

void send_all_poses_to(WorldState& world, SessionId session) {
  PlayerPoses poses;
  for (const auto& [id, other] : world.sessions) {
    if (other.state == SessionState::open) poses.players.push_back({other.author, other.pose});
  }
  send_or_skip(world, session, encode_message(poses));
}

void send_audits(WorldState& world) {
  for (const SessionId session : open_sessions(world)) {
    Audit audit;
    std::set<ChunkKey> seen;
    while (audit.entries.size() < world.config.audit_chunks) {
      const auto key = world.interest.next_for_audit(session);
      if (!key || !seen.insert(*key).second) break;
      const ChunkPtr chunk = world.authority.chunks().find(*key);
      if (chunk == nullptr) continue;
      const Digest digest = digest_of(chunk->voxels);
      if (digest != chunk->digest) {
        ++world.counters.audit_mismatches;
        world.ports.log(WorldLogLevel::error, "chunk=" + text_of(*key) + " digest of runs " + to_hex(digest) +
                                                  " is not the one kept " + to_hex(chunk->digest));
      }
      audit.entries.push_back({*key, chunk->version, digest});
    }
    if (audit.entries.empty()) continue;
    if (send_or_skip(world, session, encode_message(audit))) ++world.counters.audits_sent;
  }
}

}  // namespace runstone
