// LinkedSession: a client session with the network link that carries its messages, for programs
// that run many of them on one io_context.
// Thread: all calls on the thread that runs the io_context.
#pragma once
#include <asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <string>

#include "client/bots/headless_session.hpp"
#include "client/net/link.hpp"
#include "client/session/client_session.hpp"

namespace runstone {

/// How long a program waits for the goodbye of a session before it ends the link.
inline constexpr std::int64_t kGoodbyeMs = 1'000;

/// Session is ClientSession or HeadlessSession.
template <class Session>
class LinkedSession final : private LinkCallbacks {
 public:
  /// Starts connecting. `session` and `io` must outlive this object. `io` must not run any more
  /// when this object is destroyed.
  LinkedSession(asio::io_context& io, Session& session, const std::string& name,
                const LinkConfig& net);

  const LinkStats& stats() const { return link_.stats(); }
  /// Returns why the last connection ended, or an empty text if none did.
  const std::string& last_failure() const { return last_failure_; }
  /// Returns the number of connections that could not be made, or that ended although the session
  /// did not end them, by reason.
  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  /// Returns true if the server refused this session for good.
  bool is_final() const { return session_.end() && session_.end()->final; }

  /// Sends the session's queued messages. Call it after every change of the session.
  void flush();
  /// Sends a goodbye and ends the link after `milliseconds` of running the io_context at most.
  void leave(std::int64_t milliseconds);

 private:
  void on_connected(ConnectionNumber connection,
                    const std::optional<ChannelBinding>& binding) override;
  void on_received(LinkReceived received) override;
  Result<bool> on_bytes(MessageKind kind, ByteView body, std::uint16_t chunk_edge,
                        TimeUs received_us) override;
  void on_disconnected(ConnectionNumber connection, std::string why) override;

  Session& session_;
  const std::string name_;
  Link link_;
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t servers_seen_ = 0;   // servers_number() of the list that the link has
  std::string last_failure_;
  std::map<std::string, std::uint64_t> losses_;
};

extern template class LinkedSession<ClientSession>;
extern template class LinkedSession<HeadlessSession>;

}  // namespace runstone
