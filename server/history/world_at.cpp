#include "server/history/world_at.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

namespace {

constexpr const char* kRemoved =
    "was shortened by retention while it was read; open the moment again";

}  // namespace

Unexpected<StoreError> WorldAt::refuse(std::string what) const {
  return {{StoreError::Kind::bad_request, reader_->file(), "edit_log", std::move(what)}};
}

StoreResult<WorldAt> WorldAt::open(WorldReader& reader, const Generator& generator, Sequence at,
                                   const Progress& progress) {
  WorldAt world(reader, generator);
  const auto moment = reader.stored_moment(at);
  if (!moment) return failure(moment.error());
  world.end_ = moment->at;
  world.stored_at_ = moment->at.version.seq;
  for (const StoredChunk& chunk : moment->chunks) {
    world.chunks_.emplace_hint(world.chunks_.end(), chunk.key, Edited{chunk, {}});
  }
  if (const auto advanced = world.advance(at, progress); !advanced)
    return failure(advanced.error());
  return world;
}

StoreResult<void> WorldAt::advance(Sequence at, const Progress& progress,
                                   const std::function<void(const EditRecord&)>& each) {
  const Sequence from = end_.version.seq;
  if (at < from) {
    return refuse("cannot be followed back from seq=" + std::to_string(from) +
                  " to seq=" + std::to_string(at));
  }
  const auto last = reader_->last_sequence();
  if (!last) return failure(last.error());
  if (at > *last) {
    return refuse("ends at seq=" + std::to_string(*last) + ", before seq=" + std::to_string(at));
  }
  const std::size_t known = edits_.size();
  LogEnd end = end_;
  bool is_cancelled = false;
  const auto read = reader_->read_log(from + 1, at, [&](const EditRecord& record) {
    edits_.push_back(record.edit);
    versions_.push_back(record.version);
    end = {record.version, record.time_us};
    if (each) each(record);
    if (progress && record.version.seq % kProgressEdits == 0)
      is_cancelled = !progress(record.version.seq, at);
    return !is_cancelled;
  });
  StoreResult<void> outcome;
  if (!read) {
    outcome = failure(read.error());
  } else if (is_cancelled) {
    outcome = failure(StoreError{StoreError::Kind::cancelled, reader_->file(), "edit_log",
                                 "was not read to the end"});
  } else if (edits_.size() - known != at - from) {
    outcome = refuse(kRemoved);
  }
  if (!outcome) {
    edits_.resize(known);
    versions_.resize(known);
    return outcome;
  }
  for (std::size_t i = known; i < edits_.size(); ++i) {
    for (const ChunkCoord& coord : touched_chunks(edits_[i], edge_)) {
      chunks_[{0, coord}].edits.push_back(static_cast<std::uint32_t>(i));
    }
  }
  end_ = end;
  return {};
}

Version WorldAt::version(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return {};
  const Edited& edited = found->second;
  return edited.edits.empty() ? edited.stored->version : versions_[edited.edits.back()];
}

std::vector<ChunkKey> WorldAt::edited() const {
  std::vector<ChunkKey> keys;
  keys.reserve(chunks_.size());
  for (const auto& [key, edited] : chunks_) keys.push_back(key);
  return keys;
}

std::vector<ChunkKey> WorldAt::touched() const {
  std::vector<ChunkKey> keys;
  for (const auto& [key, edited] : chunks_) {
    if (!edited.edits.empty()) keys.push_back(key);
  }
  return keys;
}

Keyframe WorldAt::untouched() const {
  Keyframe keyframe{end_, 0, {}};
  for (const auto& [key, edited] : chunks_) {
    if (!edited.edits.empty()) continue;
    ++keyframe.chunks;
    keyframe.world_digest = keyframe.world_digest + world_digest_term(key, edited.stored->digest);
  }
  return keyframe;
}

StoreResult<Chunk> WorldAt::start_of(const ChunkKey& key, const Edited* edited,
                                     WorldReader& reader) const {
  if (edited == nullptr || !edited->stored) {
    auto chunk = base_chunk_in_any_order(reader, *generator_, key);
    if (chunk && chunk->version != Version{}) return refuse(kRemoved);
    return chunk;
  }
  auto stored = reader.load_stored(*edited->stored);
  if (!stored) return failure(stored.error());
  if (!stored->has_value()) return refuse(kRemoved);
  return **std::move(stored);
}

StoreResult<Chunk> WorldAt::replayed(const ChunkKey& key, WorldReader& reader,
                                     ReplayScratch& scratch) const {
  const auto found = chunks_.find(key);
  const Edited* edited = found == chunks_.end() ? nullptr : &found->second;
  auto chunk = start_of(key, edited, reader);
  if (!chunk || edited == nullptr || edited->edits.empty()) return chunk;
  ReplayedChunk replayed(*std::move(chunk), origin_of(key.at, edge_));
  for (const std::uint32_t edit : edited->edits)
    replayed.add(edits_[edit], versions_[edit], scratch);
  replayed.flush(scratch);
  return std::move(replayed.chunk());
}

StoreResult<Chunk> WorldAt::chunk(const ChunkKey& key) {
  auto chunk = replayed(key, *reader_, scratch_);
  const auto found = chunks_.find(key);
  // A keyframe has its chunks in their cheapest order.
  const bool is_as_stored = found != chunks_.end() && found->second.stored &&
                            !found->second.stored->is_base && found->second.edits.empty();
  if (chunk && !is_as_stored) chunk->voxels = in_cheapest_order(std::move(chunk->voxels));
  return chunk;
}

StoreResult<RunChunk> WorldAt::voxels(const ChunkKey& key, WorldReader& reader,
                                      ReplayScratch& scratch) const {
  auto chunk = replayed(key, reader, scratch);
  if (!chunk) return failure(chunk.error());
  return std::move(chunk->voxels);
}

}  // namespace runstone
