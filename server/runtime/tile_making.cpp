#include "server/runtime/tile_making.hpp"

#include <algorithm>
#include <asio/post.hpp>

#include "server/runtime/logging.hpp"
#include "server/tiles/material_visibility.hpp"

namespace runstone {

TileMaking::TileMaking(WorldStrand& strand, ChunkSource& chunks, const Generator& generator,
                       std::int32_t edge, PastChunks past_chunks)
    : strand_(strand),
      source_(chunks, generator, edge, ledger_,
              [](const std::string& text) { logger("store").warn("{}", text); }),
      past_chunks_(std::move(past_chunks)) {}

void TileMaking::edited(std::span<const ChunkKey> chunks, Sequence seq) {
  if (waiting_edits_.empty() && ledger_.try_edited(chunks, seq)) return;
  waiting_edits_.emplace_back(std::vector<ChunkKey>(chunks.begin(), chunks.end()), seq);
  std::size_t passed = 0;
  while (passed < waiting_edits_.size() &&
         ledger_.try_edited(waiting_edits_[passed].first, waiting_edits_[passed].second)) {
    ++passed;
  }
  waiting_edits_.erase(waiting_edits_.begin(),
                       waiting_edits_.begin() + static_cast<std::ptrdiff_t>(passed));
}

void TileMaking::flush_edits() {
  for (const auto& [chunks, seq] : waiting_edits_)
    ledger_.edited(std::span<const ChunkKey>(chunks), seq);
  waiting_edits_.clear();
}

Sequence TileMaking::newest_edit(const ChunkKey& tile) {
  flush_edits();
  return ledger_.newest_edit(tile);
}

bool TileMaking::is_current(const CachedChunk& copy, std::uint32_t rules) {
  flush_edits();
  return source_.is_current(copy.key, copy.version, copy.digest, rules);
}

void TileMaking::make(TileRequest request, const MaterialTable& materials, Sequence materials_seq,
                      Then then) {
  if (!visibility_ || materials_seq_ != materials_seq) {
    visibility_ = std::make_shared<const TileVisibility>(tile_visibility_of(materials));
    materials_seq_ = materials_seq;
  }
  flush_edits();
  asio::thread_pool& threads = request.at ? *past_thread_ : *threads_;
  asio::post(threads, [this, request = std::move(request), visibility = visibility_,
                       then = std::move(then)] {
    const auto past_chunk = [this, &request](const ChunkKey& key) {
      return past_chunks_(*request.at, key);
    };
    auto made = source_.make(request, *visibility, past_chunk);
    if (!made && made.error().kind == StoreError::Kind::cancelled) return;  // the server stops
    if (!made) logger("store").error("{}", made.error().message());
    const bool has_tile = made && !made->empty() && made->back().key == request.key;
    const End end = has_tile ? End::made : made ? End::stopped : End::failed;
    strand_.post(
        [key = request.key, then, end, made = made ? *std::move(made) : std::vector<MadeTile>{}] {
          then(key, made, end);
        });
  });
}

void TileMaking::save(Tiles tiles, std::uint32_t rules, LogWriter& writer) {
  if (std::exchange(unsaved_rules_, rules) != rules) unsaved_.clear();
  const std::size_t room = kUnsavedMax - std::min(kUnsavedMax, unsaved_.size());
  tiles.resize(std::min(tiles.size(), room));
  std::move(tiles.begin(), tiles.end(), std::back_inserter(unsaved_));
  if (!is_saving_) save_next(writer);
}

void TileMaking::save_next(LogWriter& writer) {
  flush_edits();
  std::erase_if(unsaved_, [this](const auto& tile) {
    return ledger_.newest_edit(tile.first) > tile.second->version.seq;
  });
  if (unsaved_.empty()) return;
  const std::size_t count = std::min(kSavedAtOnceMax, unsaved_.size());
  const auto end = unsaved_.begin() + static_cast<std::ptrdiff_t>(count);
  Tiles tiles(std::move_iterator(unsaved_.begin()), std::move_iterator(end));
  unsaved_.erase(unsaved_.begin(), end);
  const auto then = [this, &writer](const StoreResult<void>& saved) {
    if (!saved) logger("store").warn("tiles are not saved: {}", saved.error().message());
    strand_.post([this, &writer] {
      is_saving_ = false;
      save_next(writer);
    });
  };
  is_saving_ = writer.save_tiles(std::move(tiles), unsaved_rules_, then);
}

void TileMaking::stop() {
  for (const auto& threads : {threads_.get(), past_thread_.get()}) {
    threads->stop();
    threads->join();
  }
}

}  // namespace runstone
