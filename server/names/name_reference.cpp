#include "server/names/name_reference.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cstddef>

namespace runstone {
namespace {

constexpr std::size_t kKeyDigits = 64;

/// Returns true for an address, also with a prefix or a zone behind it.
bool is_address(std::string_view word) {
  const std::string address(word.substr(0, word.find_first_of("/%")));
  in_addr v4{};
  in6_addr v6{};
  return ::inet_pton(AF_INET, address.c_str(), &v4) == 1 ||
         ::inet_pton(AF_INET6, address.c_str(), &v6) == 1;
}

bool is_key(std::string_view word) {
  return word.size() == kKeyDigits &&
         word.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}

}  // namespace

std::string fingerprint_in(std::string_view word) {
  std::string text;
  if (word.size() != 14) return text;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i];
    const bool is_digit = c >= '0' && c <= '9';
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (i == 4 || i == 9 ? c != '-' : !is_digit && !is_letter) return "";
    text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return text;
}

std::optional<std::string> read_as_reference(std::string_view folded) {
  if (folded.starts_with('#')) return "the number of a player";
  if (!fingerprint_in(folded).empty()) return "the fingerprint of a key";
  if (is_key(folded)) return "a key";
  if (is_address(folded)) return "an address";
  if (folded.starts_with(kRolePrefix)) return "a role";
  if (is_name_pattern(folded)) return "a pattern of names";
  return std::nullopt;
}

}  // namespace runstone
