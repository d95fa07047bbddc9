#include "server/admin/public_key_text.hpp"

#include <charconv>

namespace runstone {

std::optional<PublicKey> parse_public_key(std::string_view digits) {
  PublicKey key{};
  if (digits.size() != 2 * key.size()) return std::nullopt;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const char* const first = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(first, first + 2, key[i], 16);
    if (error != std::errc() || end != first + 2) return std::nullopt;
  }
  return key;
}

}  // namespace runstone
