// AccessTokens: the tokens with which an operator gives commands without a session of a client,
// through a gateway. A token has an owner, a scope, an end and a number. The world keeps the hash of
// the token's secret alone. Pure, but for random bytes: times are arguments (UTC).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/rights/right.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// What a token is good for. The names are stored.
enum class TokenKind : std::uint8_t {
  link,  // is exchanged once for a page token
  page   // gives commands from the page of runstone-web
};
std::string_view name_of(TokenKind kind);

/// The digits of a secret: 32 random bytes in hex.
inline constexpr std::size_t kTokenDigits = 64;

struct AccessToken {
  std::uint64_t number = 0;  // in answers; never given twice by one file
  TokenKind kind = TokenKind::link;
  std::array<std::uint8_t, 32> hash{};  // of the secret
  PublicKey owner{};
  AuthorId author = 0;  // the owner's
  RightSet scope;       // no command that needs other rights is given with the token
  TimeUs made_us = 0, ends_us = 0;
  friend bool operator==(const AccessToken&, const AccessToken&) = default;
};

/// A token with its secret, which is nowhere else.
struct MadeToken {
  AccessToken token;
  std::string secret;
};

class AccessTokens {
 public:
  static constexpr std::size_t kTokensMax = 256;  // of all players
  static constexpr std::size_t kOfOwnerMax = 16;  // of one player and one kind
  static constexpr TimeUs kLinkUs = TimeUs{10} * 60 * 1'000'000;
  static constexpr TimeUs kPageUs = TimeUs{8} * 3'600 * 1'000'000;
  /// A clock that has gone back by more than this ends the tokens that were made later.
  static constexpr TimeUs kClockBackUsMax = 60'000'000;

  /// Parses what text() returns. The error says what is wrong, and where.
  static Result<AccessTokens, std::string> parse(std::string_view text);
  std::string text() const;

  /// Makes a link for a player. Fails if there are too many.
  Result<MadeToken, std::string> make_link(const PublicKey& owner, AuthorId author, RightSet scope,
                                           TimeUs now_us);
  /// Exchanges a link, which is used up, for a page token with its owner and scope. If the owner has
  /// too many, the one that ends first ends now. Returns nullopt if there is no such link.
  std::optional<MadeToken> enter(std::string_view link_secret, TimeUs now_us);
  /// Returns the token of this kind with this secret, or null. Cost: a hash, and O(tokens).
  const AccessToken* find(TokenKind kind, std::string_view secret, TimeUs now_us) const;
  /// Removes tokens. Returns how many of them had not ended.
  std::size_t remove(const std::function<bool(const AccessToken&)>& goes, TimeUs now_us);
  /// Returns the tokens that have not ended, oldest first.
  std::vector<AccessToken> list(TimeUs now_us) const;

 private:
  MadeToken add(AccessToken token);
  void forget_ended(TimeUs now_us);

  std::vector<AccessToken> tokens_;  // by number
  std::uint64_t next_number_ = 1;
};

}  // namespace runstone
