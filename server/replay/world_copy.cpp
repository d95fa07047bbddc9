#include "server/replay/world_copy.hpp"

#include <sodium.h>

#include <filesystem>
#include <memory>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "server/store/world_folder.hpp"

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
  return copy;
}

}  // namespace

Result<WorldCopy, std::string> copy_world(WorldReader& source, const Generator& generator,
                                          Sequence at, const std::string& folder,
                                          const WorldAt::Progress& progress) {
  namespace fs = std::filesystem;
  if (sodium_init() < 0) return failure("libsodium cannot start");
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    return failure(folder + ": exists and is not empty");
  auto world = WorldAt::open(source, generator, at);
  if (!world) return failure(world.error().message());
  auto whole = fs::absolute(folder, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // of "valley/"
  const std::string unfinished = whole.string() + ".unfinished";
  fs::remove_all(unfinished, error);  // left by an interrupted copy
  auto copy = fill(source, *world, unfinished, progress);
  if (!copy) {
    fs::remove_all(unfinished, error);
    return copy;
  }
  fs::remove(whole, error);  // it is an empty folder or does not exist
  fs::rename(unfinished, whole, error);
  if (error) return failure(folder + ": " + error.message());
  return copy;
}

}  // namespace runstone
