// AuthorNames: finds the name of an author of the log, and the author with a name.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "server/world/player_rows.hpp"

namespace runstone {

class AuthorNames {
 public:
  explicit AuthorNames(const std::vector<PlayerRow>& rows);

  /// Returns "ana #3", or "#3" for an author without a row, or "the server" for author 0.
  std::string of(AuthorId author) const;
  /// Returns the only author with this name. Fails if there is none, or if several authors have the
  /// name, because keys are unique and names are not; the error then lists their numbers. Cost:
  /// O(authors).
  Result<AuthorId, std::string> find(const std::string& name) const;

 private:
  std::map<AuthorId, std::string> names_;
};

}  // namespace runstone
