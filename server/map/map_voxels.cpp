#include "server/map/map_voxels.hpp"

#include <array>
#include <optional>
#include <utility>

namespace runstone {
namespace {

MapVoxels::Voxels shared(RunChunk voxels) {
  return std::make_shared<const RunChunk>(std::move(voxels));
}

std::size_t bytes_of(const RunChunk& voxels) {
  constexpr std::size_t kBytesPerRun = sizeof(std::uint32_t) + sizeof(Material);
  return voxels.runs.size() * kBytesPerRun;
}

}  // namespace

StoreResult<MapVoxels::Voxels> MapVoxels::at(const MapMoment& moment, const ChunkKey& key) {
  if (!should_continue_()) {
    return failure(
        StoreError{StoreError::Kind::cancelled, reader_.file(), "", "the map was stopped"});
  }
  if (key.lod == 0) return chunk(moment, key);
  const std::optional<Version> version = moment.ground().version(key);
  const std::pair<ChunkKey, Version> kept_as{key, version.value_or(Version{})};
  if (Voxels kept = caches_.tiles.find(kept_as)) return kept;
  Voxels made;
  const std::int32_t edge = moment.meta().chunk_edge;
  if (!version) {
    auto coarse = generator_.coarse(tile_origin(key, edge), edge, key.lod);
    if (coarse) made = shared(*std::move(coarse));
  } else {
    auto read = stored(key, *version);
    if (!read) return read;
    made = *std::move(read);
  }
  if (made == nullptr) {
    auto built = build(moment, key);
    if (!built) return built;
    made = *std::move(built);
  }
  caches_.tiles.put(kept_as, made, bytes_of(*made));
  return made;
}

StoreResult<MapVoxels::Voxels> MapVoxels::chunk(const MapMoment& moment, const ChunkKey& key) {
  const std::uint16_t edge = moment.meta().chunk_edge;
  if (!moment.ground().version(key))
    return shared(generator_.generate(origin_of(key.at, edge), Extent::cube(edge)));
  if (auto begun = reads_.next(); !begun) return failure(begun.error());
  auto voxels = moment.voxels(key, reader_, replay_);
  if (voxels) return shared(*std::move(voxels));
  if (voxels.error().kind != StoreError::Kind::corrupt) return failure(voxels.error());
  return shared(uniform_chunk(Extent::cube(edge), kEmpty));
}

StoreResult<MapVoxels::Voxels> MapVoxels::stored(const ChunkKey& key, const Version& version) {
  if (auto begun = reads_.next(); !begun) return failure(begun.error());
  auto row = reader_.load_tile(key, tile_rules_);
  if (!row) {
    // A damaged tile is made of its chunks again.
    if (row.error().kind == StoreError::Kind::corrupt) return Voxels();
    return failure(row.error());
  }
  if (!row->has_value() || (*row)->version != version) return Voxels();
  return shared(std::move((*row)->voxels));
}

StoreResult<MapVoxels::Voxels> MapVoxels::build(const MapMoment& moment, const ChunkKey& key) {
  std::array<Voxels, kTileChildren> children;
  TileChildren runs{};
  for (unsigned i = 0; i < kTileChildren; ++i) {
    auto child = at(moment, tile_child(key, i));
    if (!child) return child;
    children[i] = *std::move(child);
    runs[i] = children[i].get();
  }
  return shared(build_tile(runs, moment.meta().chunk_edge, kTileOrder, visibility_, build_));
}

}  // namespace runstone
