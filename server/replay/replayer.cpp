#include "server/replay/replayer.hpp"

#include <algorithm>
#include <utility>

#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/history/base_chunk.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {

namespace {

constexpr Sequence kProgressEdits = 1024;
constexpr const char* kKeyframe = "keyframe";

}  // namespace

std::string ReplayDifference::message() const {
  std::string line = source + ": chunk=" + text_of(key) + " version=" + text_of(expected_version);
  if (expected_version != rebuilt_version) {
    return line + " is not in the log, which has the chunk at version=" + text_of(rebuilt_version);
  }
  return line + " digest=" + to_hex(expected) + ", replay gives digest=" + to_hex(rebuilt);
}

Replayer::Replayer(WorldReader& store, const Generator& generator)
    : store_(store), generator_(generator), edge_(store.meta().chunk_edge) {}

void Replayer::expect(const std::string& source, const DigestList& list) {
  for (const DigestCheckEntry& entry : list.chunks) {
    listed_[entry.key].emplace(entry.version, Expected{source, entry.version, entry.digest});
  }
}

void Replayer::expect_keyframes(const std::vector<StoredChunk>& chunks) {
  for (const StoredChunk& chunk : chunks) {
    listed_[chunk.key].emplace(chunk.version, Expected{kKeyframe, chunk.version, chunk.digest});
  }
}

void Replayer::count(const Expected& expected) {
  ++(expected.source == kKeyframe ? report_.keyframes_compared : report_.listed_compared);
}

void Replayer::differs(ReplayDifference difference) {
  ++report_.differences;
  if (!report_.first) report_.first = std::move(difference);
}

void Replayer::check(const ChunkKey& key, const Expected& expected, const Chunk& rebuilt) {
  if (expected.version == rebuilt.version && expected.digest == rebuilt.digest) return;
  differs(
      {expected.source, key, expected.version, rebuilt.version, expected.digest, rebuilt.digest});
}

StoreResult<void> Replayer::compare(const ChunkKey& key, ReplayedChunk& rebuilt) {
  const Version version = rebuilt.chunk().version;
  if (const auto snapshot = snapshots_.find(key);
      snapshot != snapshots_.end() && snapshot->second == version) {
    rebuilt.flush(scratch_);
    const auto stored = store_.load_snapshot(key);
    if (!stored) return failure(stored.error());
    // A running server may have replaced the snapshot. Then there is none to compare at this
    // version.
    if (stored->has_value() && (*stored)->version == version) {
      check(key, {"snapshot", version, (*stored)->digest}, rebuilt.chunk());
      ++report_.snapshots_compared;
    } else {
      ++report_.not_compared;
    }
    snapshots_.erase(snapshot);
  }
  const auto listed = listed_.find(key);
  if (listed == listed_.end()) return {};
  const auto [first, last] = listed->second.equal_range(version);
  if (first != last) rebuilt.flush(scratch_);
  for (auto row = first; row != last; ++row) {
    check(key, row->second, rebuilt.chunk());
    count(row->second);
  }
  listed->second.erase(first, last);
  return {};
}

StoreResult<void> Replayer::replay_edit(const EditRecord& record) {
  for (const ChunkCoord at : touched_chunks(record.edit, edge_)) {
    const ChunkKey key{0, at};
    auto found = chunks_.find(key);
    if (found == chunks_.end()) {
      auto base = base_chunk(store_, generator_, key);
      if (!base) return failure(base.error());
      found = chunks_.emplace(key, ReplayedChunk(*std::move(base), origin_of(at, edge_))).first;
      if (auto compared = compare(key, found->second); !compared) return compared;
    }
    ReplayedChunk& rebuilt = found->second;
    rebuilt.add(record.edit, record.version, scratch_);
    if (auto compared = compare(key, rebuilt); !compared) return compared;
  }
  ++report_.edits;
  return {};
}

StoreResult<void> Replayer::expect_snapshots() {
  const auto keys = store_.snapshot_keys();
  if (!keys) return failure(keys.error());
  for (const auto& [key, version] : *keys) snapshots_.emplace(key, version);
  return {};
}

