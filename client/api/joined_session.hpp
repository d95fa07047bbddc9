// JoinedSession: the session of a WorldClient with the threads that serve it: the network thread,
// which carries its messages, and the cache thread, which keeps chunks on disk between runs.
// Thread: one. No call waits for a peer or for the disk, except the constructor and stop().
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/api/world_client_options.hpp"
#include "client/api/world_event.hpp"
#include "client/cache/cache_thread.hpp"
#include "client/net/net_client.hpp"
#include "client/session/client_session.hpp"
#include "common/core/result.hpp"

namespace runstone {

class JoinedSession {
 public:
  /// Starts connecting. `wake` is called from the other threads when there is something to handle.
  /// Fails with words as WorldClient::connect() does. Throws the exceptions of the system.
  static Result<std::unique_ptr<JoinedSession>, std::string> start(
      const WorldClientOptions& options, std::function<void()> wake);
  ~JoinedSession();
  JoinedSession(const JoinedSession&) = delete;
  JoinedSession& operator=(const JoinedSession&) = delete;

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }

  /// Handles the messages that the network thread received, for at most kReceiveUsMax. Ends the
  /// network thread if the server has refused this client for good.
  void receive();
  /// Returns true if receive() left something for the next call.
  bool has_more() const { return !events_.empty(); }
  /// Returns the openings and losses since the last call, in their order: WorldOpened and
  /// ConnectionLost.
  std::vector<WorldEvent> take_events();
  /// Queues the session's outgoing messages on the network thread.
  void flush();
  /// Passes lookups and their results between session and cache, and gives the cache the chunks to
  /// keep, at most every kKeepUs. A lookup finds chunks that take `room_bytes` at most.
  void step_cache(TimeUs now_us, std::size_t room_bytes);
  /// Writes the last chunks to the cache, sends a goodbye and stops both threads. Waits for the
  /// disk, and for the network at most kGoodbyeMs. Later calls do nothing.
  void stop();
  /// Returns true after stop(), and if the server has refused this client for good.
  bool is_ended() const { return is_ended_; }

  // The time limit of a call of receive(), because local edits, meshes and frames wait for it.
  static constexpr TimeUs kReceiveUsMax = 1'000;
  static constexpr TimeUs kKeepUs = 2'000'000;  // between two batches for the cache
  static constexpr std::int64_t kGoodbyeMs = 1'000;

 private:
  JoinedSession(std::string key_file, SessionConfig config, std::unique_ptr<CacheThread> cache,
                LinkConfig net, std::function<void()> wake);
  void handle(LinkEvent event);
  void on_connected(const LinkConnected& event);
  void on_received(LinkReceived& event);
  void on_disconnected(const LinkDisconnected& event);
  void on_world_opened();
  /// Reports in words the reason why there is no connection, unless the last report has the same
  /// reason.
  void report_loss(const LinkDisconnected& event);
  /// Keeps the key of a server that is new to this player. Returns true if the server is new.
  bool keep_first_contact();
  /// Gives the cache a batch of chunks. Returns false if there was none.
  bool keep_chunks(std::size_t count_max);
  void keep_all_chunks();

  const std::string key_file_;
  std::unique_ptr<CacheThread> cache_;  // null without a cache
  ClientSession session_;
  std::size_t pins_kept_ = 0;     // worlds of which the key was reported, and saved with a key file
  std::deque<LinkEvent> events_;  // taken from the network thread, not handled yet
  std::vector<WorldEvent> reports_;  // not taken; kReportsMax at most
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t connects_handled_ = 0;
  std::uint64_t servers_seen_ = 0;      // servers_number() of the list that the network thread has
  std::optional<WorldId> world_;        // that was open last
  std::optional<ConnectionLost> loss_;  // reported last; nullopt while a world is open
  bool is_ended_ = false;
  TimeUs kept_us_ = 0;              // when the cache last got a batch
  std::unique_ptr<NetClient> net_;  // last: its thread calls wake
};

}  // namespace runstone
