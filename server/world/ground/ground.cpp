#include "server/world/ground/ground.hpp"

#include <algorithm>
#include <utility>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

// The most chunks that one task of the world strand sends. It takes about a millisecond, so that
// edits do not wait long for a task.
constexpr std::size_t kChunksPerDelivery = 512;
// Bytes that count as read for each chunk that a client requests: with the default
// `read_kib_per_second`, a session gets 4,096 chunks a second.
constexpr std::size_t kRequestedChunkBytes = 256;

}  // namespace

Ground::Ground(const WorldConfig& config, WorldEnvironment& environment, WorldCounters& counters,
               Sessions& sessions, Order& order, const Rights& rights, Quotas& quotas)
    : base_{config, environment, counters, sessions, order, rights, quotas},
      loads_(base_),
      sending_(base_),
      tiles_(base_, loads_, sending_),
      travel_(base_, loads_, sending_, tiles_),
      views_(base_, loads_, sending_, tiles_),
      rules_(base_),
      digests_(base_),
      marks_(base_) {}

void Ground::add(Session& session) {
  base_.viewers.try_emplace(session.id, session);
  base_.interest.open(session.id);
}

void Ground::forget(const Session& session) {
  const auto found = base_.viewers.find(session.id);
  if (found == base_.viewers.end()) return;
  tiles_.forget(found->second);
  base_.interest.close(session.id);
  loads_.cancel(session.id);
  base_.viewers.erase(found);
}

void Ground::send_permissions(Session& session) { rules_.start(at(session)); }

std::optional<View> Ground::view_of(const Session& session) const {
  return base_.interest.find(session.id)->view();
}

bool Ground::sees_present(const Session& session) const {
  const PastSeen& past = at(session).past;
  return !past.view && !past.is_opening;
}

bool Ground::lags(const Session& session) const {
  return at(session).chunks.stalled_us.has_value();
}

void Ground::on_view(Session& session, const View& view, const Clocks& now) {
  Viewer& viewer = at(session);
  if (views_.on_view(viewer, view, now)) deliver(viewer, now);
}

void Ground::on_cached_chunks(Session& session, const CachedChunks& cached) {
  Viewer& viewer = at(session);
  if (viewer.sees_past()) return;  // a session in the past gets nothing of the live world
  const SessionInterest& interest = *base_.interest.find(session.id);
  const bool are_tiles = cached.chunks.front().key.lod > 0;
  if (are_tiles) base_.sessions.charge_reading(session, cached.chunks.size() * kTileClaimBytes);
  std::vector<CachedChunk> unanswered;
  for (const CachedChunk& chunk : cached.chunks) {
    if (are_tiles && !tiles_.accepts_claim(viewer, chunk.key)) continue;
    const auto state = interest.state(chunk.key);
    const bool is_answered =
        state && *state != ChunkInterest::wanted && *state != ChunkInterest::waiting;
    if (!is_answered) unanswered.push_back(chunk);
  }
  if (viewer.chunks.claims.add(unanswered)) return;
  base_.sessions.close(
      session, GoodbyeReason::flooding,
      "claims to hold more than " + std::to_string(kClaimsPerSessionMax) + " chunks");
}

void Ground::on_chunk_request(Session& session, const ChunkRequest& request, const Clocks& now) {
  Viewer& viewer = at(session);
  base_.sessions.charge_reading(session, request.keys.size() * kRequestedChunkBytes);
  for (const ChunkKey& key : request.keys) {
    viewer.chunks.claims.drop(key);  // the client rejects its copy
    const auto state = base_.interest.find(session.id)->state(key);
    const bool is_answered = state == ChunkInterest::subscribed ||
                             state == ChunkInterest::unavailable ||
                             state == ChunkInterest::history_sent;
    if (!is_answered) continue;
    if (viewer.sees_past()) viewer.past.view->sent.erase(key);
    base_.interest.set_state(session.id, key, ChunkInterest::wanted);
    ++base_.counters.chunks_requested;
  }
  deliver(viewer, now);
  loads_.collect_released();
}

