// WorldServer: the entry to the world strand. It passes messages of sessions and answers of
// workers, of the log and of other servers to the rooms of the world. Time and bytes are arguments,
// and all effects are calls of WorldEnvironment. It uses no clock, socket, disk or thread, so a
// test runs it in virtual time.
//   - Call received() for each message that arrived. has_ready_edits() then tells whether
//     commit_one() has something to do. CommitScheduler decides when it is called, and edits that
//     were queued together become one commit. A test may call commit(), which orders all that may
//     be ordered.
//   - Call tick() some 20 times a second.
//   - Sessions that are closed in a call are removed at its end, or at the end of the next one if
//     the call went to a room.
// Threads: all calls on one strand. WorldEnvironment must not call in; its answers come as later
// calls.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "common/core/address_block.hpp"
#include "server/world/cluster/cluster.hpp"
#include "server/world/commit/changes.hpp"
#include "server/world/ground/ground.hpp"
#include "server/world/library/build_reads.hpp"
#include "server/world/library/build_uploads.hpp"
#include "server/world/library/texture_sending.hpp"
#include "server/world/people/people.hpp"

namespace runstone {

class WorldServer {
 public:
  /// `environment` must outlive the server.
  WorldServer(WorldConfig config, const WorldStart& start, WorldEnvironment& environment,
              RandomBytes random);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  // The rooms.
  const Order& order() const;
  const Rights& rights() const;
  Changes& changes();
  Ground& ground();
  const Ground& ground() const;
  People& people();
  const People& people() const;
  Cluster& cluster();
  const Cluster& cluster() const;
  BuildReads& build_reads();
  BuildUploads& build_uploads();
  const WorldCounters& counters() const;
  /// Returns the number of sessions in any stage.
  std::size_t session_count() const;
  /// Returns the border within which players may edit, or nullopt if there is none.
  const std::optional<WorldBorder>& border() const;

  /// Returns the place where players without a last place begin.
  const WorldPos& spawn() const;
  /// Sets the spawn for players who join from now on, and saves it. The other servers of the world
  /// take it at their next start. Requires a finite place in the world.
  void set_spawn(const WorldPos& spawn, const Clocks& now);

  /// Replays a record of the log above the checkpoint. Call it for each, in order, before the first
  /// session.
  void replay_onto_stack(const EditRecord& record);
  /// Takes over what may change while the world runs: sessions of a key and of an address, the time
  /// without a message, reach, speed, the operators and the message of the day. Sessions that are
  /// open stay.
  void reconfigure(const WorldConfig& config);

  // Sessions.
  /// Adds a connection from this address. `binding` identifies it if it is encrypted.
  void connected(SessionId session, const Clocks& now, AddressBlock from = {},
                 const std::optional<ChannelBinding>& binding = std::nullopt);
  /// Handles a verified message. Closes the session if its stage does not allow the message:
  /// not_authenticated before session accepted, unexpected_message otherwise. Ignores messages of
  /// closed sessions.
  void received(SessionId session, Message&& message, const Clocks& now);
  void disconnected(SessionId session);
  /// Reports that the session's queues have room again.
  void drained(SessionId session, const Clocks& now);

  // Progress.
  /// Returns true if commit_one() would order edits. Some large edits that are queued may have to
  /// wait (LargeEditPace).
  bool has_ready_edits(TimeUs now_us) const;
  /// Orders and sends the queued edits of one commit. Others that are queued may follow later.
  void commit_one(const Clocks& now);
  /// Orders and sends queued edits as long as has_ready_edits().
  void commit(const Clocks& now);
  /// Does periodic work: timeouts, views, presence, digest checks, retries, checkpoints, eviction,
  /// and the state that is kept besides the log.
  void tick(const Clocks& now);

  // Answers of WorldEnvironment. The others go to ground(), cluster(), build_reads() and
  // build_uploads().
  void chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now);
  /// Quarantines a damaged chunk. Loads one that could not be read again later, a few times.
  /// `what` names file, table and row.
  void chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                    const Clocks& now);
  /// Reports that every edit up to `seq` is on disk.
  void durable(Sequence seq, const Clocks& now);
  /// Reports that so many more changes of names are on disk, the oldest first.
  void names_durable(std::size_t count, const Clocks& now);
  /// Reports that the oldest unanswered save_snapshots() is on disk.
  void snapshots_saved(const Clocks& now);
  /// Reports that the disk has no space for new edits, or has space again. Edits are rejected busy
  /// meanwhile, with the reason `why`.
  void set_disk_is_full(bool is_full, const Clocks& now, const char* why = kDiskIsFull);
  /// Reports that the log cannot be written any more. Edits are rejected busy from now on.
  void log_failed();

  /// Closes all sessions, rejects edits, and writes dirty chunks as snapshots for at most
  /// stop_us_max. It continues with the answers of WorldEnvironment and with tick() until
  /// Order::is_flushed().
  void begin_stop(const Clocks& now);

  /// Saves the places of players and the clock of the world, if they have changed. Call it before
  /// the world is handed over. A stop does it, and tick() does it from time to time.
  void save_state(const Clocks& now);

 private:
  struct Rooms;
  /// Removes the sessions that were closed.
  void remove_closed();
  void step_checkpointer(const Clocks& now);
  void save_state(TimeUs now_us, TimeUs clock_us);
  void authenticate(Session& session, const ClientAuth& auth, const Clocks& now);
  void handle(Session& session, Message&& message, const Clocks& now);

  std::unique_ptr<Rooms> rooms_;
};

}  // namespace runstone
