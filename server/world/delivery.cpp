#include "server/world/delivery.hpp"

#include <algorithm>
#include <utility>

#include "server/world/cached_chunk_handlers.hpp"
#include "server/world/quotas.hpp"
#include "server/world/tile_handlers.hpp"
#include "server/world/time_travel.hpp"

namespace runstone {
namespace {

// The most chunks that one task of the world strand sends, and that it collects. Either takes about
// a millisecond, so that edits do not wait long for a task.
constexpr std::size_t kChunksPerDelivery = 512, kReleasedPerTask = 4'096;

/// Leaves the chunk wanted because the session's queue is full.
void put_off(WorldState& world, SessionId session, const ChunkKey& key, const Clocks& now) {
  ++world.counters.queue_full;
  world.find(session)->stalled_us = now.steady_us;
  world.interest.set_state(session, key, ChunkInterest::wanted);
}

/// Sends the reports that must precede the session's next chunk. Returns false if its queue is
/// full.
bool send_view_states(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.begins_due && !mine.refused_due && !mine.complete_due) return true;
  // Answers about the live world precede the state that ends it.
  if (!send_not_modified(world, session, false)) {
    mine.stalled_us = now.steady_us;
    return false;
  }
  if (!send_uniform(world, session, now)) return false;
  for (std::optional<ViewState>* due : {&mine.begins_due, &mine.refused_due, &mine.complete_due}) {
    if (!*due) continue;
    if (!world.output.send(session, encode_message(**due))) {
      ++world.counters.queue_full;
      mine.stalled_us = now.steady_us;
      return false;
    }
    due->reset();
  }
  return true;
}

/// Ends a delivery: sends the uniform chunks that are due unless loads under way may soon add more,
/// and reports once that every chunk of the view was answered.
void end_delivery(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  const bool more_come = world.interest.find(session)->count(ChunkInterest::waiting) > 0 ||
                         (mine.history && mine.history->loading > 0);
  if (more_come || !send_uniform(world, session, now)) return;
  const bool is_answered = mine.not_modified_due.empty() && !world.interest.nearest_wanted(session);
  if (mine.is_view_complete || !is_answered) return;
  mine.is_view_complete = true;
  mine.complete_due = view_state(world, session, ViewPhase::complete);
  send_view_states(world, session, now);
}

}  // namespace

bool is_stalled(const WorldState& world, const WorldSession& session, const Clocks& now) {
  return session.stalled_us && now.steady_us - *session.stalled_us < world.config.retry_interval_us;
}

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

bool send_uniform(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (mine.uniform.empty()) return true;
  if (is_stalled(world, mine, now)) return false;
  // A chunk that is due twice is sent at its newer version.
  const auto before = [](const UniformChunk& a, const UniformChunk& b) {
    return a.key != b.key ? a.key < b.key : b.version < a.version;
  };
  const auto same = [](const UniformChunk& a, const UniformChunk& b) { return a.key == b.key; };
  std::sort(mine.uniform.begin(), mine.uniform.end(), before);
  mine.uniform.erase(std::unique(mine.uniform.begin(), mine.uniform.end(), same),
                     mine.uniform.end());
  while (!mine.uniform.empty()) {
    const std::uint8_t level = mine.uniform.front().key.lod;
    const auto end =
        std::find_if(mine.uniform.begin(), mine.uniform.end(),
                     [level](const UniformChunk& one) { return one.key.lod != level; });
    const UniformChunks message{view_in_force(world, session), {mine.uniform.begin(), end}};
    if (!world.output.send(session, encode_message(message))) {
      ++world.counters.queue_full;
      mine.stalled_us = now.steady_us;
      return false;
    }
    mine.uniform.erase(mine.uniform.begin(), end);
    ++world.counters.uniform_messages;
  }
  return true;
}

std::uint32_t view_in_force(const WorldState& world, SessionId session) {
  const std::optional<View>& view = world.interest.find(session)->view();
  return view ? view->number : 0;
}

ViewState view_state(const WorldState& world, SessionId session, ViewPhase phase) {
  const WorldSession& mine = *world.find(session);
  ViewState state;
  state.request = mine.history_request;
  state.view = view_in_force(world, session);
  state.phase = phase;
  state.past = mine.history.has_value();
  if (mine.history) {
    state.seq = mine.history->seq;
    state.utc_us = mine.history->utc_us;
  }
  return state;
}

void forget_unsent(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  const SessionInterest& interest = *world.interest.find(session);
  const auto is_void = [&](const auto& chunk) {
    if (chunk.key.lod > 0) return mine.tiles->status(chunk.key) == TileStatus::unknown;
    const auto state = interest.state(chunk.key);
    return state != ChunkInterest::subscribed && state != ChunkInterest::history_sent;
  };
  std::erase_if(mine.uniform, is_void);
  std::erase_if(mine.not_modified_due, is_void);
  world.environment.forget_outside(session, *interest.view());
}

