#include "server/tiles/tile_source.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "common/core/assert.hpp"
#include "common/core/tile_keys.hpp"
#include "common/runs/reorder.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/veil.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

class TileSource::Making {
 public:
  Making(TileSource& source, const TileRequest& request, const TileVisibility& visibility,
         const PastChunk& past_chunk)
      : source_(source),
        request_(request),
        visibility_(visibility),
        past_chunk_(past_chunk),
        fresh_(request.fresh.begin(), request.fresh.end()) {}

  StoreResult<MadeTile> tile(const ChunkKey& key) {
    // It is read first: a tile that is read or made later contains at least these edits.
    const Sequence newest = source_.ledger_.newest_edit(key);
    if (is_later(newest)) return past_tile(key);
    auto cached = source_.cache_.find(key);
    if (cached && cached->rules == visibility_.rules && newest <= cached->through) {
      cached->is_known = true;
      // The ledger knows all edits up to the head, and none of them is newer.
      cached->through = std::max(cached->through, request_.head);
      // An edit may have come since the ledger was asked.
      if (is_later(cached->tile->version.seq)) return past_tile(key);
      return *std::move(cached);
    }
    auto found = coarse(key);
    if (!found) {
      auto stored = load(key, newest);
      if (!stored) return failure(stored.error());
      found = *std::move(stored);
    }
    if (!found) {
      auto built = build(key);
      if (!built) return built;
      if (key != request_.key && built->is_worth_storing()) on_the_way_.push_back(*built);
      found = *std::move(built);
    }
    source_.cache_.put(*found);
    if (is_later(found->tile->version.seq)) return past_tile(key);
    return *std::move(found);
  }

  /// Returns true if tile() failed because it reached request.steps_max.
  bool has_stopped() const { return has_stopped_; }
  /// Returns the tiles that tile() made below the requested one and that are worth storing.
  std::vector<MadeTile> take_on_the_way() { return std::move(on_the_way_); }

 private:
  /// A chunk or a tile. A null chunk is damaged, and shown as empty.
  struct Child {
    ChunkPtr chunk;
    bool is_approximate = false;
    bool is_damaged = false;
  };

  std::optional<MadeTile> coarse(const ChunkKey& key) {
    if (key.lod < kCoarseLevelMin || source_.ledger_.is_stored_or_edited(key)) return std::nullopt;
    auto voxels =
        source_.generator_.coarse(tile_origin(key, source_.edge_), source_.edge_, key.lod);
    if (!voxels) return std::nullopt;
    ++steps_;
    return tile_of_voxels(key, reorder(*voxels, kTileOrder), {}, true, false);
  }

  /// Returns the stored tile, or nullopt if there is none, if it is damaged, or if it lacks edit
  /// `newest`.
  StoreResult<std::optional<MadeTile>> load(const ChunkKey& key, Sequence newest) {
    std::optional<MadeTile> out;
    if (!source_.options_.reads_stored_tiles) return out;
    ++steps_;
    StoreResult<std::optional<Chunk>> row = std::optional<Chunk>();
    const auto read = source_.chunks_.with_reader(
        [&](WorldReader& reader) { row = reader.load_tile(key, visibility_.rules); });
    if (!read) return failure(read.error());
    if (!row) {
      if (row.error().kind != StoreError::Kind::corrupt) return failure(row.error());
      source_.warn_once(key, row.error().message() + "; the tile is made again");
      return out;
    }
    if (!row->has_value() || newest > (*row)->version.seq) return out;
    out = MadeTile{key, std::make_shared<const Chunk>(**std::move(row)), 0, false, true};
    out->rules = visibility_.rules;
    out->voxel_digest = out->tile->digest;
    out->through = std::max(out->tile->version.seq, request_.head);
    return out;
  }

