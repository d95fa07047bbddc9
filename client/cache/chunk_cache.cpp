#include "client/cache/chunk_cache.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "client/cache/cache_drops.hpp"
#include "client/cache/cache_row.hpp"
#include "common/os/user_folders.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone {
namespace {

constexpr const char* kSchema =
    "CREATE TABLE IF NOT EXISTS world (id INTEGER PRIMARY KEY, world_id BLOB NOT NULL UNIQUE, "
    "chunk_edge INTEGER NOT NULL, epoch INTEGER NOT NULL, durable INTEGER NOT NULL, "
    "head INTEGER NOT NULL, tile_rules INTEGER NOT NULL);"
    "CREATE TABLE IF NOT EXISTS chunk (world INTEGER NOT NULL, level INTEGER NOT NULL, "
    "x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL, epoch INTEGER NOT NULL, seq INTEGER NOT NULL, "
    "used INTEGER NOT NULL, bytes INTEGER NOT NULL, checksum INTEGER NOT NULL, "
    "digest BLOB NOT NULL, data BLOB NOT NULL, UNIQUE (world, level, x, y, z));"
    "CREATE INDEX IF NOT EXISTS chunk_used ON chunk (used, bytes);"
    "CREATE INDEX IF NOT EXISTS chunk_version ON chunk (world, seq, epoch);";
constexpr std::int64_t kLayout = 2;

}  // namespace

std::string default_cache_folder() { return user_folder(UserFolder::cache); }

struct ChunkCache::Tables {
  explicit Tables(CacheDatabase& d)
      : find_world(d.prepare(
            "SELECT id, chunk_edge, epoch, durable, head, tile_rules FROM world WHERE world_id = ?1")),
        add_world(d.prepare("INSERT INTO world (world_id, chunk_edge, epoch, durable, head, "
                            "tile_rules) VALUES (?1,?2,?3,?4,?5,?6)")),
        mark_world(d.prepare(
            "UPDATE world SET chunk_edge=?2, epoch=?3, durable=?4, head=?5, tile_rules=?6 "
            "WHERE id = ?1")),
        drop_lost(d.prepare("DELETE FROM chunk WHERE world = ?1 AND seq > ?2 AND epoch < ?3")),
        drop_all(d.prepare("DELETE FROM chunk WHERE world = ?1")),
        drop_edited(d.prepare("DELETE FROM chunk WHERE world = ?1 AND seq > 0")),
        drop_tiles(d.prepare("DELETE FROM chunk WHERE world = ?1 AND level > 0")),
        has_level(d.prepare("SELECT 1 FROM chunk WHERE world = ?1 AND level = ?2 LIMIT 1")),
        find(d.prepare("SELECT epoch, seq, used, checksum, digest, data, rowid FROM chunk "
                       "WHERE world = ?1 AND x = ?2 AND y = ?3 AND z = ?4 AND level = ?5")),
        use(d.prepare("UPDATE chunk SET used = ?2 WHERE rowid = ?1")),
        drop(d.prepare("DELETE FROM chunk WHERE rowid = ?1")),
        keep(d.prepare(
            "INSERT OR REPLACE INTO chunk (world, x, y, z, level, epoch, seq, used, bytes, "
            "checksum, digest, data) VALUES (?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12)")),
        size(d.prepare("SELECT bytes FROM chunk WHERE world = ?1 AND x = ?2 AND y = ?3 AND z = ?4 "
                       "AND level = ?5")),
        oldest(d.prepare("SELECT rowid, bytes FROM chunk ORDER BY used LIMIT ?1")) {}
  sql::Statement find_world, add_world, mark_world, drop_lost, drop_all, drop_edited, drop_tiles,
      has_level, find, use, drop, keep, size, oldest;
};

ChunkCache::ChunkCache(std::string file, std::uint64_t bytes_max, FileLock lock)
    : file_(std::move(file)), bytes_max_(bytes_max), lock_(std::move(lock)) {}
ChunkCache::~ChunkCache() = default;

Result<std::unique_ptr<ChunkCache>, std::string> ChunkCache::open(const std::string& folder,
                                                                  std::uint64_t bytes_max) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failure("chunk cache " + folder + " cannot be made: " + error.message());
  auto lock = FileLock::take(folder + "/cache.lock");
  if (!lock && lock.error().is_held) {
    return failure("chunk cache " + folder + " is in use by another client");
  }
  if (!lock) {
    return failure("chunk cache " + folder + " cannot be written: " + lock.error().what);
  }
  std::unique_ptr<ChunkCache> cache(
      new ChunkCache(folder + "/cache.sqlite", bytes_max, *std::move(lock)));
  cache->open_database();
  if (cache->has_ended_) return failure(cache->warning_);
  return cache;
}

