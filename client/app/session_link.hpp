// SessionLink: a client session and the link that carries it, for programs that run many on one io_context. Threads:
// all on the one that runs it.
#pragma once
#include <asio/io_context.hpp>
#include <string>

#include "client/net/link.hpp"
#include "client/replica/client_session.hpp"

namespace runstone {

class SessionLink final : private LinkEvents {
 public:
  /// Starts connecting. `session` must outlive the link; so must `io`, which must not be run any more when it is
  /// destroyed.
  SessionLink(asio::io_context& io, ClientSession& session, const std::string& name, const NetConfig& net);

  const NetStats& stats() const { return link_.stats(); }
  /// Why the last connection ended; empty if none did.
  const std::string& last_failure() const { return last_failure_; }
  /// To try again with the same configuration is pointless.
  bool is_final() const { return session_.end() && session_.end()->final; }

  /// Sends what the session has to say. Call after every change of it.
  void flush();
  /// Says goodbye and ends, in at most `milliseconds` of running the io_context.
  void leave(std::int64_t milliseconds);

 private:
  void on_connected(ConnectionNumber connection) override;
  void on_received(NetReceived received) override;
  void on_disconnected(ConnectionNumber connection, std::string why) override;

  ClientSession& session_;
  const std::string name_;
  Link link_;
  ConnectionNumber connection_ = 0;  // 0: none
  std::string last_failure_;
};

}  // namespace runstone
