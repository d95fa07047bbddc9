// PlayBot: a session that makes one author's recorded edits again. It looks at one chunk far above the spawn, where
// nobody builds: it needs the answers, not the world. Pure, as the session: messages and times come in as arguments
// (microseconds of the client's steady clock). One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "client/bots/play_schedule.hpp"
#include "client/bots/recorded_log.hpp"
#include "client/replica/client_session.hpp"
#include "client/schedule/histogram.hpp"

namespace runstone {

struct PlayCounts {
  std::uint64_t due = 0;        // edits whose time came
  std::uint64_t submitted = 0;  // handed in, those offered again included
  std::uint64_t again =
      0;  // pushed back (`rate_limited`, `busy`), and so offered again as new edits
  std::uint64_t confirmed = 0, durable = 0;
  std::uint64_t unseen = 0;  // decided while the connection was down: nobody knows how
  std::map<std::string, std::uint64_t> rejected;  // by the server for good, by reason
  std::map<std::string, std::uint64_t>
      refused;       // by the session: beyond what this world takes; by reason
  Histogram confirm_us;  // due -> own commit applied
};

class PlayBot {
 public:
  /// `recorded` must outlive the bot. `config` needs keys and instance.
  PlayBot(const RecordedAuthor& recorded, SessionConfig config, double speed);

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  const std::string& name() const { return recorded_.name; }

  void begin(TimeUs now_us) { schedule_.begin(now_us); }
  /// Hands in what is due, and takes the replica's news. Call every few milliseconds and after messages.
  void step(TimeUs now_us);
  /// Every edit was handed in and answered, and what was applied is on disk.
  bool settled() const {
    return schedule_.done() && session_.replica().local_edits().all().empty();
  }
  /// Something is owed to it: an answer, a place on the disk, or room for an edit.
  bool waits() const;

  const PlayCounts& counts() const { return counts_; }

 private:
  struct Open {
    PlaySchedule::Turn turn;
    std::size_t bytes = 0;  // at most, of its request
  };
  void look_away();
  void hand_in(TimeUs now_us);
  void drain_changes(TimeUs now_us);

  const RecordedAuthor& recorded_;
  ClientSession session_;
  PlaySchedule schedule_;
  std::map<ClientSequence, Open> open_;  // edits without an answer
  std::size_t open_bytes_ = 0;
  PlayCounts counts_;
};

}  // namespace runstone
