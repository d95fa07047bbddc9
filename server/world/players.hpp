// Players: which author a public key is. A key gets the next free author number when it first shows that it
// owns its secret, but the row is written only with the author's first edit: keys that never edit leave
// nothing on disk.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/world_ports.hpp"

namespace runstone {

class Players {
 public:
  /// A row of the store, at the start.
  void restore(AuthorId author, const PublicKey& key, std::string name) {
    by_key_[key] = author;
    rows_[author] = {key, std::move(name), true};
  }
  /// The key's author; a new one for a new key. The name replaces the one known.
  AuthorId enter(const PublicKey& key, const std::string& name) {
    const auto found = by_key_.find(key);
    if (found != by_key_.end()) {
      rows_[found->second].name = name;
      return found->second;
    }
    const AuthorId author = rows_.empty() ? 1 : rows_.rbegin()->first + 1;
    by_key_[key] = author;
    rows_[author] = {key, name, false};
    return author;
  }
  /// The row to be written with the author's first record; nothing if the store has it.
  std::optional<NewPlayer> take_unsaved(AuthorId author) {
    const auto found = rows_.find(author);
    if (found == rows_.end() || found->second.is_saved) return std::nullopt;
    found->second.is_saved = true;
    return NewPlayer{author, found->second.key, found->second.name};
  }

 private:
  struct Row {
    PublicKey key{};
    std::string name;
    bool is_saved = false;
  };
  std::map<PublicKey, AuthorId> by_key_;
  std::map<AuthorId, Row> rows_;
};

}  // namespace runstone
