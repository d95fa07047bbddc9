#include "server/world/ground/tile_board.hpp"

#include <algorithm>

#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

/// As many edited chunks wait at most until the tiles above them become outdated.
constexpr std::size_t kEditedMax = 4'096;

}  // namespace

void TileBoard::add_receiver(const ChunkKey& key, SessionId session) {
  std::vector<SessionId>& sessions = receivers_[key].sessions;
  const auto at = std::ranges::lower_bound(sessions, session);
  if (at == sessions.end() || *at != session) sessions.insert(at, session);
}

void TileBoard::leave(SessionId session, std::span<const ChunkKey> keys) {
  for (const ChunkKey& key : keys) {
    queue_.cancel(key, session);
    if (TileReceivers* having = receivers_.find(key)) {
      std::erase(having->sessions, session);
      if (!having->sessions.empty()) continue;
      receivers_.erase(key);
      resends_.cancel(key);
    }
    if (!queue_.is_waited_for(key)) queue_.cancel_again(key);
  }
}

void TileBoard::drop_if_unused(const ChunkKey& key) {
  if (!queue_.is_waited_for(key) && !receivers_.contains(key)) queue_.cancel_again(key);
}

void TileBoard::make_again(const ChunkKey& key, const TileReceivers& receivers, const Clocks& now) {
  const TimeUs pause = kTileRemakeUs << (key.lod - 1);
  const TimeUs due = receivers.made_us ? *receivers.made_us + pause : now.steady_us;
  queue_.make_again(key, std::max(now.steady_us + kTileRemakeUs, due));
}

void TileBoard::mark_outdated(const Clocks& now) {
  if (edited_.empty()) return;
  std::ranges::sort(edited_);
  edited_.erase(std::ranges::unique(edited_).begin(), edited_.end());
  // Each chunk is recorded with its own newest edit. Neighbours in the list often share theirs.
  const WorldChunks& versions = base_.order.chunks();
  const std::span<const ChunkKey> all = edited_;
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    const Sequence seq = versions.version(all[first]).seq;
    for (end = first + 1; end < all.size() && versions.version(all[end]).seq == seq;) ++end;
    base_.environment.tiles_edited(all.subspan(first, end - first), seq);
  }
  std::optional<ChunkKey> before;
  for (const ChunkKey& chunk : edited_) {
    for (std::uint8_t level = 1; level <= base_.config.tile_levels_max; ++level) {
      const ChunkKey key = tile_of(chunk.at, level);
      // The chunk before has marked this tile and those above it.
      if (before && tile_of(before->at, level) == key) break;
      if (const TileReceivers* having = receivers_.find(key)) make_again(key, *having, now);
    }
    before = chunk;
  }
  edited_.clear();
}

void TileBoard::make_all_again(const Clocks& now) {
  receivers_.for_each([&](const ChunkKey& key, const TileReceivers& receivers) {
    make_again(key, receivers, now);
  });
}

void TileBoard::edited(std::span<const ChunkKey> chunks, const Clocks& now) {
  if (base_.config.tile_levels_max == 0) return;
  if (chunks.size() == 1 && !edited_.empty() && edited_.back() == chunks.front()) return;
  edited_.insert(edited_.end(), chunks.begin(), chunks.end());
  if (edited_.size() >= kEditedMax) mark_outdated(now);
}

}  // namespace runstone