  StoreResult<MadeTile> build(const ChunkKey& key) {
    std::array<Child, 8> children;
    TileChildren runs{};
    Version version;
    bool is_approximate = false, is_damaged = false;
    for (unsigned i = 0; i < 8; ++i) {
      if (steps_ >= request_.steps_max) {
        has_stopped_ = true;
        return failure(StoreError{StoreError::Kind::cancelled, {}, {}, "stopped"});
      }
      auto child = child_of(tile_child(key, i));
      if (!child) return failure(child.error());
      children[i] = *std::move(child);
      is_approximate = is_approximate || children[i].is_approximate;
      is_damaged = is_damaged || children[i].is_damaged;
      if (children[i].chunk == nullptr) continue;
      runs[i] = &children[i].chunk->voxels;
      version = std::max(version, children[i].chunk->version);
    }
    return tile_of_voxels(key,
                          build_tile(runs, static_cast<unsigned>(source_.edge_), kTileOrder,
                                     visibility_.cells, scratch_),
                          version, is_approximate, is_damaged);
  }

  StoreResult<Child> child_of(const ChunkKey& key) {
    if (key.lod == 0) return chunk_at(key);
    auto made = tile(key);
    if (!made) return failure(made.error());
    return Child{made->tile, made->is_approximate, made->is_damaged};
  }

  /// Returns true if an edit came after the moment that the request wants.
  bool is_later(Sequence seq) const { return request_.at && seq > *request_.at; }

  /// Makes a tile below which edits are later than the moment, unless an earlier turn made it.
  StoreResult<MadeTile> past_tile(const ChunkKey& key) {
    std::map<ChunkKey, MadeTile>& known = *request_.past_made;
    if (const auto found = known.find(key);
        found != known.end() && found->second.rules == visibility_.rules)
      return found->second;
    auto built = build(key);
    if (!built) return built;
    built->is_past = true;
    if (built->tile->digest != Digest{}) {
      Chunk unclaimed = *built->tile;
      unclaimed.digest = {};
      built->tile = std::make_shared<const Chunk>(std::move(unclaimed));
    }
    if (key == request_.key) return built;
    for (unsigned i = 0; key.lod > 1 && i < kTileChildren; ++i) known.erase(tile_child(key, i));
    known.insert_or_assign(key, *built);
    on_the_way_.push_back(*built);
    return built;
  }

  StoreResult<Child> chunk_at(const ChunkKey& key) {
    if (!request_.at) return present_chunk_at(key);
    const Sequence newest = source_.ledger_.newest_edit(key);
    if (is_later(newest)) return past_chunk_at(key);
    auto found = present_chunk_at(key);
    // An edit may have come since the ledger was asked. Or edits are neither in a snapshot nor in
    // `fresh`, because the chunk is not in memory; then the log has them.
    const Sequence shown = found && found->chunk ? found->chunk->version.seq : newest;
    if (is_later(shown) || shown < newest) return past_chunk_at(key);
    return found;
  }

  StoreResult<Child> past_chunk_at(const ChunkKey& key) {
    ++steps_;
    auto chunk = past_chunk_(key);
    if (chunk) return Child{std::make_shared<const Chunk>(*std::move(chunk)), false, false};
    return damaged_chunk(key, chunk.error());
  }

  StoreResult<Child> present_chunk_at(const ChunkKey& key) {
    if (const auto fresh = fresh_.find(key.at); fresh != fresh_.end())
      return Child{fresh->second, fresh->second == nullptr, fresh->second == nullptr};
    ++steps_;
    if (!source_.ledger_.is_stored_or_edited(key)) {
      return Child{std::make_shared<const Chunk>(generated_chunk(
                       source_.generator_, key, static_cast<std::uint16_t>(source_.edge_))),
                   false, false};
    }
    auto loaded = source_.chunks_.load(key);
    if (loaded) return Child{std::make_shared<const Chunk>(*std::move(loaded)), false, false};
    return damaged_chunk(key, loaded.error());
  }

  StoreResult<Child> damaged_chunk(const ChunkKey& key, const StoreError& error) {
    if (error.kind != StoreError::Kind::corrupt) return failure(error);
    source_.warn_once(key, error.message());
    return Child{nullptr, true, true};
  }

  MadeTile tile_of_voxels(const ChunkKey& key, RunChunk voxels, Version version,
                          bool is_approximate, bool is_damaged) const {
    Chunk tile{std::move(voxels), version, {}};
    const Digest digest = digest_of(tile.voxels);
    const bool is_complete = !is_damaged && version.seq <= request_.head;
    if (is_complete) tile.digest = digest;
    MadeTile made{key, std::make_shared<const Chunk>(std::move(tile)), request_.head,
                  is_approximate};
    made.is_damaged = is_damaged;
    made.rules = visibility_.rules;
    made.voxel_digest = digest;
    return made;
  }