void Ground::on_history_request(Session& session, const HistoryRequest& request,
                                const Clocks& now) {
  Viewer& viewer = at(session);
  if (travel_.on_request(viewer, request, now)) deliver(viewer, now);
}

void Ground::on_log_marks_request(Session& session, const LogMarksRequest& request,
                                  const Clocks& now) {
  marks_.on_request(at(session), request, now);
}

void Ground::edited(const std::vector<ChunkKey>& chunks, const Clocks& now) {
  tiles_.edited(chunks, now);
  for (const ChunkKey& key : chunks) {
    if (base_.order.chunks().stack_size(key) > base_.config.stack_load_edits)
      loads_.request(key, now);
  }
}

void Ground::mark_outdated(const Session& session, std::span<const ChunkKey> chunks,
                           const Clocks& now) {
  if (!session.is_closed) sending_.mark_outdated(at(session), chunks, now);
}

void Ground::deliver(Viewer& viewer, const Clocks& now) {
  if (viewer.session.is_closed || sending_.is_stalled(viewer, now)) return;
  const SessionId id = viewer.id();
  viewer.chunks.stalled_us.reset();
  base_.deliveries.erase(id);
  if (!sending_.send_view_states(viewer, now)) return;
  tiles_.request(viewer, now);
  if (viewer.sees_past()) {
    travel_.load_chunks(viewer, now);
    sending_.send_not_modified(viewer, false);
    return sending_.end_delivery(viewer, now);
  }
  WorldChunks& chunks = base_.order.chunks();
  const SessionInterest& interest = *base_.interest.find(id);
  std::size_t sent = 0;
  while (interest.count(ChunkInterest::waiting) < base_.config.loads_per_session_max) {
    const auto key = base_.interest.nearest_wanted(id);
    if (!key) break;
    if (sent == kChunksPerDelivery) {
      base_.deliveries.insert(id);
      break;
    }
    const ChunkPtr chunk = chunks.find(*key);
    const Residency residency = chunks.residency(*key);
    if (chunk != nullptr || residency == Residency::quarantined) {
      if (!sending_.send_chunk(viewer, *key, chunk, ChunkInterest::subscribed, now)) break;
      ++sent;
    } else {
      base_.interest.set_state(id, *key, ChunkInterest::waiting);
      if (residency == Residency::absent) loads_.request_for(viewer, *key);
    }
  }
  const bool is_more =
      base_.interest.nearest_wanted(id) || interest.count(ChunkInterest::waiting) != 0;
  sending_.send_not_modified(viewer, is_more);
  sending_.end_delivery(viewer, now);
  loads_.start(now);
}

void Ground::deliver_loaded(const ChunkKey& key, const Clocks& now) {
  const ChunkPtr chunk = base_.order.chunks().find(key);
  bool has_delivered = false;
  for (const SessionId session : base_.interest.waiting(key)) {
    loads_.cancel(session, key);  // the load was requested by another session too
    Viewer* const viewer = base_.find(session);
    if (viewer == nullptr) continue;  // closed in this task
    if (sending_.is_stalled(*viewer, now)) {
      base_.interest.set_state(session, key, ChunkInterest::wanted);
    } else {
      sending_.send_chunk(*viewer, key, chunk, ChunkInterest::subscribed, now);
    }
    // One delivery in this task, the others in tasks of their own.
    if (!std::exchange(has_delivered, true)) {
      deliver(*viewer, now);
    } else {
      base_.deliveries.insert(session);
    }
  }
}

void Ground::deliver_next(const Clocks& now) {
  const auto next = base_.deliveries.take_next();
  if (!next) return;
  if (Viewer* const viewer = base_.find(*next)) deliver(*viewer, now);
}

