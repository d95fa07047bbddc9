// PlayerReader: reading of players, of their names, and of the watermarks of their operations.
#pragma once
#include <vector>

#include "server/store/store_error.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class PlayerReader {
 public:
  virtual ~PlayerReader() = default;

  /// Returns all players, ascending by author. Fails (corrupt) if a row is damaged or missing.
  virtual StoreResult<std::vector<PlayerRow>> players() = 0;
  /// Returns the last kNamesPerAuthorMax names that each player has used, ascending by author, then
  /// by first use.
  virtual StoreResult<std::vector<UsedName>> player_names() = 0;
  /// Returns the names that keys own, ascending by their folded form. There are none in a world of
  /// format 2 that is open for reading only. Fails (corrupt) if a row is damaged or missing.
  virtual StoreResult<std::vector<NameClaim>> name_claims() = 0;
  /// Returns the watermarks of all client instances. Compactions keep them. Fails (corrupt) if a row
  /// is damaged or missing.
  virtual StoreResult<std::vector<HighWater>> high_waters() = 0;
  /// Returns the highest author number that was ever stored, or 0. It is not lower if rows of
  /// players are lost, so that no number is given to two players.
  virtual AuthorId author_max() const = 0;
};

}  // namespace runstone
