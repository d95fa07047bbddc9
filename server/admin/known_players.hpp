// KnownPlayers: finds the key that a command means, and the text for a key in an answer. A name
// says little: several keys may use it one after another. So a word that fits several keys is an
// error that lists them and the word for each, and every text has the fingerprint of the key.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/public_key.hpp"
#include "common/core/result.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class KnownPlayers {
 public:
  /// Where players are known from.
  struct Sources {
    std::vector<PlayerRow> present;   // who is here
    std::vector<PlayerRow> stored;    // who has ever built
    std::vector<UsedName> used;       // earlier names of these
    std::vector<PlayerRow> visitors;  // who left without an edit
    std::vector<NameClaim> claims;    // who owns a name
    std::vector<PublicKey> others;    // keys without a name: with a grant, a restriction or a box
  };
  KnownPlayers() = default;
  /// Cost: O(n log n) for n names.
  explicit KnownPlayers(const Sources& sources);

  /// Returns the key that a word means:
  ///   - "#N": the player with this author number;
  ///   - 64 hexadecimal digits: this key, known or not;
  ///   - a fingerprint: the known key that has it;
  ///   - otherwise the player who has, owns or had this name. Case and the like do not count
  ///     (folded_name).
  /// Fails if there is none, or if there are several; the error then lists them, with a word that
  /// means each of them alone. A number or fingerprint that is also the name of somebody else is
  /// refused: owners keep such names from before (name_reference.hpp). Cost: O(keys) for a
  /// fingerprint, otherwise O(log n).
  Result<PublicKey, std::string> find(const std::string& word) const;
  /// Returns why "#N" does not mean the author with this number alone: it is the name of somebody
  /// else, too. Otherwise returns nullopt, also if nobody is known to have the number.
  std::optional<std::string> doubt_of(AuthorId author) const;
  /// Returns the players who have, own or had this name, with a word for each, or an empty text if
  /// there is none. Cost: O(log n).
  std::string list_of_named(const std::string& name) const { return list_of(named(name)); }
  /// Returns the author number of a key, or nullopt.
  std::optional<AuthorId> author_of(const PublicKey& key) const;
  /// Returns the players who have, own or had a name that fits a pattern (is_name_pattern), ascending.
  /// A "*" stands for any characters, and for none. Case and the like do not count. Cost: O(names *
  /// bytes of the pattern).
  std::vector<PublicKey> matching(const std::string& pattern) const;
  /// Returns how many players have an author number.
  std::size_t author_count() const { return authors_.size(); }
  /// Returns the key of an author number, or nullopt.
  std::optional<PublicKey> key_of(AuthorId author) const;
  /// Returns the name that the player has now, or an empty text if none is known.
  std::string name_of(const PublicKey& key) const;
  /// Returns true if the player has this name now. Case and the like do not count.
  bool has_name(const PublicKey& key, const std::string& name) const;
  /// Returns a word with which find() finds this key alone: "#N", the fingerprint or the key. Cost:
  /// O(keys).
  std::string word_for(const PublicKey& key) const;

  /// Returns "ana #3 9M1Q-Z7CR-04KD", as far as name and author number are known.
  std::string text_of(const PublicKey& key) const;
  /// Returns name, number and fingerprint of an author of the log: "#3" if the key is not known,
  /// "the server" for author 0.
  std::string text_of(AuthorId author) const;

 private:
  struct Player {
    std::string name;  // empty: not known
    std::optional<AuthorId> author;
  };
  void add(const PublicKey& key, const std::string& name, std::optional<AuthorId> author);
  std::set<PublicKey> named(const std::string& name) const;
  std::set<PublicKey> with_fingerprint(const std::string& fingerprint) const;
  std::string list_of(const std::set<PublicKey>& keys) const;

  std::map<PublicKey, Player> players_;
  std::map<AuthorId, PublicKey> authors_;
  std::map<std::string, std::set<PublicKey>> names_;  // by folded name
};

}  // namespace runstone
