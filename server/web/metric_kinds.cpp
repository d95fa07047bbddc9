#include "server/web/metric_kinds.hpp"

#include <algorithm>
#include <array>

namespace runstone {
namespace {

constexpr auto kCounter = CounterType::counter, kGauge = CounterType::gauge;

constexpr std::array kKinds = {
    MetricKind{"connections", kCounter, "connections accepted since the start"},
    MetricKind{"refused", kCounter, "connections refused, or closed to make room, since the start"},
    MetricKind{"sessions", kGauge, "sessions of players now"},
    MetricKind{"opened", kCounter, "sessions that joined since the start"},
    MetricKind{"closed", kCounter, "sessions that the server ended since the start"},
    MetricKind{"malformed", kCounter, "messages that no client of this protocol sends"},
    MetricKind{"epoch", kGauge, "number of the start of the world's owner"},
    MetricKind{"owns_world", kGauge, "1 if this server orders the edits of the world"},
    MetricKind{"follows_owner", kGauge, "1 if this server follows the owner of the world"},
    MetricKind{"followers", kGauge, "servers that follow this one"},
    MetricKind{"edits_ordered", kCounter, "edits ordered since the start"},
    MetricKind{"edits_rejected", kCounter, "edits refused since the start"},
    MetricKind{"commits", kCounter, "groups of edits that were sent since the start"},
    MetricKind{"seq", kGauge, "sequence number of the newest edit"},
    MetricKind{"durable", kGauge, "sequence number of the newest edit that is on disk"},
    MetricKind{"checkpoint", kGauge, "sequence number from which a start replays the log"},
    MetricKind{"log_queue", kGauge, "records that wait to be written"},
    MetricKind{"group_commits", kCounter, "transactions of the log since the start"},
    MetricKind{"snapshots_written", kCounter, "chunks written as snapshots since the start"},
    MetricKind{"keyframes", kCounter, "keyframes written since the start"},
    MetricKind{"chunks_resident", kGauge, "chunks in memory"},
    MetricKind{"resident_bytes", kGauge, "memory of the chunks in memory"},
    MetricKind{"stacked_bytes", kGauge, "memory of edits that chunks have not applied yet"},
    MetricKind{"queued_bytes", kGauge, "memory of edits that wait"},
    MetricKind{"chunks_failed", kCounter,
               "chunks that could not be read. The log of the server names them"},
    MetricKind{"snapshots_sent", kCounter, "chunks sent, once for each session"},
    MetricKind{"snapshots_encoded", kCounter, "chunks encoded to be sent"},
    MetricKind{"same_sent", kCounter, "chunks that the client had in the same version"},
    MetricKind{"updates_sent", kCounter, "chunks that the client had in an earlier version"},
    MetricKind{"claims_drifted", kCounter, "copies of clients with the wrong voxels"},
    MetricKind{"tiles_sent", kCounter, "tiles sent, once for each session"},
    MetricKind{"tiles_same", kCounter, "tiles that the client had"},
    MetricKind{"chunks_requested", kCounter, "chunks that clients asked for again"},
    MetricKind{"unavailable_sent", kCounter, "chunks that could not be given to a session"},
    MetricKind{"chunks_stale", kCounter, "commits that did not fit the queue of a session"},
    MetricKind{"queue_full", kCounter, "messages that did not fit the queue of a session"},
    MetricKind{"digest_checks_sent", kCounter, "digests sent for comparison"},
    MetricKind{"digest_mismatches", kCounter, "digests that differ from their voxels"},
    MetricKind{"commits_sent", kCounter, "commits sent, once for each session"},
    MetricKind{"commit_enqueue_us", kCounter, "microseconds of processor spent to queue commits"},
    MetricKind{"commit_sends", kCounter, "rounds of sending commits"},
    MetricKind{"commit_send_ms", kCounter, "milliseconds of processor spent to send commits"},
    MetricKind{"bytes_in", kCounter, "bytes received"},
    MetricKind{"bytes_out", kCounter, "bytes sent"},
    MetricKind{"chunk_bytes_out", kCounter, "bytes of terrain sent"},
    MetricKind{"edit_bytes_out", kCounter, "bytes of edits sent"},
    MetricKind{"memory_bytes", kGauge, "memory of the server in RAM"},
    MetricKind{"log_lines_dropped", kCounter, "lines of the log that could not be written"},
    MetricKind{"row_faults", kGauge,
               "damaged rows of the world that the check has found. If it is not 0, the log of the "
               "server names them: stop the server and run runstone-server repair"},
    MetricKind{"backup_age_s", kGauge, "age in seconds of the last backup that the server made"},
    MetricKind{"backup_bytes", kGauge, "size of the world in the last backup"},
    MetricKind{"backup_new_bytes", kGauge, "bytes that the last backup added to its folder"},
    MetricKind{"backup_next_s", kGauge, "seconds until the next backup"},
    MetricKind{"backup_failures", kGauge,
               "attempts that failed since the last backup that was made"},
    MetricKind{"retention_days", kGauge, "days for which edits stay in the log, 0: for ever"},
    MetricKind{"retention_running", kGauge, "1 while old edits are being removed from the log"},
    MetricKind{"retention_head", kGauge,
               "sequence number up to which edits were removed, as the last run found it"},
    MetricKind{"retention_edits", kCounter, "edits removed from the log since the start"},
    MetricKind{"retention_parts", kCounter, "transactions that removed edits since the start"},
    MetricKind{"retention_writer_us", kCounter,
               "microseconds of the log writer that these transactions took"},
    MetricKind{"retention_writer_us_max", kGauge, "microseconds that the longest of them took"},
    MetricKind{"retention_failures", kGauge,
               "runs of the retention that failed since the last one that succeeded"},
    MetricKind{"uptime_s", kGauge, "seconds since the start of the server"},
    MetricKind{"read_only", kGauge, "1 if edits are refused, as on a full disk"},
    MetricKind{"durable_lag_us", kGauge, "age of the oldest edit that is not on disk, or 0"},
    MetricKind{"disk_free_bytes", kGauge, "bytes that the server may still write to its disk"},
    MetricKind{"world_bytes", kGauge, "size of the file of the world"},
    MetricKind{"wal_bytes", kGauge, "size of the write-ahead log of the world"},
    MetricKind{"log_bytes", kGauge, "size of the log of edits, as the daily check counted it"},
    MetricKind{"dense_expansions", kCounter,
               "grids that held a material for each voxel of a chunk"},
};

constexpr std::array kWaits = {
    WaitMetric{"edit_wait", "time from accepting an edit of a player to sending its commit"},
    WaitMetric{"durable_wait", "time from ordering an edit until it was on disk"},
};

}  // namespace

std::span<const MetricKind> metric_kinds() { return kKinds; }

const MetricKind* find_metric_kind(std::string_view counter) {
  const auto found = std::ranges::find(kKinds, counter, &MetricKind::name);
  return found == kKinds.end() ? nullptr : &*found;
}

std::span<const WaitMetric> wait_metrics() { return kWaits; }

bool is_part_of_waits(std::string_view counter) {
  return std::ranges::any_of(kWaits, [&](const WaitMetric& waits) {
    if (!counter.starts_with(waits.name)) return false;
    const std::string_view part = counter.substr(waits.name.size());
    return part == "_count" || part == "_us" || part.starts_with("_ms_le_");
  });
}

}  // namespace runstone
