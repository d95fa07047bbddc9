#include "server/admin/operators.hpp"

#include <algorithm>

#include "common/core/hex.hpp"

namespace runstone {
Result<std::set<PublicKey>, std::string> parse_operators(std::string_view text) {
  constexpr std::string_view kBetween = " ,\t";
  std::set<PublicKey> keys;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
       at = text.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    PublicKey key{};
    if (!read_hex(word, key))
      return failure("\"" + std::string(word) + "\" is no public key: 64 hexadecimal digits");
    keys.insert(key);
    at = end;
  }
  return keys;
}

}  // namespace runstone
