#include "server/world/ground/tile_resends.hpp"

#include <algorithm>

namespace runstone {

void TileResends::add(const ChunkKey& key, ChunkPtr tile, std::vector<SessionId> sessions,
                      bool is_first) {
  if (sessions.empty()) return;
  tiles_.insert(is_first ? tiles_.begin() : tiles_.end(),
                {key, std::move(tile), std::move(sessions)});
}

std::vector<SessionId> TileResends::cancel(const ChunkKey& key) {
  const auto found =
      std::ranges::find_if(tiles_, [&key](const Waiting& one) { return one.key == key; });
  if (found == tiles_.end()) return {};
  std::vector<SessionId> sessions = std::move(found->sessions);
  tiles_.erase(found);
  return sessions;
}

std::optional<TileResends::Send> TileResends::next(TimeUs now_us) {
  due_us_ = std::max(due_us_, now_us - kTileResendBurstUs);
  if (tiles_.empty() || due_us_ > now_us) return std::nullopt;
  due_us_ += kTileResendUs;
  Waiting& first = tiles_.front();
  Send out{first.sessions.back(), first.key, first.tile};
  first.sessions.pop_back();
  if (first.sessions.empty()) tiles_.pop_front();
  return out;
}

}  // namespace runstone