void ChunkCache::open_database() {
  for (const bool is_first : {true, false}) {
    database_ = std::make_unique<CacheDatabase>(file_, kSchema, kLayout);
    tables_ = std::make_unique<Tables>(*database_);
    stamp_ = database_->integer("SELECT MAX(used) FROM chunk") + 1;
    bytes_ = static_cast<std::uint64_t>(database_->integer("SELECT TOTAL(bytes) FROM chunk"));
    database_->run("BEGIN");
    evict();
    database_->run("COMMIT");
    database_->run("PRAGMA incremental_vacuum");
    if (database_->ok()) return;
    if (!is_first || !database_->is_corrupt()) break;
    set_aside();
  }
  has_ended_ = true;
  warning_ = "chunk cache " + file_ + " cannot be used: " + database_->error();
}

void ChunkCache::set_aside() {
  warning_ = "chunk cache " + file_ + " is damaged (" + database_->error() + "): set aside as " +
             file_ + ".damaged, and a new one is begun";
  tables_.reset();
  database_.reset();
  std::error_code ignored;
  std::filesystem::rename(file_, file_ + ".damaged", ignored);
  CacheDatabase::remove(file_);
  ++counters_.databases_set_aside;
}

void ChunkCache::handle_failure() {
  if (database_->ok()) return;
  if (database_->is_corrupt()) {
    set_aside();
    return open_database();
  }
  warning_ = "chunk cache " + file_ + " is not used any more: " + database_->error();
  has_ended_ = true;
}

std::string ChunkCache::take_warning() { return std::exchange(warning_, {}); }

std::int64_t ChunkCache::enter(const CachedWorld& world) {
  const auto number = [](Sequence seq) {
    return static_cast<std::int64_t>(std::min(seq, kSequenceMax));
  };
  Tables& t = *tables_;
  std::optional<std::int64_t> id;
  std::int64_t rules = world.tile_rules;
  CachedWorld before;
  t.find_world.bind(1, world.id);
  if (database_->step(t.find_world)) {
    id = t.find_world.integer(0);
    before.chunk_edge = static_cast<std::uint16_t>(t.find_world.integer(1));
    before.mark = {static_cast<Epoch>(t.find_world.integer(2)),
                   static_cast<Sequence>(t.find_world.integer(3)),
                   static_cast<Sequence>(t.find_world.integer(4))};
    before.tile_rules = static_cast<std::uint32_t>(t.find_world.integer(5));
    // 0: this connection has no tiles, so it says nothing about those that are kept.
    if (rules == 0) rules = before.tile_rules;
  }
  t.find_world.reset();
  if (!id) {
    database_->run(t.add_world.bind(1, world.id)
                       .bind(2, std::int64_t{world.chunk_edge})
                       .bind(3, std::int64_t{world.mark.epoch})
                       .bind(4, number(world.mark.durable))
                       .bind(5, number(world.mark.head))
                       .bind(6, rules));
    return database_->ok() ? database_->integer("SELECT last_insert_rowid()") : 0;
  }
  const CacheDrops drops = drops_of(before, world);
  if (before.mark == world.mark && !drops.any()) return *id;
  const auto count = [&](sql::Statement& drop) {
    database_->run(drop);
    const std::int64_t dropped = database_->ok() ? database_->changes() : 0;
    counters_.not_common += static_cast<std::uint64_t>(dropped);
    if (dropped != 0)
      bytes_ = static_cast<std::uint64_t>(database_->integer("SELECT TOTAL(bytes) FROM chunk"));
  };
  if (drops.all) count(t.drop_all.bind(1, *id));
  if (drops.edited) count(t.drop_edited.bind(1, *id));
  if (drops.lost) {
    count(
        t.drop_lost.bind(1, *id).bind(2, number(drops.common)).bind(3, std::int64_t{drops.epoch}));
  }
  if (drops.tiles) count(t.drop_tiles.bind(1, *id));
  database_->run(t.mark_world.bind(1, *id)
                     .bind(2, std::int64_t{world.chunk_edge})
                     .bind(3, std::int64_t{world.mark.epoch})
                     .bind(4, number(world.mark.durable))
                     .bind(5, number(world.mark.head))
                     .bind(6, rules));
  return *id;
}

