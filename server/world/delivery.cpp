#include "server/world/delivery.hpp"

#include <algorithm>
#include <utility>

#include "server/world/cached_chunk_handlers.hpp"
#include "server/world/time_travel.hpp"

namespace runstone {
namespace {

bool is_stalled(const WorldState& world, const WorldSession& session, const Clocks& now) {
  return session.stalled_us && now.steady_us - *session.stalled_us < world.config.retry_interval_us;
}

/// Leaves the chunk wanted because the session's queue is full.
void put_off(WorldState& world, SessionId session, const ChunkKey& key, const Clocks& now) {
  ++world.counters.queue_full;
  world.find(session)->stalled_us = now.steady_us;
  world.interest.set_state(session, key, ChunkInterest::wanted);
}

/// Sends the history states that must precede the session's next chunk. Returns false if its queue
/// is full.
bool send_view_states(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.history_start_due && !mine.history_report_due) return true;
  // Answers about the live world precede the state that ends it.
  if (!send_not_modified(world, session, false)) {
    mine.stalled_us = now.steady_us;
    return false;
  }
  if (!send_uniform(world, session, now)) return false;
  for (std::optional<ViewState>* due : {&mine.history_start_due, &mine.history_report_due}) {
    if (!*due) continue;
    if (!world.environment.send(session, encode_message(**due))) {
      ++world.counters.queue_full;
      mine.stalled_us = now.steady_us;
      return false;
    }
    due->reset();
  }
  return true;
}

/// Queues a chunk of one material to be sent together with others. Returns false if too many wait.
bool queue_uniform(WorldState& world, SessionId session, const ChunkKey& key, const Chunk& chunk,
                   const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const bool is_full =
      mine.uniform.size() >= kUniformWaitingMax && !send_uniform(world, session, now);
  if (is_full) return false;
  mine.uniform.push_back({key, material_at(chunk.voxels, {0, 0, 0}), chunk.version});
  if (mine.uniform.size() >= kUniformPerMessage) send_uniform(world, session, now);
  return true;
}

/// Sends the uniform chunks that are due unless loads under way may soon add more.
void send_uniform_if_last(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const bool more_come = world.interest.find(session)->count(ChunkInterest::waiting) > 0 ||
                         (mine.history && mine.history->loading > 0);
  if (!more_come) send_uniform(world, session, now);
}

}  // namespace

bool send_uniform(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (mine.uniform.empty()) return true;
  if (is_stalled(world, mine, now)) return false;
  // A chunk that is due twice is sent at its newer version.
  const auto before = [](const UniformChunk& a, const UniformChunk& b) {
    return a.key != b.key ? is_before_in_list(a.key.at, b.key.at) : b.version < a.version;
  };
  const auto same = [](const UniformChunk& a, const UniformChunk& b) { return a.key == b.key; };
  UniformChunks message{mine.uniform};
  std::sort(message.chunks.begin(), message.chunks.end(), before);
  message.chunks.erase(std::unique(message.chunks.begin(), message.chunks.end(), same),
                       message.chunks.end());
  if (!world.environment.send(session, encode_message(message))) {
    ++world.counters.queue_full;
    mine.stalled_us = now.steady_us;
    return false;
  }
  mine.uniform.clear();
  ++world.counters.uniform_messages;
  return true;
}

void forget_unsent(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  const View& view = *world.interest.find(session)->view();
  std::erase_if(mine.uniform,
                [&](const UniformChunk& chunk) { return !view.contains(chunk.key.at); });
  world.environment.forget_outside(session, view);
}

bool answer_chunk(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                  ChunkInterest then, const Clocks& now) {
  if (chunk == nullptr) {
    const ChunkUnavailable unavailable{{key}, UnavailableReason::damaged};
    if (!world.environment.send(session, encode_message(unavailable))) {
      put_off(world, session, key, now);
      return false;
    }
    world.interest.set_state(session, key, ChunkInterest::unavailable);
    ++world.counters.unavailable_sent;
    return true;
  }
  const ClaimAnswer held = then == ChunkInterest::subscribed
                               ? answer_claim(world, session, key, chunk)
                               : ClaimAnswer::none;
  if (held == ClaimAnswer::queued) {
    world.interest.set_state(session, key, then);
    return true;
  }
  const auto send = [&] {
    return chunk->voxels.is_uniform() ? queue_uniform(world, session, key, *chunk, now)
                                      : world.environment.send_snapshot(session, key, chunk);
  };
  if (held == ClaimAnswer::full || !send()) {
    put_off(world, session, key, now);
    return false;
  }
  world.interest.set_state(session, key, then);
  ++world.counters.snapshots_sent;
  return true;
}

void request_load(WorldState& world, const ChunkKey& key) {
  if (world.authority.chunks().residency(key) != Residency::absent) return;
  world.loads.request_for_world(key);
  start_loads(world);
}

void start_loads(WorldState& world) {
  while (const auto key = world.loads.next()) {
    // Another session may have requested the same chunk before.
    if (!world.authority.chunks().begin_load(*key)) continue;
    world.loads.load_started();
    world.environment.load_chunk(*key);
  }
}

void deliver(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || mine->state != SessionStage::open || is_stalled(world, *mine, now)) return;
  mine->stalled_us.reset();
  if (!send_view_states(world, session, now)) return;
  if (mine->history) {
    deliver_history(world, session, now);
    return send_uniform_if_last(world, session, now);
  }
  WorldChunks& chunks = world.authority.chunks();
  const SessionInterest& interest = *world.interest.find(session);
  while (interest.count(ChunkInterest::waiting) < world.config.loads_per_session_max) {
    const auto key = world.interest.nearest_wanted(session);
    if (!key) break;
    const ChunkPtr chunk = chunks.find(*key);
    const Residency residency = chunks.residency(*key);
    if (chunk != nullptr || residency == Residency::quarantined) {
      if (!answer_chunk(world, session, *key, chunk, ChunkInterest::subscribed, now)) break;
    } else {
      world.interest.set_state(session, *key, ChunkInterest::waiting);
      if (residency == Residency::absent) world.loads.request(session, *key);
    }
  }
  const bool is_more =
      world.interest.nearest_wanted(session) || interest.count(ChunkInterest::waiting) != 0;
  send_not_modified(world, session, is_more);
  send_uniform_if_last(world, session, now);
  start_loads(world);
}

void deliver_loaded(WorldState& world, const ChunkKey& key, const Clocks& now) {
  const ChunkPtr chunk = world.authority.chunks().find(key);
  for (const SessionId session : world.interest.waiting(key)) {
    world.loads.cancel(session, key);  // the load was requested by another session too
    if (is_stalled(world, *world.find(session), now)) {
      world.interest.set_state(session, key, ChunkInterest::wanted);
    } else {
      answer_chunk(world, session, key, chunk, ChunkInterest::subscribed, now);
    }
    deliver(world, session, now);
  }
}

void mark_stale(WorldState& world, SessionId session, std::span<const ChunkKey> keys,
                const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return;
  mine->stalled_us = now.steady_us;
  for (const ChunkKey& key : keys) {
    if (!world.interest.subscribes(session, key)) continue;
    world.interest.set_state(session, key, ChunkInterest::wanted);
    ++world.counters.chunks_stale;
  }
}

void collect_released(WorldState& world) {
  for (const ChunkKey& key : world.interest.take_released()) {
    if (!world.interest.is_used(key)) world.authority.chunks().released(key);
  }
}

}  // namespace runstone
