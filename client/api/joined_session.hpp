// JoinedSession: the session of a WorldClient, made from its options, whose openings and losses
// become events.
// Thread: one. No call waits for a peer or for the disk, except start() and stop(), and receive()
// when it keeps the key of a server.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/api/session_threads.hpp"
#include "client/api/world_client_options.hpp"
#include "client/api/world_event.hpp"
#include "common/core/result.hpp"

namespace runstone {

class JoinedSession : private SessionWatcher {
 public:
  /// Starts connecting. `wake` is called from the other threads when there is something to handle.
  /// Fails with words as WorldClient::connect() does. May throw what the system throws.
  static Result<std::unique_ptr<JoinedSession>, std::string> start(
      const WorldClientOptions& options, std::function<void()> wake);
  ~JoinedSession() override;
  JoinedSession(const JoinedSession&) = delete;
  JoinedSession& operator=(const JoinedSession&) = delete;

  ClientSession& session() { return threads_.session(); }
  const ClientSession& session() const { return threads_.session(); }

  /// Handles what the network thread received, for SessionThreads::kReceiveUsMax at most. Ends the
  /// network thread if the server has refused this client for good.
  void receive();
  /// Returns true if receive() left something for the next call.
  bool has_more() const { return threads_.has_events(); }
  /// Returns the openings and losses since the last call, in their order: WorldOpened and
  /// ConnectionLost.
  std::vector<WorldEvent> take_events();
  /// Queues the session's outgoing messages on the network thread.
  void flush();
  /// Steps the cache as SessionThreads::step_cache() does, until the session has ended.
  void step_cache(TimeUs now_us, std::size_t room_bytes);
  /// Writes the last chunks to the cache, sends a goodbye and stops both threads. Waits for the
  /// disk, and for the network at most SessionThreads::kGoodbyeMs. Later calls do nothing.
  void stop();
  /// Returns true after stop(), and if the server has refused this client for good.
  bool is_ended() const { return is_ended_; }

 private:
  JoinedSession(std::string key_file, SessionConfig config, std::unique_ptr<CacheThread> cache);
  void on_world_opened() override;
  /// Reports in words why there is no connection, unless that was reported last.
  void on_connection_lost(const LinkDisconnected& event) override;
  void on_cache_warning(std::string warning) override;
  /// Keeps the key of a server that is new to this player. Returns true if it is.
  bool keep_first_contact();

  const std::string key_file_;
  std::size_t pins_kept_ = 0;  // worlds of which the key was reported, and saved with a key file
  std::vector<WorldEvent> reports_;     // not taken; kReportsMax at most
  std::optional<WorldId> world_;        // that was open last
  std::optional<ConnectionLost> loss_;  // reported last; nullopt while a world is open
  bool is_ended_ = false;
  SessionThreads threads_;  // last: its threads call the wake of start()
};

}  // namespace runstone
