// AuthorNames: who the authors in a log are, and who is meant by a name.
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

  /// "ana #3"; "#3" of an author without a row; "the server" of author 0.
  std::string of(AuthorId author) const;
  /// The author of a name. Names are not unique, keys are: to take back somebody else's work by mistake is worse than to
  /// ask, so the error names all the authors that have the name, or says that there is none. O(authors).
  Result<AuthorId, std::string> find(const std::string& name) const;

 private:
  std::map<AuthorId, std::string> names_;
};

}  // namespace runstone
