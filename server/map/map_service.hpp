// MapService: draws the map of a world on request, on threads that all maps share. Requests wait in
// a queue with a bound. Drawing that takes long is done in turns, and other requests are served
// between them: what a turn made is kept in the caches, and the next turn begins there. All caches
// together have a bound, and nothing is written to the disk.
// Requests that draw nothing, such as the one for the state of the map, are served before those that
// draw, and end a turn of drawing early.
// Threads: ask() by any. Replies are called on one of the shared threads, by ask(), or by the
// destructor.
#pragma once
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/map/map_caches.hpp"
#include "server/map/map_request.hpp"
#include "server/map/map_threads.hpp"
#include "server/map/map_world.hpp"

namespace runstone {

/// The answer to a request of the map, in the terms of HTTP.
struct MapAnswer {
  unsigned status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body;  // null: empty
  std::string etag;                         // of a picture; empty: none
  std::uint64_t work_us = 0;                // time of the worker
};

/// Returns an answer that is one sentence.
MapAnswer map_words(unsigned status, const std::string& sentence);

class MapService final : MapThreads::Map {
 public:
  static constexpr std::size_t kQueueMax = 256;  // of requests that draw, and of others
  /// The time of a first turn. The n-th one has n times as much.
  static constexpr TimeUs kTurnUs = 200'000;
  /// A turn of drawing has at least so long, for its n-th turn n times as long, while others wait.
  static constexpr TimeUs kShortTurnUs = 25'000;
  /// After so many requests that draw nothing, one that draws has a turn.
  static constexpr int kQuickInRowMax = 16;
  /// A request that was not answered within this time is answered with "ask again".
  static constexpr TimeUs kAnswerUsMax = 8'000'000;

  using Reply = std::function<void(MapAnswer)>;
  /// Reports a fault of the stored world, for the host alone, at most once in ten seconds. A loss of
  /// edits is reported once, and again when it changes.
  using Warn = std::function<void(const std::string&)>;

  /// `threads` must outlive the service. `place`: of the world, which need not exist yet.
  /// `cache_bytes` bounds all that is kept in memory apart from the moments.
  MapService(MapThreads& threads, std::string place, std::size_t cache_bytes, Warn warn);
  /// Ends the turn under way and answers the requests that wait.
  ~MapService();
  MapService(const MapService&) = delete;
  MapService& operator=(const MapService&) = delete;

  /// Queues a request. `if_none_match`: the header of this name; a picture whose ETag is in it is
  /// answered with 304. If the queue is full, the reply is called at once, with 503.
  void ask(MapRequest request, std::string if_none_match, Reply reply);

  /// Returns the bytes of the caches.
  std::size_t cache_bytes() const { return caches_.bytes(); }

 private:
  struct Job {
    MapRequest request;
    std::string if_none_match;
    Reply reply;
    TimeUs asked_us = 0;
    TimeUs turn = 1;
    std::uint64_t work_us = 0;
  };
  bool turn() override;
  /// Takes the next job. Requires that there is one, and the mutex.
  Job take_next();
  /// Returns the answer, or nullopt if the job needs another turn.
  std::optional<MapAnswer> serve(const Job& job);
  std::optional<MapAnswer> serve(const TilePictureRequest& request,
                                 const std::string& if_none_match);
  std::optional<MapAnswer> serve(const MapStateRequest& request);
  std::optional<MapAnswer> serve(const BuildersRequest& request);
  std::optional<MapAnswer> serve(const MapMomentRequest& request);
  std::optional<MapAnswer> serve_recent_edits();
  /// Returns the moment after edit `at`, or the present. The error is nullopt if the job needs
  /// another turn.
  Result<MapMoment*, std::optional<MapAnswer>> moment_of(const std::optional<Sequence>& at);
  std::optional<MapAnswer> answer_to(const StoreError& error);
  /// Reports a loss of the world that was not reported yet.
  void report_loss();
  bool should_continue() const;

  MapThreads& threads_;
  const Warn warn_;
  MapCaches caches_;
  // These belong to the turns.
  MapWorld world_;
  TimeUs warned_us_ = 0;       // the time of the last warning; 0: none
  std::string reported_loss_;  // empty: the world lacked no edits
  TimeUs turn_ends_us_ = 0;
  TimeUs short_turn_ends_us_ = 0;  // if quick requests wait
  int quick_in_row_ = 0;

  std::mutex mutex_;  // a leaf: guards the queues
  std::deque<Job> queue_, quick_;
  std::atomic<std::size_t> quick_count_{0};  // in quick_
  std::atomic<bool> is_stopping_{false};
};

}  // namespace runstone
