#include "server/runtime/tile_making.hpp"

#include <algorithm>
#include <asio/post.hpp>

#include "server/runtime/logging.hpp"

namespace runstone {

TileMaking::TileMaking(WorldStrand& strand, ChunkSource& chunks, const Generator& generator,
                       std::int32_t edge)
    : strand_(strand), source_(chunks, generator, edge, ledger_, [](const std::string& text) {
        logger("store").warn("{}", text);
      }) {}

void TileMaking::make(TileRequest request, const MaterialTable& materials, Then then) {
  if (!visibility_ || materials_ != materials.size()) {
    visibility_ = std::make_shared<const VisibilityTable>(visibilities(materials));
    materials_ = materials.size();
  }
  asio::post(*threads_, [this, request = std::move(request), visibility = visibility_,
                         then = std::move(then)] {
    auto made = source_.make(request, *visibility);
    if (!made) logger("store").error("{}", made.error().message());
    strand_.post([key = request.key, then,
                  made = made ? *std::move(made) : std::vector<MadeTile>{}] { then(key, made); });
  });
}

void TileMaking::save(Tiles tiles, LogWriter& writer) {
  const std::size_t room = kUnsavedMax - std::min(kUnsavedMax, unsaved_.size());
  tiles.resize(std::min(tiles.size(), room));
  std::move(tiles.begin(), tiles.end(), std::back_inserter(unsaved_));
  if (!is_saving_) save_next(writer);
}

void TileMaking::save_next(LogWriter& writer) {
  std::erase_if(unsaved_, [this](const auto& tile) {
    return ledger_.newest_edit(tile.first) > tile.second->version.seq;
  });
  if (unsaved_.empty()) return;
  const std::size_t count = std::min(kSavedAtOnceMax, unsaved_.size());
  const auto end = unsaved_.begin() + static_cast<std::ptrdiff_t>(count);
  Tiles tiles(std::move_iterator(unsaved_.begin()), std::move_iterator(end));
  unsaved_.erase(unsaved_.begin(), end);
  is_saving_ = writer.save_tiles(std::move(tiles), [this, &writer](const StoreResult<void>& saved) {
    if (!saved) logger("store").warn("tiles are not saved: {}", saved.error().message());
    strand_.post([this, &writer] {
      is_saving_ = false;
      save_next(writer);
    });
  });
}

void TileMaking::stop() {
  threads_->stop();
  threads_->join();
}

}  // namespace runstone
