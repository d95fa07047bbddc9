#include "server/map/map_moment.hpp"

#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/history/moments.hpp"
#include "server/store/store.hpp"

namespace runstone {

StoreResult<std::unique_ptr<MapMoment>> MapMoment::open(const std::string& place,
                                                        const Generator& generator, Sequence at,
                                                        const WorldAt::Progress& progress) {
  auto reader = open_world(place, StoreAccess::read_only);
  if (!reader) return failure(reader.error());
  std::unique_ptr<MapMoment> out(new MapMoment(*std::move(reader)));
  bool is_too_far = false;
  const auto bounded = [&](Sequence read, Sequence last) {
    is_too_far = is_too_far || last - read > Moments::kEditsMax;
    return !is_too_far && (!progress || progress(read, last));
  };
  auto world = WorldAt::open(*out->reader_, generator, at, bounded);
  if (is_too_far) {
    return failure(StoreError{
        StoreError::Kind::bad_request, out->reader_->file(), "keyframe",
        "none is near enough to seq=" + std::to_string(at) + " yet: the moment cannot be shown"});
  }
  if (!world) return failure(world.error());
  out->world_ = std::make_unique<WorldAt>(*std::move(world));
  const auto base = out->reader_->base_chunks();
  if (!base) return failure(base.error());
  for (const StoredChunk& chunk : *base) {
    if (chunk.key.lod == 0) out->ground_.add(chunk.key.at, out->world_->version(chunk.key));
  }
  for (const ChunkKey& key : out->world_->edited())
    out->ground_.add(key.at, out->world_->version(key));
  return out;
}

StoreResult<void> MapMoment::advance(Sequence at, const EachRecord& each,
                                     const WorldAt::Progress& progress) {
  const auto end = reader_->edit_at(world_->at());
  if (!end) return failure(end.error());
  // The log has no record of edit 0.
  const bool is_same = world_->at() == 0 || (*end && (*end)->version == world_->end().version);
  if (!is_same) {
    return failure(StoreError{StoreError::Kind::bad_request, reader_->file(), "edit_log",
                              "is another one than before"});
  }
  std::vector<ChunkCoord> chunks;
  return world_->advance(at, progress, [&](const EditRecord& record) {
    touched_chunks(record.edit, meta().chunk_edge, chunks);
    for (const ChunkCoord& chunk : chunks) ground_.add(chunk, record.version);
    each(record);
  });
}

}  // namespace runstone
