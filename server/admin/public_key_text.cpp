#include "server/admin/public_key_text.hpp"

#include "common/core/hex.hpp"

namespace runstone {

std::optional<PublicKey> parse_public_key(std::string_view digits) {
  PublicKey key{};
  if (!read_hex(digits, key)) return std::nullopt;
  return key;
}

}  // namespace runstone
