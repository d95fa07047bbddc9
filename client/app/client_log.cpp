#include "client/app/client_log.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/core/key_text.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

void ClientLog::on_edit_refused(const std::string& why) { spdlog::warn("edit refused: {}", why); }

void ClientLog::on_changes(const ReplicaChanges& changes, std::span<const PlayerNotice> state) {
  for (const auto& [key, reason] : changes.unavailable)
    spdlog::warn("chunk={} unavailable: {}", text_of(key), to_string(reason));
  for (const PlayerNotice& notice : state) spdlog::warn("{}", notice.text);
  for (const RejectedEdit& reject : changes.rejects)
    spdlog::info("edit={} rejected: {} {}", reject.seq, to_string(reject.reason), reject.detail);
}

void ClientLog::on_new_materials(std::size_t count) {
  spdlog::info("the world has {} new materials", count);
}

void ClientLog::on_view_limited(const LimitChange& change) {
  spdlog::log(change.has_shrunk ? spdlog::level::warn : spdlog::level::info, "{}", change.text);
}

void ClientLog::log_players(const std::map<AuthorId, OtherPlayer>& others, TimeUs now_us) {
  if (now_us - players_us_ < kPlayersUs) return;
  players_us_ = now_us;
  if (others.size() > kPlayersMax) return;
  std::map<AuthorId, std::string> present;
  for (const auto& [author, other] : others) {
    if (other.name.empty()) continue;  // the pose of a player whose name has not come yet
    present[author] = "\"" + other.name + "\" key=" + key_fingerprint(other.key);
  }
  for (const auto& [author, text] : present) {
    const auto known = players_.find(author);
    if (known == players_.end() || known->second != text)
      spdlog::info("player here author={} name={}", author, text);
  }
  for (const auto& [author, text] : players_) {
    if (!present.contains(author)) spdlog::info("player left author={} name={}", author, text);
  }
  players_ = std::move(present);
}

}  // namespace runstone
