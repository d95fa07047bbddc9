#include "server/admin/access_token_store.hpp"

#include <filesystem>
#include <map>
#include <utility>

#include "common/os/private_file.hpp"

namespace runstone {

Result<std::unique_ptr<AccessTokenStore>, std::string> AccessTokenStore::open(
    const std::string& world, std::string& warning) {
  const std::string file = (std::filesystem::path(world) / kAccessTokensFile).string();
  AccessTokens tokens;
  std::error_code missing;
  if (std::filesystem::exists(file, missing)) {
    const auto text = read_file(file, kSmallFileBytesMax);
    if (!text) return failure(text.error());
    auto parsed = AccessTokens::parse(*text);
    if (parsed) {
      tokens = *std::move(parsed);
    } else {
      const std::string aside = set_aside(file);
      warning = file + ": " + parsed.error() + ": all access tokens end" +
                (aside.empty() ? "" : "; the file is now " + aside);
    }
  }
  return std::unique_ptr<AccessTokenStore>(new AccessTokenStore(file, std::move(tokens)));
}

Result<void, std::string> AccessTokenStore::write(AccessTokens changed) {
  if (auto written = write_private_file(file_, changed.text()); !written) return written;
  tokens_ = std::move(changed);
  return {};
}

Result<MadeToken, std::string> AccessTokenStore::make_link(const PublicKey& owner, AuthorId author,
                                                           RightSet scope, TimeUs now_us) {
  const std::lock_guard lock(mutex_);
  AccessTokens changed = tokens_;
  auto made = changed.make_link(owner, author, scope, now_us);
  if (!made) return made;
  if (const auto written = write(std::move(changed)); !written) return failure(written.error());
  return made;
}

Result<std::optional<MadeToken>, std::string> AccessTokenStore::enter(std::string_view link_secret,
                                                                      TimeUs now_us) {
  const std::lock_guard lock(mutex_);
  AccessTokens changed = tokens_;
  auto made = changed.enter(link_secret, now_us);
  if (!made) return made;
  if (const auto written = write(std::move(changed)); !written) return failure(written.error());
  return made;
}

Result<std::size_t, std::string> AccessTokenStore::remove(
    const std::function<bool(const AccessToken&)>& goes, TimeUs now_us) {
  const std::lock_guard lock(mutex_);
  AccessTokens changed = tokens_;
  const std::size_t count = changed.remove(goes, now_us);
  if (count == 0) return count;
  if (const auto written = write(std::move(changed)); !written) return failure(written.error());
  return count;
}

Result<std::size_t, std::string> AccessTokenStore::end_of_others(
    const std::vector<PlayerRow>& players, TimeUs now_us) {
  std::map<PublicKey, AuthorId> authors;
  for (const PlayerRow& row : players) authors.emplace(row.key, row.author);
  const auto is_of_other = [&authors](const AccessToken& token) {
    const auto found = authors.find(token.owner);
    return found == authors.end() || found->second != token.author;
  };
  return remove(is_of_other, now_us);
}

std::optional<AccessToken> AccessTokenStore::find(TokenKind kind, std::string_view secret,
                                                  TimeUs now_us) const {
  const std::lock_guard lock(mutex_);
  const AccessToken* const found = tokens_.find(kind, secret, now_us);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::vector<AccessToken> AccessTokenStore::list(TimeUs now_us) const {
  const std::lock_guard lock(mutex_);
  return tokens_.list(now_us);
}

}  // namespace runstone
