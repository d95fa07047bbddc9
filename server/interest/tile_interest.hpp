// TileInterest: the tiles that one session gets. A session gets every tile of its view's highest
// level, and every other tile of its view whose parent is not empty: nothing is below an empty
// tile. A tile is in one of these states:
//   unknown   not in the view, or its parent is empty or not sent yet;
//   wanted    in the queue: the coarsest level first, within a level the nearest to the centre of
//             the view first;
//   waiting   it is being made for the session;
//   sent      the session has it. A changed one is sent again.
//   behind    the session has an earlier state of it, and does not draw it (is_hidden()). It
//             becomes wanted when the view moves so that it may be drawn.
// Memory: a byte for each tile of the view, and an entry of a set for each one that is wanted or
// behind. One thread.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "protocol/codec/messages.hpp"
#include "protocol/codec/view_tiles.hpp"
#include "server/interest/tile_grid.hpp"

namespace runstone {

enum class TileStatus : std::uint8_t { unknown, wanted, waiting, sent, sent_empty, behind };

/// A tile is hidden only if its children lie so far inside the view that a move by this many of
/// them does not show it. Views of a smaller radius than kHiddenMarginRadius have no margin.
inline constexpr std::int32_t kHiddenMargin = 1;
inline constexpr std::uint8_t kHiddenMarginRadius = 4;

/// Returns true if the client has the tile, perhaps in an earlier state.
constexpr bool client_has(TileStatus status) {
  return status == TileStatus::sent || status == TileStatus::sent_empty ||
         status == TileStatus::behind;
}

class TileInterest {
 public:
  explicit TileInterest(CoordLimit limit) : limit_(limit) {}

  struct Moved {
    std::vector<ChunkKey> left;  // tiles that were waiting, sent or behind, and are unknown now
    std::size_t steps = 0;       // tiles visited: the cost of the call
  };
  /// Sets the view. `skipped`: views that the client had in between; tiles outside of one of them
  /// are sent again. A tile that is behind and no longer hidden becomes wanted. Cost: O((wanted
  /// tiles + tiles behind) * log) and O(discs of the levels whose centre or size changes); O(tiles
  /// of the view) if there are skipped views or the radius changes.
  Moved set_view(const View& view, std::span<const View> skipped = {});

  /// Returns the first of the next `count_max` wanted tiles for which accepts(key) is true, or
  /// nullopt. It stays wanted.
  template <class Accepts>
  std::optional<ChunkKey> next_wanted(std::size_t count_max, const Accepts& accepts) const {
    for (const Place& place : queue_) {
      if (count_max-- == 0) break;
      if (accepts(std::get<ChunkKey>(place))) return std::get<ChunkKey>(place);
    }
    return std::nullopt;
  }
  TileStatus status(const ChunkKey& key) const;
  /// Makes a wanted tile waiting.
  void set_waiting(const ChunkKey& key);
  /// Makes a tile wanted again that is waiting, sent or behind.
  void want_again(const ChunkKey& key);
  /// Makes a sent tile behind. Requires that it is hidden.
  void set_behind(const ChunkKey& key);
  /// Returns true if the client draws the children of the tile in its place: all of them are in the
  /// view, and it has those that are tiles. The caller knows whether it has those that are chunks.
  bool is_hidden(const ChunkKey& key) const;
  /// Reports that a tile was sent which is waiting, sent or behind. If it is not empty, its
  /// children in the view become wanted unless they are known. If it is empty, everything below it
  /// becomes unknown; returns those of them that were waiting, sent or behind. Cost: O(log wanted
  /// tiles); for an empty tile O(tiles of the view below it) if any tile of a lower level is known.
  std::vector<ChunkKey> set_sent(const ChunkKey& key, bool is_empty);
  /// Makes all tiles unknown. Returns those that were waiting, sent or behind.
  std::vector<ChunkKey> clear();

  /// Returns the tiles of the view's highest level.
  std::vector<ChunkKey> roots() const;
  std::size_t waiting_count() const { return waiting_; }
  /// Returns the number of tiles that are not unknown.
  std::size_t known_count() const { return known_below(kTileLevelMax + 1U); }

 private:
  using Place = std::tuple<int, std::int64_t, ChunkKey>;
  Place place_of(const ChunkKey& key) const;
  /// Returns the number of known tiles of the levels below this one.
  std::size_t known_below(unsigned level) const;
  /// Returns the known tiles, level by level.
  std::vector<ChunkKey> known() const;
  /// Returns true if the session is to get this tile of the view.
  bool is_due(const ChunkKey& key) const;
  void set(const ChunkKey& key, TileStatus status);
  /// Makes a tile unknown. Appends it to `left` if it was waiting or sent.
  void drop(const ChunkKey& key, std::vector<ChunkKey>& left);
  void drop_below(const ChunkKey& key, std::vector<ChunkKey>& left);
  /// Makes unknown tiles of a level wanted if they are due. Visits the disc of the level but for
  /// the tiles of `before`. Returns the number of visited tiles.
  std::size_t want_level(std::uint8_t level, const std::optional<View>& before);

  CoordLimit limit_;
  std::optional<View> view_;
  TileGrid<TileStatus> tiles_;  // of view_
  std::set<Place> queue_;       // the wanted tiles
  std::set<ChunkKey> behind_;   // the tiles that are behind
  std::size_t waiting_ = 0;
  std::array<std::size_t, kTileLevelMax + 1> known_{};  // the number of known tiles of each level
};

}  // namespace runstone
