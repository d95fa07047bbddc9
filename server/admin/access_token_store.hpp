// AccessTokenStore: the access tokens of a running server, in a file of the world's folder (mode
// 0600). The file is no part of the world: no copy of a world has it, so no copy has its tokens.
// Threads: any but the world strand. Calls wait for the disk, and for one another.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "server/admin/access_tokens.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

inline constexpr const char* kAccessTokensFile = "access-tokens";

class AccessTokenStore {
 public:
  /// Reads the file if there is one. A file that cannot be used is set aside, and all of its tokens
  /// end: `warning` says so then. Fails if a file cannot be read.
  static Result<std::unique_ptr<AccessTokenStore>, std::string> open(const std::string& world,
                                                                     std::string& warning);

  // These do what AccessTokens does. A change is on disk on return; if it cannot be written, nothing
  // has changed, and the error says why.
  Result<MadeToken, std::string> make_link(const PublicKey& owner, AuthorId author, RightSet scope,
                                           TimeUs now_us);
  Result<std::optional<MadeToken>, std::string> enter(std::string_view link_secret, TimeUs now_us);
  Result<std::size_t, std::string> remove(const std::function<bool(const AccessToken&)>& goes,
                                          TimeUs now_us);
  /// Removes the tokens whose owner has another author number in these rows, or none: the world was
  /// exchanged for an older copy. Commands would be logged under the number of somebody else.
  Result<std::size_t, std::string> end_of_others(const std::vector<PlayerRow>& players,
                                                 TimeUs now_us);
  std::optional<AccessToken> find(TokenKind kind, std::string_view secret, TimeUs now_us) const;
  std::vector<AccessToken> list(TimeUs now_us) const;

 private:
  AccessTokenStore(std::string file, AccessTokens tokens)
      : file_(std::move(file)), tokens_(std::move(tokens)) {}
  /// Requires that the caller holds mutex_.
  Result<void, std::string> write(AccessTokens changed);

  const std::string file_;
  mutable std::mutex mutex_;
  AccessTokens tokens_;
};

}  // namespace runstone
