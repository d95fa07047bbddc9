#include "server/world/ground/digest_checks.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

// The runs that one tick hashes, about a millisecond; the last chunk may exceed it.
constexpr std::size_t kHashedRunsMax = 32 * 1024;

}  // namespace

/// Returns the digest of a chunk. While there is room in `runs_left`, it is computed from the runs
/// and compared with the stored one, so that damage in memory is reported.
Digest DigestChecks::checked_digest(const ChunkKey& key, const Chunk& chunk,
                                    std::size_t& runs_left) {
  if (runs_left == 0) return chunk.digest;
  runs_left -= std::min(runs_left, chunk.voxels.runs.size());
  const Digest digest = digest_of(chunk.voxels);
  if (digest != chunk.digest) {
    ++base_.counters.digest_mismatches;
    base_.environment.report(OperatorLogLevel::error,
                             "chunk=" + text_of(key) + " digest of runs " + to_hex(digest) +
                                 " differs from the stored one " + to_hex(chunk.digest));
  }
  return digest;
}

void DigestChecks::send(Viewer& viewer, std::size_t& runs_left) {
  DigestCheck check;
  std::set<ChunkKey> seen;
  // Where chunks have very many runs, each check begins to hash at another one of its chunks.
  const std::size_t checked_max = std::max<std::size_t>(1, base_.config.digest_check_chunks);
  const std::size_t first_hashed =
      are_runs_short_ ? base_.counters.digest_checks_sent % checked_max : 0;
  while (check.entries.size() < base_.config.digest_check_chunks) {
    const auto key = base_.interest.next_for_digest_check(viewer.id());
    if (!key || !seen.insert(*key).second) break;
    const ChunkPtr chunk = base_.order.chunks().find(*key);
    if (chunk == nullptr) continue;
    const bool is_hashed = runs_left > 0 && check.entries.size() >= first_hashed;
    check.entries.push_back({*key, chunk->version,
                             is_hashed ? checked_digest(*key, *chunk, runs_left) : chunk->digest});
  }
  if (check.entries.empty()) return;
  std::sort(check.entries.begin(), check.entries.end(),
            [](const DigestCheckEntry& a, const DigestCheckEntry& b) { return a.key < b.key; });
  if (base_.sessions.send_or_skip(viewer.session, encode_message(check)))
    ++base_.counters.digest_checks_sent;
}

void DigestChecks::send_due(const Clocks& now) {
  const std::vector<Viewer*> open = base_.open();
  const TimeUs interval = base_.config.digest_check_interval_us;
  const TimeUs passed = std::min(now.steady_us - sent_us_, interval);
  const auto count = static_cast<TimeUs>(open.size()) * passed / interval;
  if (count == 0) return;
  // The remainder of the division counts on the next tick.
  sent_us_ = now.steady_us - passed + count * interval / static_cast<TimeUs>(open.size());
  const auto next = std::ranges::upper_bound(open, served_last_, {}, &Viewer::id);
  const auto first = static_cast<std::size_t>(next - open.begin());
  std::size_t runs_left = kHashedRunsMax;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    Viewer& viewer = *open[(first + i) % open.size()];
    served_last_ = viewer.id();
    send(viewer, runs_left);
  }
  are_runs_short_ = runs_left == 0;
}

}  // namespace runstone
