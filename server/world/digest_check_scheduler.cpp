#include "server/world/digest_check_scheduler.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

// The runs that one tick hashes, about a millisecond; the last chunk may exceed it.
constexpr std::size_t kHashedRunsMax = 32 * 1024;

/// Returns the digest of a chunk. While there is room in `runs_left`, it is computed from the runs
/// and compared with the stored one, so that damage in memory is reported.
Digest checked_digest(WorldState& world, const ChunkKey& key, const Chunk& chunk,
                      std::size_t& runs_left) {
  if (runs_left == 0) return chunk.digest;
  runs_left -= std::min(runs_left, chunk.voxels.runs.size());
  const Digest digest = digest_of(chunk.voxels);
  if (digest != chunk.digest) {
    ++world.counters.digest_mismatches;
    world.environment.report(OperatorLogLevel::error,
                             "chunk=" + text_of(key) + " digest of runs " + to_hex(digest) +
                                 " differs from the stored one " + to_hex(chunk.digest));
  }
  return digest;
}

void send_digest_check(WorldState& world, SessionId session, std::size_t& runs_left) {
  DigestCheck check;
  std::set<ChunkKey> seen;
  // Where chunks have very many runs, each check begins to hash at another one of its chunks.
  const std::size_t checked_max = std::max<std::size_t>(1, world.config.digest_check_chunks);
  const std::size_t first_hashed =
      world.are_runs_short ? world.counters.digest_checks_sent % checked_max : 0;
  while (check.entries.size() < world.config.digest_check_chunks) {
    const auto key = world.interest.next_for_digest_check(session);
    if (!key || !seen.insert(*key).second) break;
    const ChunkPtr chunk = world.authority.chunks().find(*key);
    if (chunk == nullptr) continue;
    const bool is_hashed = runs_left > 0 && check.entries.size() >= first_hashed;
    check.entries.push_back(
        {*key, chunk->version,
         is_hashed ? checked_digest(world, *key, *chunk, runs_left) : chunk->digest});
  }
  if (check.entries.empty()) return;
  std::sort(check.entries.begin(), check.entries.end(),
            [](const DigestCheckEntry& a, const DigestCheckEntry& b) { return a.key < b.key; });
  if (send_or_skip(world, session, encode_message(check))) ++world.counters.digest_checks_sent;
}

}  // namespace

void send_due_digest_checks(WorldState& world, const Clocks& now) {
  const std::vector<SessionId> open = world.open_sessions();
  const TimeUs interval = world.config.digest_check_interval_us;
  const TimeUs passed = std::min(now.steady_us - world.digest_checks_us, interval);
  const auto count = static_cast<TimeUs>(open.size()) * passed / interval;
  if (count == 0) return;
  // The remainder of the division counts on the next tick.
  world.digest_checks_us =
      now.steady_us - passed + count * interval / static_cast<TimeUs>(open.size());
  const auto next = std::upper_bound(open.begin(), open.end(), world.digest_check_last);
  const auto first = static_cast<std::size_t>(next - open.begin());
  std::size_t runs_left = kHashedRunsMax;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    world.digest_check_last = open[(first + i) % open.size()];
    send_digest_check(world, world.digest_check_last, runs_left);
  }
  world.are_runs_short = runs_left == 0;
}

}  // namespace runstone
