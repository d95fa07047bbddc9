// ThreadedSession: the session of runstone-client with the threads that serve it: the network
// thread, which carries its messages, and the cache thread, which keeps chunks on disk between
// runs. Thread: the main thread only. No call waits for a peer or for the disk, except finish().
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "client/app/options.hpp"
#include "client/cache/cache_thread.hpp"
#include "client/net/net_client.hpp"
#include "client/report/report.hpp"
#include "client/session/client_session.hpp"
#include "client/session/failure_words.hpp"

namespace runstone {

class ThreadedSession {
 public:
  /// `wake` is called from the other threads when there is something to handle. Throws
  /// std::runtime_error if the key file cannot be read or made. A cache that cannot be opened is a
  /// warning in the log.
  ThreadedSession(const ClientOptions& options, std::function<void()> wake);
  ~ThreadedSession();
  ThreadedSession(const ThreadedSession&) = delete;
  ThreadedSession& operator=(const ThreadedSession&) = delete;

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }

  /// Starts the network thread, which connects until finish() and connects again after each loss.
  /// Call it once. receive() calls it again after it has asked for a password.
  void start(TimeUs now_us);
  /// Handles what the network thread received, for kReceiveUsMax at most. If the server
  /// requires the world's password, asks for it at the terminal, once, and connects again. The call
  /// then waits for the player.
  void receive();
  /// Returns true if receive() left events for the next call.
  bool has_events() const { return !events_.empty(); }
  /// Returns true if a world was opened, for the first time or again, since the last call.
  bool take_world_opened();
  /// Queues the session's outgoing messages on the network thread.
  void flush();
  /// Passes lookups and their results between session and cache, and gives the cache the chunks to
  /// keep, at most every kKeepUs. A lookup finds chunks that take `room_bytes` at most.
  void step_cache(TimeUs now_us, std::size_t room_bytes);
  /// Writes the last chunks to the cache, sends a goodbye and stops both threads. Waits for the
  /// disk, and for the network at most kGoodbyeMs.
  void finish();

  bool is_connected() const { return !lost_us_.has_value(); }
  /// Returns the server's reason if it refused this client for good, otherwise nullopt.
  std::optional<std::string> refusal() const;
  /// Returns in words why there is no connection, or what happened to the last attempt.
  FailureWords failure_words() const;
  /// Returns the seconds until timeout() ends the attempts to connect, or 0 while a world is open.
  double seconds_left(TimeUs now_us) const;
  /// Returns a line of text if no world has been open for the option --reconnect-seconds, otherwise
  /// nullopt.
  std::optional<std::string> timeout(TimeUs now_us) const;
  /// Returns the counts of the network so far.
  NetCounts net_counts() const;
  /// Adds the counts of network, snapshots and cache.
  void add_to(ClientReport& report) const;

  // The time limit of a call of receive(), because local edits, meshes and frames wait for it.
  static constexpr TimeUs kReceiveUsMax = 1'000;
  static constexpr TimeUs kKeepUs = 2'000'000;  // between two batches for the cache
  static constexpr std::int64_t kGoodbyeMs = 1'000;

 private:
  void on_connected(const LinkConnected& event);
  void on_received(LinkReceived& event);
  void on_disconnected(const LinkDisconnected& event);
  void on_world_opened();
  /// Puts the server into the list of servers that were joined, if the options name one.
  void list_server() const;
  /// Logs the fingerprint of a server that is new to this player, and keeps its key.
  void save_first_contact();
  /// Returns true if the session lacks the password, it was not asked for yet, standard input is a
  /// terminal, and the player has a key file, whose key keeps the role of the password.
  bool can_ask_password() const;
  void ask_password();
  /// Gives the cache a batch of chunks. Returns false if there was none.
  bool keep_chunks(std::size_t count_max);
  void keep_all_chunks();

  const ClientOptions options_;
  const std::function<void()> wake_;
  std::unique_ptr<CacheThread> cache_;  // null without a cache
  ClientSession session_;
  std::size_t pins_saved_ = 0;  // worlds of which the key was shown, and saved with a key file
  SnapshotStats snapshots_;
  std::deque<LinkEvent> events_;     // taken from the network thread, not handled yet
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t connects_handled_ = 0;
  std::uint64_t servers_seen_ = 0;  // servers_number() of the list that the network thread has
  bool world_opened_ = false;       // until take_world_opened()
  bool is_password_asked_ = false;
  std::optional<TimeUs> lost_us_ = 0;  // when the last world was lost; nullopt while one is open
  std::string last_failure_;           // why the last attempt to connect failed
  FailureWords last_words_;            // last_failure_ in words for the player
  TimeUs kept_us_ = 0;                 // when the cache last got a batch
  std::unique_ptr<NetClient> net_;     // last: its thread calls wake_
};

}  // namespace runstone