StoreResult<void> Replayer::compare_rest() {
  for (const auto& [key, version] : snapshots_) {
    if (key.lod != 0 || version.seq > report_.seq) {
      ++report_.not_compared;
      continue;
    }
    const auto stored = store_.load_snapshot(key);
    if (!stored) return failure(stored.error());
    const Digest digest = stored->has_value() ? (*stored)->digest : Digest{};
    if (auto compared = compare_left_over(key, {"snapshot", version, digest}); !compared)
      return compared;
    ++report_.snapshots_compared;
  }
  for (const auto& [key, rows] : listed_) {
    for (const auto& [version, expected] : rows) {
      // Versions that retention has removed cannot be compared, because the log begins with a later
      // version.
      const bool is_removed = head_ > 0 && version.seq <= head_ && chunks_.contains(key);
      if (key.lod != 0 || version.seq > report_.seq || is_removed) {
        ++report_.not_compared;
        continue;
      }
      if (auto compared = compare_left_over(key, expected); !compared) return compared;
      count(expected);
    }
  }
  return {};
}

StoreResult<void> Replayer::compare_left_over(const ChunkKey& key, const Expected& expected) {
  // Either no edit touched the chunk, or the log never had the version, which check() then finds.
  if (const auto found = chunks_.find(key); found != chunks_.end()) {
    check(key, expected, found->second.chunk());
    return {};
  }
  const auto base = base_chunk(store_, generator_, key);
  if (!base) return failure(base.error());
  check(key, expected, *base);
  return {};
}

StoreResult<ReplayReport> Replayer::run(Sequence at, const Progress& progress) {
  const auto range = store_.log_range();
  if (!range) return failure(range.error());
  report_.seq = std::min(at, range->last.version.seq);
  if (report_.seq + 1 < range->first) {
    const auto head = store_.log_head();
    if (!head) return failure(head.error());
    return failure(StoreError{StoreError::Kind::bad_request, store_.file(), "edit_log",
                              "begins at seq=" + std::to_string(range->first) +
                                  ": what lies before is in the base, " + removed_up_to(*head)});
  }
  if (const auto expected = expect_snapshots(); !expected) return failure(expected.error());

  head_ = range->first - 1;
  if (head_ > 0) {
    // Chunks whose edits were all moved into the base belong to the world too.
    const auto base = store_.base_chunks();
    if (!base) return failure(base.error());
    for (const StoredChunk& stored : *base) {
      if (stored.version == Version{}) continue;
      auto chunk = base_chunk(store_, generator_, stored.key);
      if (!chunk) return failure(chunk.error());
      const auto found = chunks_
                             .emplace(stored.key, ReplayedChunk(*std::move(chunk),
                                                                origin_of(stored.key.at, edge_)))
                             .first;
      if (auto compared = compare(stored.key, found->second); !compared)
        return failure(compared.error());
    }
  }

  StoreResult<void> replayed;
  const auto read = store_.read_log(1, report_.seq, [&](const EditRecord& record) {
    replayed = replay_edit(record);
    if (progress && record.version.seq % kProgressEdits == 0)
      progress(record.version.seq, report_.seq);
    return replayed.has_value();
  });
  if (!read) return failure(read.error());
  if (!replayed) return failure(replayed.error());

  for (auto& [key, rebuilt] : chunks_) {
    rebuilt.flush(scratch_);
    const Chunk& chunk = rebuilt.chunk();
    // The digest that followed every edit must be that of the runs.
    check(key, {"followed digest", chunk.version, digest_of(chunk.voxels)}, chunk);
    report_.digests.push_back({key, chunk.version, chunk.digest});
    report_.world_digest = report_.world_digest + world_digest_term(key, chunk.digest);
  }
  if (const auto compared = compare_rest(); !compared) return failure(compared.error());
  report_.voxels_changed = scratch_.voxels_changed;
  report_.stack_depths = scratch_.depths;
  return std::move(report_);
}

}  // namespace runstone
