#include "server/world/ground/chunk_sending.hpp"

#include <algorithm>
#include <string>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

/// Returns true if the log may hold the edits that the copy lacks: they are on disk, and the
/// claimed version precedes the chunk's.
bool can_read_missing_edits(const Order& order, const CachedChunk& claim, const Version& version) {
  return claim.version.seq < version.seq && claim.version.epoch <= version.epoch &&
         version.seq <= order.durable();
}

}  // namespace

bool ChunkSending::is_stalled(const Viewer& viewer, const Clocks& now) const {
  const std::optional<TimeUs>& since = viewer.chunks.stalled_us;
  return since && now.steady_us - *since < base_.config.retry_interval_us;
}

std::uint32_t ChunkSending::view_in_force(const Viewer& viewer) const {
  const std::optional<View>& view = base_.interest.find(viewer.id())->view();
  return view ? view->number : 0;
}

ViewState ChunkSending::view_state(const Viewer& viewer, ViewPhase phase) const {
  ViewState state;
  state.request = viewer.past.request;
  state.view = view_in_force(viewer);
  state.phase = phase;
  state.past = viewer.sees_past();
  if (state.past) {
    state.seq = viewer.past.view->seq;
    state.utc_us = viewer.past.view->utc_us;
  }
  return state;
}

void ChunkSending::put_off(Viewer& viewer, const ChunkKey& key, const Clocks& now) {
  ++base_.counters.queue_full;
  viewer.chunks.stalled_us = now.steady_us;
  base_.interest.set_state(viewer.id(), key, ChunkInterest::wanted);
}

ChunkSending::ClaimReply ChunkSending::reply_to_claim(Viewer& viewer, const ChunkKey& key,
                                                      const ChunkPtr& chunk) {
  CacheClaims& claims = viewer.chunks.claims;
  const CachedChunk* claim = claims.find(key);
  if (claim == nullptr) return ClaimReply::none;
  if (claim->version == chunk->version) {
    const bool is_same = claim->digest == claim_digest(chunk->digest);
    claims.drop(key);
    if (is_same) {
      viewer.chunks.not_modified.push_back({key, chunk->version.seq});
      ++base_.counters.not_modified_sent;
      return ClaimReply::queued;
    }
    ++base_.counters.claims_drifted;
    base_.environment.report(
        OperatorLogLevel::warn,
        "session=" + std::to_string(viewer.id()) + " chunk=" + text_of(key) +
            " differs in the client's cache at the same version: sending a snapshot");
    return ClaimReply::none;
  }
  if (!can_read_missing_edits(base_.order, *claim, chunk->version)) {
    claims.drop(key);
    return ClaimReply::none;
  }
  if (!base_.environment.send_update(viewer.id(), view_in_force(viewer), key, chunk,
                                     claim->version))
    return ClaimReply::full;
  claims.drop(key);
  ++base_.counters.updates_sent;
  return ClaimReply::queued;
}

ChunkSending::AnswersSent ChunkSending::send_not_modified(Viewer& viewer, bool is_more) {
  std::vector<UnmodifiedChunk>& due = viewer.chunks.not_modified;
  std::size_t messages = 0;
  while (due.size() >= (is_more ? kChunksNotModifiedMax : 1)) {
    if (messages++ == kNotModifiedPerCall) {
      base_.deliveries.insert(viewer.id());
      return AnswersSent::some;
    }
    const std::size_t count = std::min(due.size(), kChunksNotModifiedMax);
    // A chunk that left the view and came back may be due twice. The newer version is sent.
    const auto newest_first = [](const UnmodifiedChunk& a, const UnmodifiedChunk& b) {
      return a.key != b.key ? a.key < b.key : a.seq > b.seq;
    };
    const auto first = due.begin();
    std::sort(first, first + static_cast<std::ptrdiff_t>(count), newest_first);
    // A message has chunks of one level of detail.
    const auto end = std::find_if(
        first, first + static_cast<std::ptrdiff_t>(count),
        [level = first->key.lod](const UnmodifiedChunk& one) { return one.key.lod != level; });
    ChunksNotModified same{view_in_force(viewer), {first, end}};
    const auto one_key = [](const UnmodifiedChunk& a, const UnmodifiedChunk& b) {
      return a.key == b.key;
    };
    same.chunks.erase(std::unique(same.chunks.begin(), same.chunks.end(), one_key),
                      same.chunks.end());
    if (!base_.sessions.send_or_skip(viewer.session, encode_message(same)))
      return AnswersSent::full;
    due.erase(due.begin(), end);
  }
  return AnswersSent::all;
}

bool ChunkSending::queue_uniform(Viewer& viewer, const ChunkKey& key, const Chunk& chunk,
                                 const Clocks& now) {
  std::vector<UniformChunk>& due = viewer.chunks.uniform;
  if (due.size() >= kUniformWaitingMax && !send_uniform(viewer, now)) return false;
  due.push_back({key, material_at(chunk.voxels, {0, 0, 0}), chunk.version});
  if (due.size() >= kUniformPerMessage) send_uniform(viewer, now);
  return true;
}

