#include "server/admin/access_tokens.hpp"

#include <sodium.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "common/core/hex.hpp"

namespace runstone {
namespace {

constexpr std::string_view kTokensHeader = "runstone access tokens 1";
constexpr std::string_view kHashPurpose = "runstone access token";

/// The secrets have 256 random bits, so a fast hash suffices.
std::array<std::uint8_t, 32> hash_of_secret(std::string_view secret) {
  std::array<std::uint8_t, 32> out{};
  crypto_generichash(out.data(), out.size(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size(), reinterpret_cast<const unsigned char*>(kHashPurpose.data()),
                     kHashPurpose.size());
  return out;
}

bool has_ended(const AccessToken& token, TimeUs now_us) {
  return now_us >= token.ends_us || now_us < token.made_us - AccessTokens::kClockBackUsMax;
}

/// Takes the next word of words that single blanks separate.
std::string_view take_token_word(std::string_view& rest) {
  const std::string_view word = rest.substr(0, rest.find(' '));
  rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  return word;
}

template <class Number>
bool take_token_number(std::string_view& rest, Number& out) {
  const std::string_view word = take_token_word(rest);
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), out);
  return wrong == std::errc() && end == word.data() + word.size();
}

bool parse_token(std::string_view line, AccessToken& out) {
  if (!take_token_number(line, out.number)) return false;
  const std::string_view kind = take_token_word(line);
  if (kind != name_of(TokenKind::link) && kind != name_of(TokenKind::page)) return false;
  out.kind = kind == name_of(TokenKind::link) ? TokenKind::link : TokenKind::page;
  std::uint32_t scope = 0;
  if (!read_hex(take_token_word(line), out.hash) || !read_hex(take_token_word(line), out.owner) ||
      !take_token_number(line, out.author) || !take_token_number(line, scope) ||
      !take_token_number(line, out.made_us) || !take_token_number(line, out.ends_us))
    return false;
  // Other times are not written, and has_ended() could not calculate with all of them.
  if (out.made_us < 0 || out.ends_us < out.made_us) return false;
  out.scope = RightSet::of_bits(scope).and_in(RightSet::all());
  return line.empty();
}

}  // namespace

std::string_view name_of(TokenKind kind) { return kind == TokenKind::link ? "link" : "page"; }

Result<AccessTokens, std::string> AccessTokens::parse(std::string_view text) {
  AccessTokens out;
  std::uint64_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    const auto wrong = [&](const std::string& why) {
      return failure("line " + std::to_string(number) + ": " + why);
    };
    if (end == std::string_view::npos) return wrong("has no end");
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (number == 1) {
      if (!line.starts_with(kTokensHeader)) return wrong("is not the header of a list of tokens");
      line.remove_prefix(std::min(kTokensHeader.size() + 1, line.size()));
      if (!take_token_number(line, out.next_number_)) return wrong("has no next number");
      continue;
    }
    AccessToken token;
    if (!parse_token(line, token)) return wrong("is no token");
    if (token.number >= out.next_number_ ||
        (!out.tokens_.empty() && token.number <= out.tokens_.back().number))
      return wrong("its number is out of order");
    if (out.tokens_.size() == kTokensMax) return wrong("there are too many tokens");
    out.tokens_.push_back(token);
  }
  if (number == 0) return failure("line 1: is not the header of a list of tokens");
  return out;
}

std::string AccessTokens::text() const {
  std::string out = std::string(kTokensHeader) + " " + std::to_string(next_number_) + "\n";
  for (const AccessToken& token : tokens_) {
    out += std::to_string(token.number) + " " + std::string(name_of(token.kind)) + " " +
           to_hex(token.hash) + " " + to_hex(token.owner) + " " + std::to_string(token.author) +
           " " + std::to_string(token.scope.bits()) + " " + std::to_string(token.made_us) + " " +
           std::to_string(token.ends_us) + "\n";
  }
  return out;
}

MadeToken AccessTokens::add(AccessToken token) {
  std::array<std::uint8_t, kTokenDigits / 2> random{};
  randombytes_buf(random.data(), random.size());
  MadeToken made;
  made.secret = to_hex(random);
  token.number = next_number_++;
  token.hash = hash_of_secret(made.secret);
  tokens_.push_back(token);
  made.token = token;
  return made;
}

Result<MadeToken, std::string> AccessTokens::make_link(const PublicKey& owner, AuthorId author,
                                                       RightSet scope, TimeUs now_us) {
  forget_ended(now_us);
  const auto links = std::ranges::count_if(tokens_, [&](const AccessToken& token) {
    return token.kind == TokenKind::link && token.owner == owner;
  });
  if (links >= static_cast<std::ptrdiff_t>(kOfOwnerMax))
    return failure("the player has " + std::to_string(kOfOwnerMax) +
                   " links that nobody has used: page revoke removes them");
  if (tokens_.size() >= kTokensMax)
    return failure("there are " + std::to_string(kTokensMax) +
                   " tokens: page list shows them, page revoke removes some");
  AccessToken token;
  token.kind = TokenKind::link;
  token.owner = owner;
  token.author = author;
  token.scope = scope;
  token.made_us = now_us;
  token.ends_us = now_us + kLinkUs;
  return add(token);
}

std::optional<MadeToken> AccessTokens::enter(std::string_view link_secret, TimeUs now_us) {
  const AccessToken* const link = find(TokenKind::link, link_secret, now_us);
  if (link == nullptr) return std::nullopt;
  AccessToken token = *link;
  std::erase_if(tokens_, [&](const AccessToken& each) { return each.number == token.number; });
  forget_ended(now_us);
  const auto is_of_owner = [&](const AccessToken& each) {
    return each.kind == TokenKind::page && each.owner == token.owner;
  };
  while (std::ranges::count_if(tokens_, is_of_owner) >= static_cast<std::ptrdiff_t>(kOfOwnerMax))
    tokens_.erase(std::ranges::find_if(tokens_, is_of_owner));
  token.kind = TokenKind::page;
  token.made_us = now_us;
  token.ends_us = now_us + kPageUs;
  return add(token);
}

const AccessToken* AccessTokens::find(TokenKind kind, std::string_view secret,
                                      TimeUs now_us) const {
  if (secret.size() != kTokenDigits) return nullptr;
  const auto hash = hash_of_secret(secret);
  for (const AccessToken& token : tokens_) {
    // The time of the comparison tells nothing of a secret, because it compares hashes.
    if (token.kind == kind && token.hash == hash)
      return has_ended(token, now_us) ? nullptr : &token;
  }
  return nullptr;
}

std::size_t AccessTokens::remove(const std::function<bool(const AccessToken&)>& goes,
                                 TimeUs now_us) {
  forget_ended(now_us);
  return std::erase_if(tokens_, goes);
}

std::vector<AccessToken> AccessTokens::list(TimeUs now_us) const {
  std::vector<AccessToken> out;
  for (const AccessToken& token : tokens_) {
    if (!has_ended(token, now_us)) out.push_back(token);
  }
  return out;
}

void AccessTokens::forget_ended(TimeUs now_us) {
  std::erase_if(tokens_, [now_us](const AccessToken& token) { return has_ended(token, now_us); });
}

}  // namespace runstone
