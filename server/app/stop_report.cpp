#include "server/app/stop_report.hpp"

#include <map>
#include <optional>

#include "common/core/key_text.hpp"

namespace runstone {
namespace {

/// Compares a snapshot (null: there is none) with the chunk that was in memory. Returns how they
/// differ, or nullopt.
std::optional<std::string> difference(const DigestCheckEntry* stored,
                                      const DigestCheckEntry& live) {
  if (stored == nullptr) return "is missing, but the chunk was edited";
  if (stored->version != live.version) {
    return "has version=" + text_of(stored->version) +
           ", the server had version=" + text_of(live.version);
  }
  if (stored->digest != live.digest) {
    return "has digest=" + to_hex(stored->digest) +
           ", the server had digest=" + to_hex(live.digest);
  }
  return std::nullopt;
}

}  // namespace

StopReport sum_up(WorldReader& store, std::span<const std::pair<ChunkKey, ChunkPtr>> live,
                  const StopState& state, const std::function<bool()>& should_continue) {
  StopReport report;
  report.state = state;
  report.is_clean = report.digests.is_clean = state.is_clean();
  report.live_chunks = live.size();
  report.digests.world_id = store.meta().world_id;
  const auto failed = [&](const std::string& what) {
    if (report.error.empty()) report.error = what;
  };
  const auto range = store.log_range();
  if (range) report.digests.seq = range->last.version.seq;
  if (!range) failed(range.error().message());

  // Without time not even the list of the snapshots is read.
  report.is_summed = should_continue();
  std::map<ChunkKey, DigestCheckEntry> entries;
  const auto take_stored = [&](const ChunkKey& key) {
    const auto stored = store.load_snapshot(key);
    if (!stored) failed(stored.error().message());
    if (stored && stored->has_value()) entries[key] = {key, (*stored)->version, (*stored)->digest};
  };
  if (report.is_summed) {
    const auto keys = store.snapshot_keys();
    if (!keys) failed(keys.error().message());
    for (std::size_t i = 0; keys && i < keys->size() && report.is_summed; ++i) {
      take_stored((*keys)[i].first);
      report.is_summed = should_continue();
    }
  }
  for (const auto& [key, chunk] : live) {
    if (!report.is_clean || !report.is_summed) break;
    report.is_summed = should_continue();
    const DigestCheckEntry entry{key, chunk->version, digest_of(chunk->voxels)};
    const auto stored = entries.find(key);
    const auto differs = difference(stored == entries.end() ? nullptr : &stored->second, entry);
    if (differs) failed(store.file() + ": snapshot chunk=" + text_of(key) + ": " + *differs);
    entries[key] = entry;
  }
  if (!report.is_summed) {
    report.digests.is_clean = false;
    return report;
  }
  for (const auto& [key, entry] : entries) {
    report.digests.chunks.push_back(entry);
    report.world_digest = report.world_digest + world_digest_term(key, entry.digest);
  }
  return report;
}

std::string stop_line(const StopReport& report) {
  const std::string seq = "seq=" + std::to_string(report.digests.seq);
  const std::string chunks = std::to_string(report.digests.chunks.size());
  const std::string live = " live=" + std::to_string(report.live_chunks);
  if (!report.state.is_durable()) {
    return "stopped unclean " + seq + (report.is_summed ? " snapshots=" + chunks : "") + live +
           " lost_edits=" + std::to_string(report.state.lost_edits);
  }
  if (!report.is_summed || !report.is_clean)
    return "stopped " + seq + " chunks_left=" + std::to_string(report.state.chunks_left) + live;
  return "stopped " + seq + " edited_chunks=" + chunks + live +
         " world_digest=" + to_hex(report.world_digest);
}

}  // namespace runstone
