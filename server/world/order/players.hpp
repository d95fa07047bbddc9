// Players: maps public keys to author numbers. A key gets the next free number when it first
// authenticates. Its row is written with the author's first edit, so a key that never edits leaves
// nothing on disk, and nothing in memory after its last session. A number is never used twice
// within a run. If an author with a row joins under another name, the row is written again with
// that name.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class Players {
 public:
  static constexpr std::size_t kVisitorsMax = 100;

  /// Adds a row of the store. Call it before the first enter().
  void restore(const PlayerRow& stored) {
    // Another server may have given the number, or the key, otherwise while there was no row.
    if (const auto had = known_.find(stored.author);
        had != known_.end() && had->second.row.key != stored.key)
      by_key_.erase(had->second.row.key);
    if (const auto had = by_key_.find(stored.key);
        had != by_key_.end() && had->second != stored.author)
      known_.erase(had->second);
    by_key_[stored.key] = stored.author;
    known_[stored.author] = {stored, stored.name};
    next_ = std::max(next_, stored.author + 1);
  }
  /// Gives no number up to `author_max` to a new key. The rows of such numbers may be lost. Call it
  /// before the first enter().
  void begin_above(AuthorId author_max) { next_ = std::max(next_, author_max + 1); }
  /// Adds a player to whom another server has given the number. Returns false if another key has
  /// it, or the key has another number.
  bool adopt(const PlayerRow& player) {
    const auto named = by_key_.find(player.key);
    if (named != by_key_.end()) return named->second == player.author;
    if (!known_.try_emplace(player.author, Known{player, std::nullopt}).second) return false;
    by_key_[player.key] = player.author;
    next_ = std::max(next_, player.author + 1);
    return true;
  }
  /// Returns the key's author, a new one for a new key, and sets its name.
  AuthorId enter(const PublicKey& key, const std::string& name) {
    const auto found = by_key_.find(key);
    if (found != by_key_.end()) {
      known_[found->second].row.name = name;
      return found->second;
    }
    std::erase_if(visitors_, [&](const PlayerRow& visitor) { return visitor.key == key; });
    const AuthorId author = next_++;
    by_key_[key] = author;
    known_[author] = {{author, key, name}, std::nullopt};
    return author;
  }
  /// Removes an author that has no row. Returns true if it was removed. Requires that it has no
  /// session.
  bool forget_unsaved(AuthorId author) {
    const auto found = known_.find(author);
    if (found == known_.end() || found->second.stored_name) return false;
    by_key_.erase(found->second.row.key);
    visitors_.push_back(std::move(found->second.row));
    if (visitors_.size() > kVisitorsMax) visitors_.pop_front();
    known_.erase(found);
    return true;
  }
  /// Returns the last kVisitorsMax players of this run that left without an edit, the latest last.
  std::vector<PlayerRow> visitors() const { return {visitors_.begin(), visitors_.end()}; }
  std::size_t count() const { return known_.size(); }
  /// Returns the author's key, or nullopt if nobody has the number.
  std::optional<PublicKey> key_of(AuthorId author) const {
    const auto found = known_.find(author);
    if (found == known_.end()) return std::nullopt;
    return found->second.row.key;
  }
  /// Returns the name of a key's player, or nullopt if the key has no author.
  std::optional<std::string> name_of(const PublicKey& key) const {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return std::nullopt;
    return known_.at(found->second).row.name;
  }
  /// Returns the author number of a key, or nullopt if it has none.
  std::optional<AuthorId> author_of(const PublicKey& key) const {
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return std::nullopt;
    return found->second;
  }
  /// Returns true if the author's row in the store has another name.
  bool is_renamed(AuthorId author) const {
    const auto found = known_.find(author);
    return found != known_.end() && found->second.stored_name &&
           *found->second.stored_name != found->second.row.name;
  }
  /// Returns the author's row if it must be written, at the latest with the author's next record,
  /// or nullopt if the store has it.
  std::optional<PlayerRow> take_unsaved(AuthorId author) {
    const auto found = known_.find(author);
    if (found == known_.end()) return std::nullopt;
    auto& [row, stored_name] = found->second;
    if (stored_name == row.name) return std::nullopt;
    stored_name = row.name;
    return row;
  }

 private:
  struct Known {
    PlayerRow row;
    std::optional<std::string> stored_name;  // nullopt: the store has no row
  };
  std::map<PublicKey, AuthorId> by_key_;
  std::map<AuthorId, Known> known_;
  std::deque<PlayerRow> visitors_;
  AuthorId next_ = 1;
};

}  // namespace runstone
