#include "server/world/cached_chunk_handlers.hpp"

#include <algorithm>

#include "common/core/key_text.hpp"
#include "server/world/delivery.hpp"
#include "server/world/tile_handlers.hpp"

namespace runstone {
namespace {

/// Returns true if the log may hold the edits that the copy lacks: they are on disk, and the
/// claimed version precedes the chunk's.
bool can_read_missing_edits(const WorldState& world, const CachedChunk& claim,
                            const Version& version) {
  return claim.version.seq < version.seq && claim.version.epoch <= version.epoch &&
         version.seq <= world.durable;
}

}  // namespace

void on_cached_chunks(WorldState& world, SessionId session, const CachedChunks& cached) {
  WorldSession& mine = *world.find(session);
  if (mine.history) return;  // a session in the past gets nothing of the live world
  const SessionInterest& interest = *world.interest.find(session);
  const bool are_tiles = cached.chunks.front().key.lod > 0;
  if (are_tiles) world.output.charge_reading(session, cached.chunks.size() * kTileClaimBytes);
  for (const CachedChunk& chunk : cached.chunks) {
    if (are_tiles && !accepts_claim(world, mine, chunk.key)) continue;
    const auto state = interest.state(chunk.key);
    const bool is_answered =
        state && *state != ChunkInterest::wanted && *state != ChunkInterest::waiting;
    if (is_answered) continue;
    if (mine.claims.add(chunk)) continue;
    return close_session(
        world, session, GoodbyeReason::flooding,
        "claims to hold more than " + std::to_string(kClaimsPerSessionMax) + " chunks");
  }
}

ClaimReply reply_to_claim(WorldState& world, SessionId session, const ChunkKey& key,
                          const ChunkPtr& chunk) {
  WorldSession& mine = *world.find(session);
  const CachedChunk* claim = mine.claims.find(key);
  if (claim == nullptr) return ClaimReply::none;
  if (claim->version == chunk->version) {
    const bool is_same = claim->digest == claim_digest(chunk->digest);
    mine.claims.drop(key);
    if (is_same) {
      mine.not_modified_due.push_back({key, chunk->version.seq});
      ++world.counters.not_modified_sent;
      return ClaimReply::queued;
    }
    ++world.counters.claims_drifted;
    world.environment.report(
        OperatorLogLevel::warn,
        "session=" + std::to_string(session) + " chunk=" + text_of(key) +
            " differs in the client's cache at the same version: sending a snapshot");
    return ClaimReply::none;
  }
  if (!can_read_missing_edits(world, *claim, chunk->version)) {
    mine.claims.drop(key);
    return ClaimReply::none;
  }
  if (!world.environment.send_update(session, view_in_force(world, session), key, chunk,
                                     claim->version))
    return ClaimReply::full;
  mine.claims.drop(key);
  ++world.counters.updates_sent;
  return ClaimReply::queued;
}

bool send_not_modified(WorldState& world, SessionId session, bool is_more) {
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return true;
  std::vector<UnmodifiedChunk>& due = mine->not_modified_due;
  while (due.size() >= (is_more ? kChunksNotModifiedMax : 1)) {
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
    ChunksNotModified same{view_in_force(world, session), {first, end}};
    const auto one_key = [](const UnmodifiedChunk& a, const UnmodifiedChunk& b) {
      return a.key == b.key;
    };
    same.chunks.erase(std::unique(same.chunks.begin(), same.chunks.end(), one_key),
                      same.chunks.end());
    if (!world.output.send(session, encode_message(same))) {
      ++world.counters.queue_full;
      return false;
    }
    due.erase(due.begin(), end);
  }
  return true;
}

}  // namespace runstone
