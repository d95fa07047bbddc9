#include "server/history/keyframe_maker.hpp"

#include <memory>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {

namespace {

constexpr std::size_t kSliceChunks = 32;  // in one transaction; small, because edits wait for it

}  // namespace

StoreResult<Sequence> KeyframeMaker::next_due(const Progress& progress) {
  const auto range = reader_.log_range();
  if (!range) return failure(range.error());
  if (!read_) {
    const auto keyframes = reader_.keyframes();
    if (!keyframes) return failure(keyframes.error());
    read_ = keyframes->empty() ? range->first - 1 : keyframes->back().at.version.seq;
  }
  const std::int32_t edge = reader_.meta().chunk_edge;
  const Sequence last = range->last.version.seq;
  Sequence due = 0;
  bool is_cancelled = false;
  const auto read = reader_.read_log(*read_ + 1, last, [&](const EditRecord& record) {
    read_ = record.version.seq;
    ++edits_;
    for (const ChunkCoord& chunk : touched_chunks(record.edit, edge)) touched_.insert(chunk);
    if (edits_ >= policy_.edits_min && edits_ / policy_.edits_per_chunk >= touched_.size())
      due = *read_;
    if (progress && *read_ % WorldAt::kProgressEdits == 0) is_cancelled = !progress(*read_, last);
    return due == 0 && !is_cancelled;
  });
  if (!read) return failure(read.error());
  if (is_cancelled) {
    return failure(StoreError{StoreError::Kind::cancelled, reader_.file(), "edit_log",
                              "was not read to the end"});
  }
  return due;
}

StoreResult<void> KeyframeMaker::make_due(const Save& save, const Progress& progress) {
  if (policy_.edits_min == 0) return {};
  for (;;) {
    const auto due = next_due(progress);
    StoreResult<void> made;
    if (!due) {
      made = failure(due.error());
    } else if (*due == 0) {
      return {};
    } else {
      made = make_at(*due, save, progress);
    }
    edits_ = 0;
    touched_.clear();
    if (!made) {
      read_.reset();  // the next call begins at the newest keyframe again
      return made;
    }
  }
}

StoreResult<void> KeyframeMaker::make_at(Sequence at, const Save& save, const Progress& progress) {
  auto world = WorldAt::open(reader_, generator_, at, progress);
  if (!world) return failure(world.error());
  Keyframe keyframe = world->untouched();
  Chunks slice;
  for (const ChunkKey& key : world->touched()) {
    if (slice.size() == kSliceChunks) {
      if (auto saved = save(std::exchange(slice, {}), std::nullopt); !saved) return saved;
    }
    auto chunk = world->chunk(key);
    if (!chunk) return failure(chunk.error());
    ++keyframe.chunks;
    keyframe.world_digest = keyframe.world_digest + world_digest_term(key, chunk->digest);
    slice.emplace_back(key, std::make_shared<const Chunk>(*std::move(chunk)));
    if (progress && !progress(at, at)) {
      return failure(StoreError{StoreError::Kind::cancelled, reader_.file(),
                                "keyframe seq=" + std::to_string(at), "was not finished"});
    }
  }
  if (auto saved = save(std::move(slice), keyframe); !saved) return saved;
  ++made_;
  return {};
}

}  // namespace runstone