  TileSource& source_;
  const TileRequest& request_;
  const TileVisibility& visibility_;
  const PastChunk& past_chunk_;
  const std::map<ChunkCoord, ChunkPtr> fresh_;
  TileScratch scratch_;
  std::vector<MadeTile> on_the_way_;
  std::size_t steps_ = 0;  // chunks and tiles that were read or generated
  bool has_stopped_ = false;
};

TileSource::TileSource(ChunkSource& chunks, const Generator& generator, std::int32_t edge,
                       TileLedger& ledger, Warn warn, Options options)
    : chunks_(chunks),
      generator_(generator),
      edge_(edge),
      ledger_(ledger),
      warn_(std::move(warn)),
      options_(options),
      cache_(options.cache_bytes) {}

StoreResult<std::vector<MadeTile>> TileSource::make(const TileRequest& request,
                                                    const TileVisibility& visibility,
                                                    const PastChunk& past_chunk) {
  RUNSTONE_ASSERT(!request.at || (past_chunk && request.past_made));
  RUNSTONE_ASSERT(request.key.lod >= 1 && request.key.lod <= kTileLevelMax);
  if (auto found = find_ground(); !found) return failure(found.error());
  Making making(*this, request, visibility, past_chunk);
  auto tile = making.tile(request.key);
  if (making.has_stopped()) return making.take_on_the_way();
  if (!tile) return failure(tile.error());
  add_veiled(*tile, visibility);
  std::vector<MadeTile> tiles = making.take_on_the_way();
  tiles.push_back(*std::move(tile));
  return tiles;
}

void TileSource::add_veiled(MadeTile& made, const TileVisibility& visibility) {
  if (made.veiled || !options_.adds_veils) return;
  const Chunk& tile = *made.tile;
  VeilScratch scratch;
  if (auto voxels = veiled(tile.voxels, visibility.veil, scratch)) {
    Chunk out{*std::move(voxels), tile.version, {}};
    if (tile.digest != Digest{}) out.digest = digest_of(out.voxels);
    made.veiled = std::make_shared<const Chunk>(std::move(out));
  } else {
    made.veiled = made.tile;
  }
  if (!made.is_past) cache_.put(made);
}

bool TileSource::is_current(const ChunkKey& key, const Version& version, std::uint64_t claim_digest,
                            std::uint32_t rules) {
  if (claim_digest == 0) return false;  // of an incomplete tile
  const Sequence newest = ledger_.newest_edit(key);
  if (const auto made = cache_.find(key); made && made->rules == rules && newest <= made->through) {
    return made->is_complete() && made->tile->version == version &&
           (!made->veiled || made->veiled->digest.lane[0] == claim_digest);
  }
  return has_found_ground_.load() && newest == version.seq && (newest != 0 || version == Version{});
}

StoreResult<void> TileSource::find_ground() {
  if (has_found_ground_.load()) return {};
  StoreResult<void> found;
  const auto read = chunks_.with_reader([&](WorldReader& reader) {
    const auto snapshots = reader.snapshot_keys();
    const auto base = reader.base_chunks();
    if (!snapshots || !base) {
      found = failure(snapshots ? base.error() : snapshots.error());
      return;
    }
    ledger_.stored(*snapshots);
    std::vector<std::pair<ChunkKey, Version>> chunks;
    chunks.reserve(base->size());
    for (const StoredChunk& chunk : *base) chunks.emplace_back(chunk.key, chunk.version);
    ledger_.stored(chunks);
  });
  if (!read) return read;
  // Two threads may get here. The ledger is the same then.
  if (found) has_found_ground_.store(true);
  return found;
}

void TileSource::warn_once(const ChunkKey& key, const std::string& line) {
  {
    const std::lock_guard lock(mutex_);
    if (!warned_.insert(key).second) return;
  }
  warn_(line);
}

}  // namespace runstone
