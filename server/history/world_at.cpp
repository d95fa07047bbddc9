#include "server/history/world_at.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/key_text.hpp"
#include "common/edits/edit_geometry.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

namespace {

constexpr std::size_t kSliceEdits = 64;  // applied in one sweep; more gain little
constexpr Sequence kProgressEdits = 1024;

}  // namespace

Unexpected<StoreError> WorldAt::refuse(std::string what) const {
  return {{StoreError::Kind::bad_request, reader_->file(), "edit_log", std::move(what)}};
}

StoreResult<WorldAt> WorldAt::open(Store& reader, const Generator& generator, Sequence at,
                                   const Progress& progress) {
  WorldAt world(reader, generator);
  const auto head = reader.log_head();
  if (!head) return Unexpected<StoreError>{head.error()};
  world.at_ = head->version.seq;
  if (at < world.at_) {
    return world.refuse("begins at seq=" + std::to_string(world.at_ + 1) +
                        ": the world at seq=" + std::to_string(at) +
                        " was compacted away; the earliest left is that at seq=" + std::to_string(world.at_));
  }
  if (world.at_ > 0) {
    if (const auto read = world.read_completed(world.at_); !read) return Unexpected<StoreError>{read.error()};
  }
  if (const auto advanced = world.advance(at, progress); !advanced)
    return Unexpected<StoreError>{advanced.error()};
  return world;
}

StoreResult<void> WorldAt::read_completed(Sequence head) {
  const auto keys = reader_->base_keys();
  if (!keys) return Unexpected<StoreError>{keys.error()};
  for (const auto& [key, version] : *keys) {
    if (version.seq > head) return refuse("was compacted while it was read; open the moment again");
    if (version != Version{}) chunks_[key].start = version;
  }
  return {};
}

StoreResult<void> WorldAt::advance(Sequence at, const Progress& progress) {
  if (at < at_) {
    return refuse("cannot be followed back from seq=" + std::to_string(at_) +
                  " to seq=" + std::to_string(at));
  }
  const auto last = reader_->last_sequence();
  if (!last) return Unexpected<StoreError>{last.error()};
  if (at > *last) {
    return refuse("ends at seq=" + std::to_string(*last) + ", before seq=" + std::to_string(at));
  }
  const Sequence first = at_ + 1;
  const std::size_t known = edits_.size();
  bool is_cancelled = false;
  const auto read = reader_->read_log(first, at, [&](const EditRecord& record) {
    edits_.push_back(record.edit);
    versions_.push_back(record.version);
    if (progress && record.version.seq % kProgressEdits == 0)
      is_cancelled = !progress(record.version.seq, at);
    return !is_cancelled;
  });
  StoreResult<void> outcome;
  if (!read) {
    outcome = Unexpected<StoreError>{read.error()};
  } else if (is_cancelled) {
    outcome = Unexpected<StoreError>{
        {StoreError::Kind::cancelled, reader_->file(), "edit_log", "was not read to the end"}};
  } else if (edits_.size() - known != at - at_) {
    outcome = refuse("was compacted while it was read; open the moment again");
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
  at_ = at;
  return {};
}

Version WorldAt::version(const ChunkKey& key) const {
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return {};
  const Edited& edited = found->second;
  return edited.edits.empty() ? edited.start : versions_[edited.edits.back()];
}

std::vector<ChunkKey> WorldAt::edited() const {
  std::vector<ChunkKey> keys;
  keys.reserve(chunks_.size());
  for (const auto& [key, edited] : chunks_) keys.push_back(key);
  return keys;
}

StoreResult<Chunk> WorldAt::chunk(const ChunkKey& key) {
  auto chunk = base_chunk(*reader_, *generator_, key);
  if (!chunk) return chunk;
  const auto found = chunks_.find(key);
  if (chunk->version != (found == chunks_.end() ? Version{} : found->second.start)) {
    return refuse("was compacted while it was read; open the moment again");
  }
  if (found == chunks_.end() || found->second.edits.empty()) return chunk;
  const std::vector<std::uint32_t>& edits = found->second.edits;
  const VoxelPos origin = origin_of(key.at, edge_);
  for (std::size_t first = 0; first < edits.size(); first += kSliceEdits) {
    slice_.clear();
    for (std::size_t i = first; i < std::min(edits.size(), first + kSliceEdits); ++i) {
      slice_.push_back(edits_[edits[i]]);
    }
    apply_stack(chunk->voxels, chunk->digest, origin, slice_, scratch_, result_);
  }
  chunk->version = versions_[edits.back()];
  chunk->voxels = in_cheapest_order(std::move(chunk->voxels));
  return chunk;
}

}  // namespace runstone
