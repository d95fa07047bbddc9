#include "client/web/web_cache.hpp"

#include <sstream>
#include <utility>

#include "client/cache/cache_drops.hpp"
#include "client/cache/cache_row.hpp"
#include "client/web/page.hpp"
#include "common/core/hex.hpp"

namespace runstone {
namespace {

/// The page keeps sequences as numbers of JavaScript, which are exact up to here.
constexpr Sequence kSequenceMaxInPage = Sequence{1} << 53;

/// Returns the line of read_cached_worlds() without the world.
std::string text_of(const CachedWorld& world) {
  return std::to_string(world.chunk_edge) + ' ' + std::to_string(world.mark.epoch) + ' ' +
         std::to_string(world.mark.durable) + ' ' + std::to_string(world.mark.head) + ' ' +
         std::to_string(world.tile_rules);
}

}  // namespace

WebCache::WebCache(const std::vector<CachedWorld>& worlds) {
  for (const CachedWorld& world : worlds) worlds_[world.id] = world;
}

void WebCache::enter(const CachedWorld& world) {
  const auto known = worlds_.find(world.id);
  CachedWorld next = world;
  if (known != worlds_.end()) {
    const CacheDrops drops = drops_of(known->second, world);
    if (next.tile_rules == 0) next.tile_rules = known->second.tile_rules;
    if (drops.any()) {
      // Chunks that wait to be written may be among the dropped ones.
      if (batch_world_ == world.id) discard_batch();
      page_cache_drop_rows(to_hex(world.id).c_str(), drops.all ? 1 : 0, drops.edited ? 1 : 0,
                           drops.lost ? 1 : 0, drops.tiles ? 1 : 0,
                           static_cast<double>(drops.common), drops.epoch);
    } else if (known->second.mark == next.mark && known->second.tile_rules == next.tile_rules) {
      return;
    }
  }
  worlds_[world.id] = next;
  page_cache_enter(to_hex(world.id).c_str(), text_of(next).c_str());
}

void WebCache::look_up(CacheLookup lookup) {
  if (has_ended_) return results_.emplace_back(), void();
  enter(lookup.world);
  std::vector<std::int32_t> keys;
  for (const ChunkKey& key : lookup.keys)
    keys.insert(keys.end(), {std::int32_t{key.lod}, key.at.x, key.at.y, key.at.z});
  const std::string world = to_hex(lookup.world.id);
  lookups_.push_back({std::move(lookup), {}, 0});
  page_cache_find(world.c_str(), keys.data(), static_cast<int>(keys.size() / 4));
}

bool WebCache::found(std::size_t index, ByteView record) {
  if (lookups_.empty()) return false;  // the cache has ended
  OpenLookup& open = lookups_.front();
  if (open.bytes >= open.lookup.bytes_max) return false;
  const ChunkKey& key = open.lookup.keys[index];
  ChunkPtr chunk = chunk_of_record(open.lookup.world, key, record);
  if (!chunk) {
    ++counters_.corrupt;
    page_cache_drop_row(to_hex(open.lookup.world.id).c_str(), key.lod, key.at.x, key.at.y,
                        key.at.z);
    return true;
  }
  open.bytes += sizeof(Chunk) + chunk->voxels.runs.byte_capacity();
  open.found.emplace_back(key, std::move(chunk));
  return true;
}

void WebCache::looked_up() {
  if (lookups_.empty()) return;  // the cache has ended
  OpenLookup done = std::move(lookups_.front());
  lookups_.pop_front();
  counters_.hits += done.found.size();
  counters_.misses += done.lookup.keys.size() - done.found.size();
  results_.push_back(std::move(done.found));
}

std::vector<std::vector<KeyedChunk>> WebCache::drain_results() {
  return std::exchange(results_, {});
}

std::size_t WebCache::room() const {
  return has_ended_ || batches_waiting_ >= kBatchesMax ? 0 : kBatchChunksMax - batch_chunks_;
}

void WebCache::keep(const CachedWorld& world, const std::vector<KeyedChunk>& chunks) {
  if (has_ended_ || chunks.empty()) return;
  if (batch_chunks_ != 0 && batch_world_ != world.id) flush();
  enter(world);
  batch_world_ = world.id;
  ByteWriter out(batch_);
  for (const auto& [key, chunk] : chunks) {
    if (chunk->version.seq > kSequenceMaxInPage) continue;
    const Bytes record = record_of(world.id, key, *chunk);
    out.u32(static_cast<std::uint32_t>(record.size()));
    out.u32(key.lod);
    for (const std::int32_t c : {key.at.x, key.at.y, key.at.z})
      out.u32(static_cast<std::uint32_t>(c));
    out.u32(chunk->version.epoch);
    out.f64(static_cast<double>(chunk->version.seq));
    out.bytes(record);
    ++batch_chunks_;
  }
  if (batch_chunks_ >= kBatchChunksMax) flush();
}

void WebCache::flush() {
  if (batch_chunks_ == 0) return;
  ++batches_waiting_;
  page_cache_keep(to_hex(batch_world_).c_str(), batch_.data(), static_cast<int>(batch_.size()));
  discard_batch();
}

void WebCache::discard_batch() {
  batch_.clear();
  batch_chunks_ = 0;
}

void WebCache::kept(std::size_t rows, std::size_t evicted) {
  if (batches_waiting_ != 0) --batches_waiting_;
  counters_.kept += rows;
  counters_.evicted += evicted;
}

void WebCache::fail() {
  has_ended_ = true;
  while (!lookups_.empty()) looked_up();
}

std::vector<CachedWorld> read_cached_worlds(const std::string& text) {
  std::vector<CachedWorld> out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string id;
    CachedWorld world;
    if (in >> id >> world.chunk_edge >> world.mark.epoch >> world.mark.durable >> world.mark.head >>
            world.tile_rules &&
        read_hex(id, world.id))
      out.push_back(world);
  }
  return out;
}

}  // namespace runstone