bool ChunkSending::send_uniform(Viewer& viewer, const Clocks& now) {
  std::vector<UniformChunk>& due = viewer.chunks.uniform;
  if (due.empty()) return true;
  if (is_stalled(viewer, now)) return false;
  // A chunk that is due twice is sent at its newer version.
  const auto before = [](const UniformChunk& a, const UniformChunk& b) {
    return a.key != b.key ? a.key < b.key : b.version < a.version;
  };
  const auto same = [](const UniformChunk& a, const UniformChunk& b) { return a.key == b.key; };
  std::sort(due.begin(), due.end(), before);
  due.erase(std::unique(due.begin(), due.end(), same), due.end());
  while (!due.empty()) {
    const std::uint8_t level = due.front().key.lod;
    const auto end = std::find_if(
        due.begin(), due.end(), [level](const UniformChunk& one) { return one.key.lod != level; });
    const UniformChunks message{view_in_force(viewer), {due.begin(), end}};
    if (!base_.sessions.send_or_skip(viewer.session, encode_message(message))) {
      viewer.chunks.stalled_us = now.steady_us;
      return false;
    }
    due.erase(due.begin(), end);
    ++base_.counters.uniform_messages;
  }
  return true;
}

bool ChunkSending::send_view_states(Viewer& viewer, const Clocks& now) {
  ChunksDue& due = viewer.chunks;
  if (!due.begins && !due.refused && !due.complete) return true;
  // Answers about the live world precede the state that ends it.
  const AnswersSent answers = send_not_modified(viewer, false);
  if (answers == AnswersSent::full) due.stalled_us = now.steady_us;
  if (answers != AnswersSent::all) return false;
  if (!send_uniform(viewer, now)) return false;
  for (std::optional<ViewState>* report : {&due.begins, &due.refused, &due.complete}) {
    if (!*report) continue;
    if (!base_.sessions.send_or_skip(viewer.session, encode_message(**report))) {
      due.stalled_us = now.steady_us;
      return false;
    }
    report->reset();
  }
  return true;
}

void ChunkSending::end_delivery(Viewer& viewer, const Clocks& now) {
  ChunksDue& due = viewer.chunks;
  const bool more_come = base_.interest.find(viewer.id())->count(ChunkInterest::waiting) > 0 ||
                         (viewer.sees_past() && viewer.past.view->loading > 0);
  if (more_come || !send_uniform(viewer, now)) return;
  const bool is_answered = due.not_modified.empty() && !base_.interest.nearest_wanted(viewer.id());
  if (due.is_view_complete || !is_answered) return;
  due.is_view_complete = true;
  due.complete = view_state(viewer, ViewPhase::complete);
  send_view_states(viewer, now);
}

bool ChunkSending::send_chunk(Viewer& viewer, const ChunkKey& key, const ChunkPtr& chunk,
                              ChunkInterest then, const Clocks& now) {
  if (chunk == nullptr) {
    const ChunkUnavailable unavailable{view_in_force(viewer), {key}, UnavailableReason::damaged};
    if (!base_.sessions.send(viewer.session, encode_message(unavailable))) {
      put_off(viewer, key, now);
      return false;
    }
    base_.interest.set_state(viewer.id(), key, ChunkInterest::unavailable);
    ++base_.counters.unavailable_sent;
    return true;
  }
  const ClaimReply held =
      then == ChunkInterest::subscribed ? reply_to_claim(viewer, key, chunk) : ClaimReply::none;
  if (held == ClaimReply::queued) {
    base_.interest.set_state(viewer.id(), key, then);
    return true;
  }
  const auto send = [&] {
    return chunk->voxels.is_uniform()
               ? queue_uniform(viewer, key, *chunk, now)
               : base_.environment.send_snapshot(viewer.id(), view_in_force(viewer), key, chunk);
  };
  if (held == ClaimReply::full || !send()) {
    put_off(viewer, key, now);
    return false;
  }
  base_.interest.set_state(viewer.id(), key, then);
  ++base_.counters.snapshots_sent;
  return true;
}

void ChunkSending::forget_unsent(Viewer& viewer) {
  const SessionInterest& interest = *base_.interest.find(viewer.id());
  const auto is_void = [&](const auto& chunk) {
    if (chunk.key.lod > 0) return viewer.tiles.interest->status(chunk.key) == TileStatus::unknown;
    const auto state = interest.state(chunk.key);
    return state != ChunkInterest::subscribed && state != ChunkInterest::history_sent;
  };
  std::erase_if(viewer.chunks.uniform, is_void);
  std::erase_if(viewer.chunks.not_modified, is_void);
  base_.environment.forget_outside(viewer.id(), *interest.view());
}

void ChunkSending::mark_outdated(Viewer& viewer, std::span<const ChunkKey> keys,
                                 const Clocks& now) {
  viewer.chunks.stalled_us = now.steady_us;
  for (const ChunkKey& key : keys) {
    if (!base_.interest.subscribes(viewer.id(), key)) continue;
    base_.interest.set_state(viewer.id(), key, ChunkInterest::wanted);
    ++base_.counters.chunks_stale;
  }
}

}  // namespace runstone
