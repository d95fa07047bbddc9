// Players: which author a public key is. A key gets the next free author number when it first shows that it
// owns its secret, but the row is written only with the author's first edit: keys that never edit leave
// nothing on disk, and nothing in memory once they are gone. Within a run no number is given twice. A name
// that an author with a row comes back under is written anew: the last one wins.
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
#include "server/world/player_rows.hpp"

namespace runstone {

class Players {
 public:
  static constexpr std::size_t kVisitorsMax = 100;

  /// A row of the store, at the start.
  void restore(const PlayerRow& stored) {
    by_key_[stored.key] = stored.author;
    known_[stored.author] = {stored, stored.name};
    next_ = std::max(next_, stored.author + 1);
  }
  /// The key's author; a new one for a new key. The name replaces the one known.
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
  /// Forgets an author that has no row and no session; true if it is forgotten.
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
  const std::deque<PlayerRow>& visitors() const { return visitors_; }
  std::size_t count() const { return known_.size(); }
  /// Whether the store has the author under another name.
  bool is_renamed(AuthorId author) const {
    const auto found = known_.find(author);
    return found != known_.end() && found->second.stored_name &&
           *found->second.stored_name != found->second.row.name;
  }
  /// The row to be written, at the latest with the author's next record; nothing if the store has it so.
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
    std::optional<std::string> stored_name;  // nothing: the store has no row
  };
  std::map<PublicKey, AuthorId> by_key_;
  std::map<AuthorId, Known> known_;
  std::deque<PlayerRow> visitors_;
  AuthorId next_ = 1;
};

}  // namespace runstone
