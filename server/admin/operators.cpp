#include "server/admin/operators.hpp"

#include <algorithm>
#include <charconv>

namespace runstone {
namespace {

bool read_key(std::string_view digits, PublicKey& key) {
  if (digits.size() != 2 * key.size()) return false;
  for (std::size_t i = 0; i < key.size(); ++i) {
    const char* const first = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(first, first + 2, key[i], 16);
    if (error != std::errc() || end != first + 2) return false;
  }
  return true;
}

}  // namespace

Result<std::set<PublicKey>, std::string> parse_operators(std::string_view text) {
  constexpr std::string_view kBetween = " ,\t";
  std::set<PublicKey> keys;
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
       at = text.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    PublicKey key{};
    if (!read_key(word, key)) {
      return Unexpected<std::string>{"\"" + std::string(word) +
                                     "\" is no public key: 64 hexadecimal digits"};
    }
    keys.insert(key);
    at = end;
  }
  return keys;
}

}  // namespace runstone
