// AuthorNames: finds the name of an author of the log, and the author with a name. An author is
// also found by an earlier name.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class AuthorNames {
 public:
  /// `rows` has the names in use. `used` has the names that were ever used, as far as they are
  /// known; it may repeat those in use.
  AuthorNames(const std::vector<PlayerRow>& rows, const std::vector<UsedName>& used);

  /// Returns "ana #3", or "#3" for an author without a row, or "the server" for author 0.
  std::string of(AuthorId author) const;
  /// Returns "ana #3 9M1Q-Z7CR-04KD", with the fingerprint of the author's key, or as of() if it
  /// has no row.
  std::string with_key(AuthorId author) const;
  /// Returns the only author who has this name or had it earlier. Fails if there is none, or if
  /// there are several, because keys are unique and names are not; the error then lists them.
  Result<AuthorId, std::string> find(const std::string& name) const;
  /// Returns true if this is the name that the author uses.
  bool is_in_use(const std::string& name, AuthorId author) const;

 private:
  std::map<AuthorId, std::string> names_;  // in use
  std::map<AuthorId, PublicKey> keys_;
  std::map<std::string, std::set<AuthorId>> authors_;  // by each name, in use or earlier
};

}  // namespace runstone
