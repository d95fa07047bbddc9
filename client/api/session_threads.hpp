// SessionThreads: a session with the threads that serve it: the network thread, which carries its
// messages, and the cache thread, which keeps chunks on disk between runs. runstone-client and
// WorldClient stand on it. Internal.
// Thread: one. No call waits for a peer or for the disk, except finish() and release_cache().
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "client/cache/cache_thread.hpp"
#include "client/net/net_client.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

/// What SessionThreads calls, in the thread that calls it.
class SessionWatcher {
 public:
  virtual ~SessionWatcher() = default;
  /// Is called before the session handles a message.
  virtual void on_message(const LinkReceived&) {}
  /// Is called when the session has opened a world, for the first time or again.
  virtual void on_world_opened() = 0;
  /// Is called when a connection was lost or could not be made, after the session has heard of it.
  virtual void on_connection_lost(const LinkDisconnected& event) = 0;
  /// Is called with one line of text.
  virtual void on_cache_warning(std::string warning) = 0;
};

class SessionThreads {
 public:
  /// `cache` may be null, and decides on SessionConfig::has_cache. The watcher lives longer than this object.
  SessionThreads(SessionConfig config, std::unique_ptr<CacheThread> cache, SessionWatcher& watcher);
  ~SessionThreads();
  SessionThreads(const SessionThreads&) = delete;
  SessionThreads& operator=(const SessionThreads&) = delete;

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  /// Returns null without a cache.
  CacheThread* cache() { return cache_.get(); }
  const CacheThread* cache() const { return cache_.get(); }

  /// Starts the network thread, which connects until disconnect() or finish(), and connects again
  /// after each loss. `wake` is called from that thread when receive() has something to handle. Call
  /// it once before all other calls, and once after each disconnect().
  void connect(LinkConfig config, std::function<void()> wake);
  /// Ends the network thread without a goodbye and drops what it received. The watcher may call it.
  void disconnect();
  /// Handles what the network thread received, for kReceiveUsMax at most.
  void receive();
  /// Returns true if receive() left something for the next call.
  bool has_events() const { return !events_.empty(); }
  /// Queues the session's outgoing messages on the network thread.
  void flush();
  /// Passes lookups of chunks and textures and their results between session and cache, and gives
  /// the cache the chunks to keep, at most every kKeepUs. A lookup finds chunks that take
  /// `room_bytes` at most.
  void step_cache(TimeUs now_us, std::size_t room_bytes);
  /// Sends a goodbye, writes the last chunks to the cache and ends both threads. Waits for the disk,
  /// and for the network at most kGoodbyeMs.
  void finish();
  /// Writes what waits, and closes the cache, so that other clients may use it.
  void release_cache() { cache_.reset(); }
  const LinkStats& net_stats() const { return net_->stats(); }

  // The time limit of a call of receive(), because local edits, meshes and frames wait for it.
  static constexpr TimeUs kReceiveUsMax = 1'000;
  static constexpr TimeUs kKeepUs = 2'000'000;  // between two batches for the cache
  static constexpr std::int64_t kGoodbyeMs = 1'000;

 private:
  void on_connected(const LinkConnected& event);
  void on_received(LinkReceived& event);
  void on_disconnected(const LinkDisconnected& event);
  /// Gives the cache a batch of chunks. Returns false if there was none.
  bool keep_chunks(std::size_t count_max);
  void keep_all_chunks();

  SessionWatcher& watcher_;
  std::unique_ptr<CacheThread> cache_;
  ClientSession session_;
  std::deque<LinkEvent> events_;     // taken from the network thread, not handled yet
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t connects_handled_ = 0;
  std::uint64_t servers_seen_ = 0;  // servers_number() of the list that the network thread has
  TimeUs kept_us_ = 0;              // when the cache last got a batch
  std::unique_ptr<NetClient> net_;  // last: its thread calls the caller's wake
};

}  // namespace runstone
