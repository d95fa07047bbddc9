#include "server/replay/world_copy.hpp"

#include <sodium.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "common/os/new_folder.hpp"
#include "server/store/world_folder.hpp"
#include "server/textures/stored_textures.hpp"

namespace runstone {
namespace {

constexpr std::size_t kSliceChunks = 256;

Result<WorldCopy, std::string> fill(WorldReader& source, WorldAt& world, const std::string& folder,
                                    const WorldAt::Progress& progress) {
  WorldMeta meta = source.meta();
  auto materials = source.materials();
  if (!materials) return failure(materials.error().message());
  meta.materials = *std::move(materials);
  draw_identity(meta);
  auto store = create_world(folder, meta);
  if (!store) return failure(store.error().message());
  const auto base = source.base_chunks();
  if (!base) return failure(base.error().message());
  std::set<ChunkKey> keys;
  for (const StoredChunk& chunk : *base) keys.insert(chunk.key);
  for (const ChunkKey& key : world.edited()) keys.insert(key);
  WorldCopy copy;
  std::vector<std::pair<ChunkKey, ChunkPtr>> slice;
  for (const ChunkKey& key : keys) {
    auto chunk = world.chunk(key);
    if (!chunk) return failure(chunk.error().message());
    chunk->version = {};
    copy.world_digest = copy.world_digest + world_digest_term(key, chunk->digest);
    slice.emplace_back(key, std::make_shared<const Chunk>(*std::move(chunk)));
    ++copy.chunks;
    if (progress && !progress(copy.chunks, keys.size()))
      return failure(folder + ": was not finished");
    if (slice.size() < kSliceChunks && copy.chunks < keys.size()) continue;
    if (const auto saved = (*store)->save_base(slice); !saved)
      return failure(saved.error().message());
    slice.clear();
  }
  const auto textures = read_stored_textures(source);
  if (!textures) return failure(textures.error());
  const auto range = source.log_range();
  if (!range) return failure(range.error().message());
  const auto given = append_textures(**store, textures->given, range->last.time_us);
  if (!given) return failure(given.error().message());
  return copy;
}

}  // namespace

Result<WorldCopy, std::string> copy_world(WorldReader& source, const Generator& generator,
                                          Sequence at, const std::string& folder, std::ostream& out,
                                          const WorldAt::Progress& progress) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  if (const auto free = NewFolder::check(folder); !free) return failure(free.error());
  auto world = WorldAt::open(source, generator, at);
  if (!world) return failure(world.error().message());
  auto made = NewFolder::make(folder, out);
  if (!made) return failure(made.error());
  auto copy = fill(source, *world, made->path(), progress);
  if (!copy) return copy;
  if (const auto finished = made->finish("world.sqlite"); !finished)
    return failure(finished.error());
  return copy;
}

}  // namespace runstone
