// WorldServer: the face of the world strand. Everything that happens to the world comes in here, one call at
// a time, with the time as an argument; everything it wants done goes out by WorldEnvironment. No clock, socket,
// disk or thread: a test runs it in virtual time. A turn: deliver what arrived by received(), then commit()
// once. What was queued together becomes one commit, and nothing waits for a tick. Call tick() some 20 times
// a second. Threads: all calls on one strand. Ports must not call back in; their answers come as later calls.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/edits/apply/stack_depths.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/clocks.hpp"
#include "server/world/world_config.hpp"
#include "server/world/world_counters.hpp"
#include "server/world/world_environment.hpp"

namespace runstone {

struct WorldState;

class WorldServer {
 public:
  /// `ports` must outlive the server.
  WorldServer(WorldConfig config, const WorldStart& start, WorldEnvironment& ports,
              RandomBytes random);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  /// Before the first session: each record of the log above the checkpoint, in order.
  void replay_onto_stack(const EditRecord& record);

  // ---- sessions
  void connected(SessionId session, const Clocks& now);
  /// A verified message. One that the session's state does not allow closes it: not_authenticated before
  /// ready, unexpected_message otherwise. Messages of sessions that were closed are ignored.
  void received(SessionId session, Message&& message, const Clocks& now);
  void disconnected(SessionId session);
  /// The session's queues have room again.
  void drained(SessionId session, const Clocks& now);

  // ---- turns
  /// Edits wait for commit().
  bool has_queued() const;
  /// Orders and sends the edits queued by received(). Cheap when there are none.
  void commit(const Clocks& now);
  /// Timeouts, poses, roster, audits, snapshot rounds, eviction, retries.
  void tick(const Clocks& now);

  // ---- the server's own edits: rollback, undo, redo
  struct OwnEdits {
    enum class State {
      ordered,  // all
      busy,     // the first `count`; a limit holds the next one for now: try again
      closed,   // none: the server stops, or the log cannot be written any more
      taken,    // none: a client of the author has used these client sequences
    };
    State state = State::ordered;
    std::size_t count = 0;    // how many were ordered, from the first on
    const char* reason = "";  // of busy: names the limit
  };
  /// Orders the offers at once and in order, behind all that is queued, as far as the log has room. Their edits must
  /// pass check_server_edit(), their client sequences ascend, of one author and instance, and their cause is not
  /// player. `payer`: the author who pays edit_tokens() for each of them, from the first of their sessions that can; an
  /// edit dearer than edit_burst costs a full bucket. Without a session, or if 0, nobody pays.
  OwnEdits order_server_edits(const std::vector<EditOffer>& offers, AuthorId payer,
                              const Clocks& now);

  // ---- commands
  /// Output of the session's command under way, as lines; the last one is done. Ignored if the session is gone.
  void answer_command(SessionId session, const std::vector<std::string>& lines, bool is_done,
                      bool is_ok);
  struct Present {
    SessionId session = 0;
    AuthorId author = 0;
    std::string name;
    PublicKey key{};
    WorldPos at;
  };
  /// Who is here, by session.
  std::vector<Present> present() const;
  /// Returns the players of this run that left without an edit, as Players::visitors() keeps them.
  std::vector<PlayerRow> visitors() const;

  // ---- answers of the ports
  void chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now);
  /// `what` names file, table and row. The chunk is quarantined.
  void chunk_failed(const ChunkKey& key, const std::string& what, const Clocks& now);
  /// The moment that a session asked for by `request`, or why there is none.
  void moment_opened(SessionId session, std::uint32_t request,
                     const Result<OpenedMoment, std::string>& opened, const Clocks& now);
  /// A chunk as it was then, or what cannot be read: names file, table and row.
  void past_chunk(SessionId session, std::uint32_t visit, const ChunkKey& key,
                  const Result<ChunkPtr, std::string>& chunk, const Clocks& now);
  /// Everything up to `seq` is on disk.
  void durable(Sequence seq, const Clocks& now);
  /// The oldest unanswered save_snapshots() is on disk.
  void snapshots_saved(const Clocks& now);
  /// The log cannot be written any more: edits are rejected busy from now on.
  void log_failed();

  // ---- stop
  /// Says goodbye to everybody, refuses edits, and writes all snapshots; goes on by the ports' answers.
  void begin_stop(const Clocks& now);
  /// Everything ordered is durable and contained in snapshots (but for quarantined chunks).
  bool is_settled() const;

  // ---- looking in
  bool accepts_edits() const;  // neither stopping nor failed
  Epoch epoch() const;
  Sequence head() const;
  /// The highest client sequence of the instance that was ever decided; 0: none.
  ClientSequence resolved(AuthorId author, ClientInstance instance) const;
  Sequence durable() const;
  Sequence checkpoint() const;
  std::size_t session_count() const;  // in any state
  std::size_t resident_chunks() const;
  std::size_t resident_bytes() const;
  const WorldCounters& counters() const;
  /// How deep the edit stacks were that were applied.
  const StackDepths& stack_depths() const;
  /// Null unless the chunk is in memory.
  ChunkPtr find_chunk(const ChunkKey& key) const;
  /// All chunks in memory that were ever edited, ascending.
  std::vector<std::pair<ChunkKey, ChunkPtr>> edited_chunks() const;
  /// Version by the order, whether the chunk is in memory or not.
  Version chunk_version(const ChunkKey& key) const;

 private:
  void step_keeper(const Clocks& now);
  std::unique_ptr<WorldState> state_;
};

}  // namespace runstone
