// WebSession: the session of the browser client on its link. Thread: the page's only one.
#pragma once
#include <optional>
#include <string>

#include "client/report/report.hpp"
#include "client/session/client_session.hpp"
#include "client/session/failure_words.hpp"
#include "client/web/join_options.hpp"
#include "client/web/web_cache.hpp"
#include "client/web/web_link.hpp"
#include "client/web/web_textures.hpp"

namespace runstone {

class WebSession final : private LinkCallbacks {
 public:
  explicit WebSession(const JoinOptions& options);

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }

  /// Handles received messages until this time, and connects when it is time.
  void step(TimeUs now_us, TimeUs until_us);
  /// Sends the session's outgoing messages.
  void flush(TimeUs now_us);
  /// Passes lookups and their results between session and cache. A lookup finds chunks that take
  /// `room_bytes` at most.
  void step_cache(std::size_t room_bytes, TimeUs now_us);
  /// Gives the cache some chunks that changed or left the view, kKeepChunks at most. A round of
  /// calls visits each chunk once. The next round begins kKeepUs later.
  void keep_chunks(TimeUs now_us);
  /// Returns null without a cache.
  WebCache* cache() { return cache_ ? &*cache_ : nullptr; }
  WebTextures& textures() { return textures_; }
  /// Returns true if a world was opened, for the first time or again, since the last call.
  bool take_world_opened();
  /// Sends a goodbye to the server. Afterwards the session sends and receives no messages.
  void leave();

  bool is_connected() const { return session_.is_open(); }
  /// Returns true if the server has refused this client and another attempt is pointless.
  bool is_refused() const { return session_.end() && session_.end()->final; }
  /// Returns in words why there is no connection, or what happened to the last attempt.
  FailureWords failure_words() const;
  /// Sets the counts of link, snapshots and cache.
  void add_to(ClientReport& report) const;

  static constexpr TimeUs kKeepUs = 2'000'000;    // between two rounds of keep_chunks()
  static constexpr std::size_t kKeepChunks = 16;  // of one call

 private:
  void on_connected(ConnectionNumber connection,
                    const std::optional<ChannelBinding>& binding) override;
  void on_received(LinkReceived received) override;
  void on_disconnected(ConnectionNumber connection, std::string why) override;

  ClientSession session_;
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t connects_handled_ = 0;
  std::uint64_t servers_seen_ = 0;  // servers_number() of the list that the link has
  bool world_opened_ = false;       // until take_world_opened()
  bool has_left_ = false;
  FailureWords last_words_;
  SnapshotStats snapshots_;
  std::optional<WebCache> cache_;
  WebTextures textures_;
  TimeUs keep_us_ = 0;  // when the next round begins, or the one under way began
  WebLink link_;
};

}  // namespace runstone
