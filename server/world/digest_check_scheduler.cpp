#include "server/world/digest_check_scheduler.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

void send_audit(WorldState& world, SessionId session) {
  DigestCheck audit;
  std::set<ChunkKey> seen;
  while (audit.entries.size() < world.config.audit_chunks) {
    const auto key = world.interest.next_for_audit(session);
    if (!key || !seen.insert(*key).second) break;
    const ChunkPtr chunk = world.authority.chunks().find(*key);
    if (chunk == nullptr) continue;
    const Digest digest = digest_of(chunk->voxels);
    if (digest != chunk->digest) {
      ++world.counters.audit_mismatches;
      world.ports.log(WorldLogLevel::error, "chunk=" + text_of(*key) + " digest of runs " +
                                                to_hex(digest) + " is not the one kept " +
                                                to_hex(chunk->digest));
    }
    audit.entries.push_back({*key, chunk->version, digest});
  }
  if (audit.entries.empty()) return;
  if (send_or_skip(world, session, encode_message(audit))) ++world.counters.audits_sent;
}

}  // namespace

void give_audit_turns(WorldState& world, const Clocks& now) {
  const std::vector<SessionId> open = world.open_sessions();
  const TimeUs interval = world.config.audit_interval_us;
  const TimeUs passed = std::min(now.steady_us - world.audits_us, interval);
  const auto turns = static_cast<TimeUs>(open.size()) * passed / interval;
  if (turns == 0) return;
  // What is left of a turn counts next time.
  world.audits_us = now.steady_us - passed + turns * interval / static_cast<TimeUs>(open.size());
  const auto next = std::upper_bound(open.begin(), open.end(), world.audit_served);
  const auto first = static_cast<std::size_t>(next - open.begin());
  for (std::size_t i = 0; i < static_cast<std::size_t>(turns); ++i) {
    world.audit_served = open[(first + i) % open.size()];
    send_audit(world, world.audit_served);
  }
}

}  // namespace runstone
