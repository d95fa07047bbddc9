#include "client/app/player_log.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

void PlayerLog::update(const std::map<AuthorId, OtherPlayer>& others) {
  if (others.size() > kPlayersLoggedMax) return;
  std::map<AuthorId, std::string> present;
  for (const auto& [author, other] : others) {
    if (other.name.empty()) continue;  // the pose of a player whose name has not come yet
    present[author] = "\"" + other.name + "\" key=" + key_fingerprint(other.key);
  }
  for (const auto& [author, text] : present) {
    const auto known = logged_.find(author);
    if (known == logged_.end() || known->second != text)
      spdlog::info("player here author={} name={}", author, text);
  }
  for (const auto& [author, text] : logged_) {
    if (!present.contains(author)) spdlog::info("player left author={} name={}", author, text);
  }
  logged_ = std::move(present);
}

}  // namespace runstone
