// MapThreads: the threads that draw the maps of all worlds, at low priority. A map that has work
// gets turns on them, one at a time, and the maps take turns in order. So many worlds need no more
// threads than one, and a map with much to do delays the others by one turn.
// Threads: any.
#pragma once
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace runstone {

class MapThreads {
 public:
  /// A map that has turns.
  class Map {
   public:
    /// Works for a short time. Returns true if there is more to do. The calls are one after
    /// another, but not all on the same thread.
    virtual bool turn() = 0;

   protected:
    ~Map() = default;
  };

  /// Requires at least one thread.
  explicit MapThreads(std::size_t count);
  /// Requires that each map has left.
  ~MapThreads();
  MapThreads(const MapThreads&) = delete;
  MapThreads& operator=(const MapThreads&) = delete;

  /// Gives the map turns until one of them returns false. A call while a turn is under way gives it
  /// at least one more.
  void wake(Map& map);
  /// Ends the turns of the map. Waits until the one that is under way has ended. Requires that
  /// nobody calls wake() with this map any more.
  void leave(Map& map);

 private:
  struct State {
    bool is_running = false;  // otherwise it waits in ready_
    bool is_woken = false;    // since its turn began
    bool is_leaving = false;
  };
  void run();

  std::mutex mutex_;  // a leaf: guards what follows
  std::condition_variable ready_changed_, turn_ended_;
  std::deque<Map*> ready_;      // the next one first
  std::map<Map*, State> busy_;  // the maps that wait or run
  bool is_stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace runstone
