#include "server/runtime/counters_line.hpp"

#include <spdlog/fmt/fmt.h>

#include "common/runs/dense.hpp"

namespace runstone {
namespace {

std::string sessions_part(const WorldServer& world, const NetCounters& net) {
  const WorldCounters& w = world.counters();
  return fmt::format("connections={} refused={} sessions={} opened={} closed={} malformed={}",
                     net.connections.load(), net.refused.load(), world.session_count(),
                     w.sessions_opened, w.sessions_closed, net.malformed.load());
}

/// The place of the server among the servers of its world.
std::string ownership_part(const WorldServer& world) {
  return fmt::format("epoch={} owns_world={:d} follows_owner={:d} followers={}",
                     world.order().epoch(), world.cluster().owns_world(),
                     world.cluster().is_following() && world.cluster().is_live(),
                     world.cluster().follower_count());
}

std::string log_part(const WorldServer& world, const LogWriter::Counters& log) {
  const WorldCounters& w = world.counters();
  return fmt::format(
      "edits_ordered={} edits_rejected={} commits={} seq={} durable={} checkpoint={} log_queue={} "
      "group_commits={} snapshots_written={} keyframes={}",
      w.edits_ordered, w.edits_rejected, w.commits, world.order().head(), world.order().durable(),
      world.order().checkpoint(), log.queued_records, log.commits, log.snapshots, log.keyframes);
}

std::string chunks_part(const WorldServer& world, const RuntimeCounters& runtime) {
  const WorldCounters& w = world.counters();
  const WorldMemory memory = world.order().memory();
  return fmt::format(
      "chunks_resident={} resident_bytes={} stacked_bytes={} queued_bytes={} chunks_failed={} "
      "snapshots_sent={} snapshots_encoded={} same_sent={} updates_sent={} claims_drifted={} "
      "tiles_sent={} tiles_same={} "
      "chunks_requested={} unavailable_sent={} chunks_stale={}",
      world.order().chunks().resident_count(), memory.voxels, memory.stacked, memory.queued,
      w.chunks_failed, w.snapshots_sent, runtime.snapshots_encoded, w.not_modified_sent,
      w.updates_sent, w.claims_drifted, w.tiles_sent, w.tiles_not_modified, w.chunks_requested,
      w.unavailable_sent, w.chunks_stale);
}

std::string sending_part(const WorldServer& world, const NetCounters& net,
                         const RuntimeCounters& runtime) {
  const WorldCounters& w = world.counters();
  return fmt::format(
      "queue_full={} digest_checks_sent={} digest_mismatches={} commits_sent={} "
      "commit_enqueue_us={} commit_sends={} commit_send_ms={} bytes_in={} bytes_out={} "
      "chunk_bytes_out={} edit_bytes_out={} memory_bytes={} log_lines_dropped={} row_faults={} {}{}",
      w.queue_full, w.digest_checks_sent, w.digest_mismatches, w.commits_sent,
      runtime.commit_enqueue_us, net.commit_sends.load(), net.commit_send_ns.load() / 1'000'000,
      net.bytes_in.load(), net.bytes_out.load(), net.chunk_bytes_out.load(),
      net.edit_bytes_out.load(), runtime.memory_bytes, runtime.log_lines_dropped,
      runtime.row_faults, retention_counters(runtime.retention),
      runtime.backups ? " " + backup_counters(*runtime.backups) : "");
}

std::string waits_part(const char* name, const WaitHistogram& waits) {
  std::string out = fmt::format("{0}_count={1} {0}_us={2}", name, waits.count(), waits.sum_us());
  for (std::size_t i = 0; i < WaitHistogram::kBoundsMs.size(); ++i)
    out += fmt::format(" {}_ms_le_{}={}", name, WaitHistogram::kBoundsMs[i], waits.at_most(i));
  return out;
}

/// Sizes that are not known are left out.
std::string health_part(const WorldServer& world, const ServerHealth& health) {
  std::string out =
      fmt::format("uptime_s={} read_only={:d} durable_lag_us={}", health.uptime_us / 1'000'000,
                  !read_only_reason(world.order()).empty(), health.durable_lag_us);
  const auto add = [&](const char* name, const std::optional<std::uint64_t>& bytes) {
    if (bytes) out += fmt::format(" {}={}", name, *bytes);
  };
  add("disk_free_bytes", health.disk_free_bytes);
  add("world_bytes", health.world_bytes);
  add("wal_bytes", health.wal_bytes);
  add("log_bytes", health.log_bytes);
  return out;
}

}  // namespace

std::string counters_line(const WorldServer& world, const NetCounters& net,
                          const LogWriter::Counters& log, const RuntimeCounters& runtime) {
  return fmt::format("counters {} {} {} {} {} {} {} {} stack_depths=\"{}\" dense_expansions={}",
                     sessions_part(world, net), ownership_part(world), log_part(world, log),
                     chunks_part(world, runtime), sending_part(world, net, runtime),
                     health_part(world, runtime.health),
                     waits_part("edit_wait", world.order().authority().edit_waits()),
                     waits_part("durable_wait", runtime.durable_waits),
                     world.order().chunks().stack_depths().text(), dense_expansions());
}

}  // namespace runstone
