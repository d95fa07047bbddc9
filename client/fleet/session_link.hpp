// SessionLink: a client session and the link that carries it, for programs that run many on one io_context. Threads:
// all on the one that runs it.
#pragma once
#include <asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <string>

#include "client/bots/headless_session.hpp"
#include "client/net/link.hpp"
#include "client/replica/client_session.hpp"

namespace runstone {

/// Session: ClientSession or HeadlessSession.
template <class Session>
class LinkedSession final : private LinkEvents {
 public:
  /// Starts connecting. `session` must outlive the link; so must `io`, which must not be run any more when it is
  /// destroyed.
  LinkedSession(asio::io_context& io, Session& session, const std::string& name,
                const NetConfig& net);

  const NetStats& stats() const { return link_.stats(); }
  /// Why the last connection ended; empty if none did.
  const std::string& last_failure() const { return last_failure_; }
  /// Connections that ended, or did not come up, without the session having wished it: how many, by reason.
  const std::map<std::string, std::uint64_t>& losses() const { return losses_; }
  /// To try again with the same configuration is pointless.
  bool is_final() const { return session_.end() && session_.end()->final; }

  /// Sends what the session has to say. Call after every change of it.
  void flush();
  /// Says goodbye and ends, in at most `milliseconds` of running the io_context.
  void leave(std::int64_t milliseconds);

 private:
  void on_connected(ConnectionNumber connection) override;
  void on_received(NetReceived received) override;
  Result<bool> on_bytes(FrameClass frame_class, ByteView body, std::uint16_t chunk_edge,
                        TimeUs received_us) override;
  void on_disconnected(ConnectionNumber connection, std::string why) override;

  Session& session_;
  const std::string name_;
  Link link_;
  ConnectionNumber connection_ = 0;  // 0: none
  std::string last_failure_;
  std::map<std::string, std::uint64_t> losses_;
};

using SessionLink = LinkedSession<ClientSession>;
extern template class LinkedSession<ClientSession>;
extern template class LinkedSession<HeadlessSession>;

}  // namespace runstone
