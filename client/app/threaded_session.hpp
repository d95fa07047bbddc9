// ThreadedSession: the session of runstone-client, made from its options, with its log lines, the
// question for the password, and the time limits of connecting.
// Thread: the main thread only. No call waits for a peer or for the disk, except finish().
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client/api/session_threads.hpp"
#include "client/app/options.hpp"
#include "client/report/report.hpp"
#include "client/session/failure_words.hpp"

namespace runstone {

class ThreadedSession : private SessionWatcher {
 public:
  /// `wake` is called from the other threads when there is something to handle. Throws
  /// std::runtime_error if the key file cannot be read or made. A cache that cannot be opened is a
  /// warning in the log.
  ThreadedSession(const ClientOptions& options, std::function<void()> wake);
  ~ThreadedSession() override;
  ThreadedSession(const ThreadedSession&) = delete;
  ThreadedSession& operator=(const ThreadedSession&) = delete;

  ClientSession& session() { return threads_.session(); }
  const ClientSession& session() const { return threads_.session(); }

  /// Starts the network thread, which connects until finish() and connects again after each loss.
  /// Call it once. receive() calls it again after it has asked for a password.
  void start(TimeUs now_us);
  /// Handles what the network thread received, for SessionThreads::kReceiveUsMax at most. If the server
  /// requires the world's password, asks for it at the terminal, once, and connects again. The call
  /// then waits for the player.
  void receive();
  /// Returns true if receive() left events for the next call.
  bool has_events() const { return threads_.has_events(); }
  /// Returns true if a world was opened, for the first time or again, since the last call.
  bool take_world_opened();
  /// Queues the session's outgoing messages on the network thread.
  void flush() { threads_.flush(); }
  /// Steps the cache, as SessionThreads::step_cache() says.
  void step_cache(TimeUs now_us, std::size_t room_bytes) {
    threads_.step_cache(now_us, room_bytes);
  }
  /// Writes the last chunks to the cache, sends a goodbye and stops both threads. Waits for the
  /// disk, and for the network at most SessionThreads::kGoodbyeMs.
  void finish() { threads_.finish(); }

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

 private:
  void on_message(const LinkReceived& event) override;
  void on_world_opened() override;
  void on_connection_lost(const LinkDisconnected& event) override;
  void on_cache_warning(std::string warning) override;
  /// Puts the server into the list of servers that were joined, if the options name one.
  void list_server() const;
  /// Logs the fingerprint of a server that is new to this player, and keeps its key.
  void save_first_contact();
  /// Returns true if the session lacks the password, it was not asked for yet, standard input is a
  /// terminal, and the player has a key file, whose key keeps the role of the password.
  bool can_ask_password() const;
  void ask_password();

  const ClientOptions options_;
  const std::function<void()> wake_;
  std::size_t pins_saved_ = 0;  // worlds of which the key was shown, and saved with a key file
  SnapshotStats snapshots_;
  bool world_opened_ = false;  // until take_world_opened()
  bool is_password_asked_ = false;
  std::optional<TimeUs> lost_us_ = 0;  // when the last world was lost; nullopt while one is open
  std::string last_failure_;           // why the last attempt to connect failed
  FailureWords last_words_;            // last_failure_ in words for the player
  SessionThreads threads_;             // last: its threads call wake_
};

}  // namespace runstone
