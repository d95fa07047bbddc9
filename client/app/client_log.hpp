// ClientLog: the log lines of runstone-client about a play: edits that were refused, chunks that
// are missing, the state of the server, the memory, and the players who come and go. Thread: the
// main thread.
#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "client/play/play.hpp"

namespace runstone {

class ClientLog final : public PlayLog {
 public:
  void on_edit_refused(const std::string& why) override;
  void on_changes(const ReplicaChanges& changes, std::span<const PlayerNotice> state) override;
  void on_new_materials(std::size_t count) override;
  void on_view_limited(const LimitChange& change) override;

  /// Logs who came and who left since the last line, at most every kPlayersUs. The lines have the
  /// fingerprints of the keys: a name can be imitated, a fingerprint cannot. Cost: O(players).
  void log_players(const std::map<AuthorId, OtherPlayer>& others, TimeUs now_us);

  static constexpr TimeUs kPlayersUs = 1'000'000;
  /// While more players are present, nothing is logged about them, because the log would become too
  /// long.
  static constexpr std::size_t kPlayersMax = 64;

 private:
  std::map<AuthorId, std::string> players_;  // name and fingerprint
  TimeUs players_us_ = 0;                    // when they were logged last
};

}  // namespace runstone
