// The answer of the command `names`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "protocol/codec/messages.hpp"

namespace runstone {

struct OwnedName {
  std::string name;
  PublicKey key{};
  std::optional<AuthorId> author;  // nullopt: the owner has never built and is not here
};

/// Returns one line per name, with the fingerprint of the key that owns it and the author number.
/// At most 500 names are listed; a last line counts the others.
std::string name_list(const std::vector<OwnedName>& owned);

}  // namespace runstone
