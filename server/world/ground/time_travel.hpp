// TimeTravel: a session sees its view as it was after an earlier edit, read-only. Workers make its
// chunks from base, keyframes and log. It gets no commits meanwhile; other sessions are not
// affected. A chunk whose version the session has already is not sent again, so moving in time
// costs what differs. ViewState precedes the first chunk of each state, in the frame class of
// chunks, so the order of messages tells which state a chunk shows.
// Thread: the world strand.
#pragma once
#include <string>

#include "server/world/ground/tiles.hpp"

namespace runstone {

/// All sessions together. Each reads a part of the log.
inline constexpr std::size_t kHistoriesOpeningMax = 2;
inline constexpr std::size_t kHistoryChunksLoadingMax = 8;  // per session

class TimeTravel {
 public:
  TimeTravel(GroundBase& base, Loads& loads, ChunkSending& sending, Tiles& tiles)
      : base_(base), loads_(loads), sending_(sending), tiles_(tiles) {}

  // Each of these returns true if the session has something to be delivered now.
  /// Replaces the session's earlier request, if that is still waiting. A session's requests take
  /// effect view_interval_us apart, as its views. A request for the past also waits until a worker
  /// has opened it; kHistoriesOpeningMax are opened at a time.
  [[nodiscard]] bool on_request(Viewer& viewer, const HistoryRequest& request, const Clocks& now);
  /// Carries out the session's newest request, unless it must wait: for the answer to the request
  /// before, for a worker, or because every state makes the whole view wanted again and so costs as
  /// much as a new view.
  [[nodiscard]] bool open_next(Viewer& viewer, const Clocks& now);
  /// Handles the answer to WorldEnvironment::open_history() for a session: the end of the view, or
  /// the reason of a failure.
  [[nodiscard]] bool opened(Viewer& viewer, std::uint32_t request,
                            const Result<OpenedHistory, std::string>& opened, const Clocks& now);
  /// Handles the answer to WorldEnvironment::load_history_chunk(). `chunk` is null if it cannot be
  /// read.
  [[nodiscard]] bool chunk_made(Viewer& viewer, HistoryNumber history, const ChunkKey& key,
                                const ChunkPtr& chunk, const Clocks& now);

  /// Counts the end of a request that a worker opened. Call it before opened(), or if the session
  /// has left.
  void opening_ended() { --opening_; }
  /// Returns true if another request may be given to a worker.
  bool can_open() const { return opening_ < kHistoriesOpeningMax; }
  /// Loads the session's wanted chunks as they were, nearest first. The player pays for each
  /// (Quotas::pay_load()). Requires a history view.
  void load_chunks(Viewer& viewer, const Clocks& now);

 private:
  void want_all(Viewer& viewer);
  void begin_state(Viewer& viewer, std::uint32_t request, const Clocks& now);
  void refuse(Viewer& viewer, std::uint32_t request, std::string why);

  GroundBase& base_;
  Loads& loads_;
  ChunkSending& sending_;
  Tiles& tiles_;
  std::uint32_t count_ = 0;  // history views since the start
  std::size_t opening_ = 0;  // requests that workers open
};

}  // namespace runstone