void Ground::drained(const Session& session, const Clocks& now) {
  if (Viewer* const viewer = base_.find(session.id)) {
    viewer->chunks.stalled_us.reset();
    deliver(*viewer, now);
  }
}

void Ground::retry(const Session& session, const Clocks& now) {
  Viewer* const viewer = base_.find(session.id);
  if (viewer == nullptr) return;
  if (base_.interest.nearest_wanted(session.id)) {
    base_.deliveries.insert(session.id);
  } else {
    deliver(*viewer, now);
  }
  sending_.send_not_modified(*viewer, false);  // they wait for more of them until the next tick
  sending_.send_uniform(*viewer, now);
}

void Ground::hurry_loads(const Clocks& now) {
  loads_.hurry();
  loads_.retry(now);
}

bool Ground::chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now) {
  WorldChunks& chunks = base_.order.chunks();
  loads_.ended(key);
  // A chunk that has arrived ends the count of failures, so the attempts below do not count.
  loads_.forget_failures(key);
  if (chunk.version > chunks.version(key) && !base_.order.owns_world()) {
    // The owner has saved it, and what made this version is still on its way. That may take as long
    // as the owner does not answer. A server that has lost the lease may read what the next owner
    // has saved.
    loads_.load_again(key, OperatorLogLevel::debug, "it is newer than what has arrived", now);
    return false;
  }
  if (const auto loaded = chunks.loaded(key, std::move(chunk)); !loaded) {
    ++base_.counters.chunks_failed;
    base_.environment.report(OperatorLogLevel::error,
                             "chunk=" + text_of(key) + " quarantined: " + loaded.error());
  }
  deliver_loaded(key, now);
  // A chunk that was loaded for its stack alone has no user, so nothing else makes it a candidate
  // for eviction.
  if (!base_.interest.is_used(key)) chunks.released(key);
  return true;
}

bool Ground::chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                          const Clocks& now) {
  loads_.ended(key);
  if (failure == LoadFailure::not_read && !base_.order.is_stopping() &&
      loads_.load_again(key, OperatorLogLevel::error, what, now))
    return false;
  loads_.forget_failures(key);
  ++base_.counters.chunks_failed;
  base_.order.chunks().quarantine(key);
  base_.environment.report(OperatorLogLevel::error,
                           "chunk=" + text_of(key) + " quarantined: " + what);
  deliver_loaded(key, now);
  return true;
}

void Ground::history_opened(SessionId session, std::uint32_t request,
                            const Result<OpenedHistory, std::string>& opened, const Clocks& now) {
  travel_.opening_ended();
  Viewer* const viewer = base_.find(session);
  if (viewer != nullptr && travel_.opened(*viewer, request, opened, now)) deliver(*viewer, now);
}

void Ground::history_chunk_loaded(SessionId session, HistoryNumber history, const ChunkKey& key,
                                  const Result<ChunkPtr, std::string>& chunk, const Clocks& now) {
  if (!chunk)
    base_.environment.report(OperatorLogLevel::error,
                             "chunk=" + text_of(key) + " of the past: " + chunk.error());
  Viewer* const viewer = base_.find(session);
  if (viewer != nullptr && travel_.chunk_made(*viewer, history, key, chunk ? *chunk : nullptr, now))
    deliver(*viewer, now);
}

void Ground::apply_views(const Clocks& now) {
  views_.apply_due(now);
  rules_.send_due();
}

void Ground::serve_waiting(const Clocks& now) {
  digests_.send_due(now);
  for (Viewer* viewer : base_.open()) {
    if (!travel_.can_open()) break;
    if (travel_.open_next(*viewer, now)) deliver(*viewer, now);
  }
  marks_.read_waiting(now);
  loads_.retry(now);
}

void Ground::start_work(const Clocks& now) {
  loads_.collect_released();
  loads_.keep_memory_bounds();
  loads_.start(now);  // of the chunks that waited for memory
  tiles_.start(now);
  tiles_.resend(now);
}

}  // namespace runstone