bool send_chunk(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& chunk,
                ChunkInterest then, const Clocks& now) {
  if (chunk == nullptr) {
    const ChunkUnavailable unavailable{
        view_in_force(world, session), {key}, UnavailableReason::damaged};
    if (!world.output.send(session, encode_message(unavailable))) {
      put_off(world, session, key, now);
      return false;
    }
    world.interest.set_state(session, key, ChunkInterest::unavailable);
    ++world.counters.unavailable_sent;
    return true;
  }
  const ClaimReply held = then == ChunkInterest::subscribed
                              ? reply_to_claim(world, session, key, chunk)
                              : ClaimReply::none;
  if (held == ClaimReply::queued) {
    world.interest.set_state(session, key, then);
    return true;
  }
  const auto send = [&] {
    return chunk->voxels.is_uniform() ? queue_uniform(world, session, key, *chunk, now)
                                      : world.environment.send_snapshot(
                                            session, view_in_force(world, session), key, chunk);
  };
  if (held == ClaimReply::full || !send()) {
    put_off(world, session, key, now);
    return false;
  }
  world.interest.set_state(session, key, then);
  ++world.counters.snapshots_sent;
  return true;
}

void request_load(WorldState& world, const ChunkKey& key, const Clocks& now) {
  if (world.authority.chunks().residency(key) != Residency::absent) return;
  world.loads.request_for_world(key);
  start_loads(world, now);
}

void start_loads(WorldState& world, const Clocks& now) {
  WorldChunks& chunks = world.authority.chunks();
  const auto next_load = [&] {
    return views_wait_for_memory(world) ? world.loads.next_for_world()
                                        : world.loads.next(world.loads_wait);
  };
  while (const auto next = next_load()) {
    // Another session may have requested the same chunk before.
    if (chunks.residency(next->key) != Residency::absent) continue;
    if (next->session && !pay_load(world, *world.find(*next->session), now)) {
      world.loads.put_back(*next->session, next->key);
      world.loads_wait.insert(*next->session);
      continue;
    }
    chunks.begin_load(next->key);
    world.loads.load_started();
    world.environment.load_chunk(next->key);
  }
}

void deliver(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr || mine->state != SessionStage::open || is_stalled(world, *mine, now)) return;
  mine->stalled_us.reset();
  world.deliveries.erase(session);
  if (!send_view_states(world, session, now)) return;
  request_tiles(world, session, now);
  if (mine->history) {
    deliver_history(world, session, now);
    send_not_modified(world, session, false);
    return end_delivery(world, session, now);
  }
  WorldChunks& chunks = world.authority.chunks();
  const SessionInterest& interest = *world.interest.find(session);
  std::size_t sent = 0;
  while (interest.count(ChunkInterest::waiting) < world.config.loads_per_session_max) {
    const auto key = world.interest.nearest_wanted(session);
    if (!key) break;
    if (sent == kChunksPerDelivery) {
      world.deliveries.insert(session);
      break;
    }
    const ChunkPtr chunk = chunks.find(*key);
    const Residency residency = chunks.residency(*key);
    if (chunk != nullptr || residency == Residency::quarantined) {
      if (!send_chunk(world, session, *key, chunk, ChunkInterest::subscribed, now)) break;
      ++sent;
    } else {
      world.interest.set_state(session, *key, ChunkInterest::waiting);
      if (residency == Residency::absent) world.loads.request(session, *key);
    }
  }
  const bool is_more =
      world.interest.nearest_wanted(session) || interest.count(ChunkInterest::waiting) != 0;
  send_not_modified(world, session, is_more);
  end_delivery(world, session, now);
  start_loads(world, now);
}

void deliver_loaded(WorldState& world, const ChunkKey& key, const Clocks& now) {
  const ChunkPtr chunk = world.authority.chunks().find(key);
  bool has_delivered = false;
  for (const SessionId session : world.interest.waiting(key)) {
    world.loads.cancel(session, key);  // the load was requested by another session too
    if (is_stalled(world, *world.find(session), now)) {
      world.interest.set_state(session, key, ChunkInterest::wanted);
    } else {
      send_chunk(world, session, key, chunk, ChunkInterest::subscribed, now);
    }
    // One delivery in this task, the others in tasks of their own.
    if (!std::exchange(has_delivered, true)) {
      deliver(world, session, now);
    } else {
      world.deliveries.insert(session);
    }
  }
}

void deliver_next(WorldState& world, const Clocks& now) {
  if (const auto next = world.deliveries.take_next()) deliver(world, *next, now);
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
  for (const ChunkKey& key : world.interest.take_released(kReleasedPerTask)) {
    if (!world.interest.is_used(key)) world.authority.chunks().released(key);
  }
}

}  // namespace runstone
