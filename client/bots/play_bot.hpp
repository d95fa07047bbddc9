// PlayBot: a session that makes the recorded edits of one author again. Its view is one chunk far
// above the spawn, where nobody builds, because it needs the answers and not the world. Pure:
// messages and times are arguments, in microseconds of the client's steady clock. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "client/bots/play_schedule.hpp"
#include "client/bots/recorded_log.hpp"
#include "client/schedule/histogram.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

struct PlayCounts {
  std::uint64_t due = 0;        // edits that were due
  std::uint64_t submitted = 0;  // retries included
  std::uint64_t retried = 0;    // rejected for a while (`rate_limited`, `busy`)
  std::uint64_t confirmed = 0, durable = 0;
  std::uint64_t unseen = 0;  // resolved, but the commit did not arrive: the outcome is unknown
  std::map<std::string, std::uint64_t> rejected;  // by the server, finally; by reason
  std::map<std::string, std::uint64_t> refused;   // by the session; by reason
  Histogram confirm_us;                           // from the due time until the commit was applied
};

class PlayBot {
 public:
  /// `recorded` must outlive the bot. `config` needs keys and instance.
  PlayBot(const RecordedAuthor& recorded, SessionConfig config, double speed);

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  const std::string& name() const { return recorded_.name; }

  void begin(TimeUs now_us) { schedule_.begin(now_us); }
  /// Offers what is due, and takes the changes of the replica. Call it every few milliseconds and
  /// after messages.
  void step(TimeUs now_us);
  /// Returns true if every edit was submitted and answered, and every applied edit is on disk.
  bool is_done() const {
    return schedule_.done() && session_.replica().local_edits().all().empty();
  }
  /// Returns true if the bot waits for an answer, for the disk, or for room for an edit.
  bool waits() const;

  const PlayCounts& counts() const { return counts_; }

 private:
  struct Open {
    PlaySchedule::DueEdit due;
    std::size_t bytes = 0;  // upper bound of its request
  };
  void view_empty_chunk();
  void offer_due(TimeUs now_us);
  void drain_changes(TimeUs now_us);

  const RecordedAuthor& recorded_;
  ClientSession session_;
  PlaySchedule schedule_;
  std::optional<PlaySchedule::DueEdit> held_;  // waits until the edit budget suffices
  std::map<ClientSequence, Open> open_;        // edits without an answer
  std::size_t open_bytes_ = 0;
  PlayCounts counts_;
};

}  // namespace runstone
