// Ground: the world as sessions see it: their views, and the chunks and tiles that follow from
// these, in the present and in the past. Its parts stand in files of their own; this class passes
// the messages of sessions and the answers of workers to them, and delivers.
//
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "server/world/ground/digest_checks.hpp"
#include "server/world/ground/ground_rules.hpp"
#include "server/world/ground/log_marks.hpp"
#include "server/world/ground/time_travel.hpp"
#include "server/world/ground/views.hpp"

namespace runstone {

class Ground {
 public:
  /// The arguments must outlive the object.
  Ground(const WorldConfig& config, WorldEnvironment& environment, WorldCounters& counters,
         Sessions& sessions, Order& order, const Rights& rights, Quotas& quotas);

  // Sessions.
  /// Adds an open session, without a view.
  void add(Session& session);
  void forget(const Session& session);
  /// Sends a session that has just opened its permissions.
  void send_permissions(Session& session);
  /// Returns the view in force of an open session, or nullopt.
  std::optional<View> view_of(const Session& session) const;
  /// Returns true if the session sees the live world, and does not leave it.
  bool sees_present(const Session& session) const;
  bool sees_past(const Session& session) const { return at(session).sees_past(); }
  /// Returns true if the session's queue was full, so that it lags behind.
  bool lags(const Session& session) const;
  /// Returns the sessions that are subscribed to a chunk, ascending. Valid until the next change.
  std::span<const SessionId> subscribers(const ChunkKey& key) const {
    return base_.interest.subscribers(key);
  }
  /// Rights have changed, on this ground and for players in general.
  void rights_changed(const std::vector<VoxelBox>& ground) { rules_.rights_changed(ground); }

  // Messages of open sessions.
  void on_view(Session& session, const View& view, const Clocks& now);
  /// Stores the claims of chunks and tiles that were not sent yet. Closes the session (flooding) if
  /// it has more than kClaimsPerSessionMax claims.
  void on_cached_chunks(Session& session, const CachedChunks& cached);
  /// Sends chunks of the session's view again. Chunks outside of it are ignored.
  void on_chunk_request(Session& session, const ChunkRequest& request, const Clocks& now);
  void on_history_request(Session& session, const HistoryRequest& request, const Clocks& now);
  void on_log_marks_request(Session& session, const LogMarksRequest& request, const Clocks& now);

  // Commits.
  /// Reports that a commit touched these chunks, ascending, which have their new versions. Loads
  /// those with long stacks.
  void edited(const std::vector<ChunkKey>& chunks, const Clocks& now);
  /// Marks chunks as outdated for a session because a commit did not fit its queue.
  void mark_outdated(const Session& session, std::span<const ChunkKey> chunks, const Clocks& now);

  // Delivery.
  /// Sends what is wanted to a session whose queues have room again.
  void drained(const Session& session, const Clocks& now);
  /// Sends what is wanted to a session on a tick.
  void retry(const Session& session, const Clocks& now);
  /// Returns true if the chunks of a session are to be sent by deliver_next().
  bool has_deliveries() const { return !base_.deliveries.empty(); }
  /// Sends some chunks of one session. Sessions take turns.
  void deliver_next(const Clocks& now);
  /// Returns true if changed tiles wait to be sent. Then call resend_tiles() after
  /// kTileResendBurstUs.
  bool has_tile_resends() const { return tiles_.has_resends(); }
  void resend_tiles(const Clocks& now) { tiles_.resend(now); }

  // Loads.
  /// Queues a load that the world itself needs. Does nothing unless the chunk is absent.
  void request_load(const ChunkKey& key, const Clocks& now) { loads_.request(key, now); }
  void start_loads(const Clocks& now) { loads_.start(now); }
  void cancel_loads_for_world() { loads_.cancel_for_world(); }
  /// Loads chunks again now that could not be read, a last time. For a server that stops.
  void hurry_loads(const Clocks& now);

  // Answers of WorldEnvironment.
  /// Takes a loaded chunk. Returns false if it is loaded again later, because it is newer than what
  /// has arrived here.
  bool chunk_loaded(const ChunkKey& key, Chunk chunk, const Clocks& now);
  /// Quarantines a damaged chunk. Returns false if it could not be read and is loaded again later.
  bool chunk_failed(const ChunkKey& key, LoadFailure failure, const std::string& what,
                    const Clocks& now);
  Tiles& tiles() { return tiles_; }
  void history_opened(SessionId session, std::uint32_t request,
                      const Result<OpenedHistory, std::string>& opened, const Clocks& now);
  void history_chunk_loaded(SessionId session, HistoryNumber history, const ChunkKey& key,
                            const Result<ChunkPtr, std::string>& chunk, const Clocks& now);
  void log_marks_read(SessionId session, std::uint32_t request,
                      const Result<FoundLogMarks, std::string>& found, const Clocks& now) {
    marks_.finished(session, request, found, now);
  }

  // Periodic work, in this order.
  /// Applies the views that are due, and sends the rights and boxes that are due.
  void apply_views(const Clocks& now);
  /// Sends digest checks, answers requests that had to wait, and loads again what could not be
  /// read.
  void serve_waiting(const Clocks& now);
  /// Collects chunks without users, keeps the memory within its bounds, and starts loads and tiles.
  void start_work(const Clocks& now);
  void collect_released() { loads_.collect_released(); }

 private:
  /// Returns the viewer of an open session.
  Viewer& at(const Session& session) { return base_.viewers.at(session.id); }
  const Viewer& at(const Session& session) const { return base_.viewers.at(session.id); }
  /// Sends the session's wanted chunks, nearest first: chunks in memory at once, the others after a
  /// load. Stops when the session's queue is full or it waits for loads_per_session_max loads.
  /// After some hundred chunks the delivery goes on in a task of its own.
  void deliver(Viewer& viewer, const Clocks& now);
  /// Sends a loaded chunk, or "chunk unavailable", to the sessions that wait for it.
  void deliver_loaded(const ChunkKey& key, const Clocks& now);

  GroundBase base_;
  Loads loads_;
  ChunkSending sending_;
  Tiles tiles_;
  TimeTravel travel_;
  Views views_;
  GroundRules rules_;
  DigestChecks digests_;
  LogMarkReads marks_;
};

}  // namespace runstone