std::optional<KeyedChunk> ChunkCache::read(const CachedWorld& world, std::int64_t row,
                                           const ChunkKey& key) {
  Tables& t = *tables_;
  t.find.bind(1, row)
      .bind(2, std::int64_t{key.at.x})
      .bind(3, std::int64_t{key.at.y})
      .bind(4, std::int64_t{key.at.z})
      .bind(5, std::int64_t{key.lod});
  if (!database_->step(t.find)) {
    t.find.reset();
    ++counters_.misses;
    return std::nullopt;
  }
  const CacheRow stored{
      {static_cast<Epoch>(t.find.integer(0)), static_cast<Sequence>(t.find.integer(1))},
      static_cast<std::uint64_t>(t.find.integer(3)),
      t.find.blob(4),
      t.find.blob(5)};
  const bool is_old = t.find.integer(2) != stamp_;
  const std::int64_t id = t.find.integer(6);
  const std::uint64_t size = stored.data.size() + CacheDatabase::kRowOverheadBytes;
  ChunkPtr chunk = chunk_of(world, key, stored);
  t.find.reset();
  if (!chunk) {
    ++counters_.corrupt;
    database_->run(t.drop.bind(1, id));
    bytes_ -= std::min(bytes_, size);
    return std::nullopt;
  }
  ++counters_.hits;
  if (is_old) database_->run(t.use.bind(1, id).bind(2, stamp_));
  return KeyedChunk{key, std::move(chunk)};
}

std::vector<KeyedChunk> ChunkCache::find(const CacheLookup& lookup) {
  std::vector<KeyedChunk> found;
  std::size_t found_bytes = 0;
  if (has_ended_) return found;
  database_->run("BEGIN IMMEDIATE");
  const std::int64_t row = enter(lookup.world);
  std::optional<std::uint8_t> level;
  bool has_level = false;
  for (const ChunkKey& key : lookup.keys) {
    if (!database_->ok() || found_bytes >= lookup.bytes_max) break;
    if (level != key.lod) {
      // Most tiles of a view are not in a new cache, and a look-up of each would take long.
      level = key.lod;
      has_level = database_->step(tables_->has_level.bind(1, row).bind(2, std::int64_t{key.lod}));
      tables_->has_level.reset();
    }
    if (!has_level) {
      ++counters_.misses;
      continue;
    }
    auto chunk = read(lookup.world, row, key);
    if (!chunk) continue;
    found_bytes += sizeof(Chunk) + chunk->second->voxels.runs.byte_capacity();
    found.push_back(*std::move(chunk));
  }
  database_->run("COMMIT");
  handle_failure();
  return found;
}

void ChunkCache::keep(const CachedWorld& world, std::span<const KeyedChunk> chunks) {
  if (has_ended_) return;
  Tables& t = *tables_;
  database_->run("BEGIN IMMEDIATE");
  const std::int64_t row = enter(world);
  for (const auto& [key, chunk] : chunks) {
    if (chunk->version.seq > kSequenceMax || !database_->ok()) continue;
    const auto at = [&](sql::Statement& s) -> sql::Statement& {
      return s.bind(1, row)
          .bind(2, std::int64_t{key.at.x})
          .bind(3, std::int64_t{key.at.y})
          .bind(4, std::int64_t{key.at.z})
          .bind(5, std::int64_t{key.lod});
    };
    if (database_->step(at(t.size)))
      bytes_ -= std::min(bytes_, static_cast<std::uint64_t>(t.size.integer(0)));
    t.size.reset();
    const Bytes data = encode_chunk(chunk->voxels, ChunkEncoding::packed);
    const Bytes digest = digest_bytes(chunk->digest);
    const std::uint64_t size = data.size() + CacheDatabase::kRowOverheadBytes;
    database_->run(at(t.keep)
                       .bind(6, std::int64_t{chunk->version.epoch})
                       .bind(7, static_cast<std::int64_t>(chunk->version.seq))
                       .bind(8, stamp_)
                       .bind(9, static_cast<std::int64_t>(size))
                       .bind(10, static_cast<std::int64_t>(
                                     checksum_of(world.id, key, {chunk->version, 0, digest, data})))
                       .bind(11, ByteView(digest))
                       .bind(12, ByteView(data)));
    bytes_ += size;
    ++counters_.kept;
  }
  ++stamp_;  // chunks of later batches count as newer
  evict();
  database_->run("COMMIT");
  handle_failure();
}

void ChunkCache::evict() {
  counters_.evicted += database_->evict(tables_->oldest, tables_->drop, bytes_, bytes_max_);
}

}  // namespace runstone
