// WebConnection: one connection of a browser: TLS if there is a certificate, then requests, one of
// which may turn the connection into a WebSocket.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <memory>
#include <string>

#include "common/core/address_block.hpp"
#include "server/web/http_answer.hpp"
#include "server/web/operator_gate.hpp"
#include "server/web/web_state.hpp"
#include "server/web/web_stream.hpp"
#include "server/web/websocket_session.hpp"

namespace runstone {

class WebConnection : public std::enable_shared_from_this<WebConnection> {
 public:
  /// Requires that `from` was counted in the limits. `state` must outlive the connection.
  WebConnection(WebState& state, std::uint64_t id, WebStream::Socket socket, AddressBlock from);
  ~WebConnection();
  WebConnection(const WebConnection&) = delete;
  WebConnection& operator=(const WebConnection&) = delete;

  static boost::asio::awaitable<void> run(std::shared_ptr<WebConnection> self);
  bool is_websocket() const { return websocket_ != nullptr; }
  /// Returns true for a WebSocket that has not sent anything.
  bool is_silent_websocket() const { return is_websocket() && !websocket_->has_sent(); }
  /// Returns true once the connection is closed. The object lives until its coroutine has ended.
  bool is_closed() const { return is_closed_ || !stream_.has_socket(); }
  /// Returns the address of the browser for the log, or "an unknown address" if the browser has
  /// gone.
  std::string address() const;
  /// Closes the connection without a word.
  void close() {
    is_closed_ = true;
    stream_.close();
    // It may wait for a server that does not read.
    if (websocket_) websocket_->close_link();
  }
  /// Closes the connection if its time is over. The gateway calls it about once a second.
  void close_if_due(TimeUs now_us) {
    stream_.close_if_due(now_us);
    if (!is_closed_ && !stream_.has_socket()) close();
  }
  /// Closes a WebSocket with words, and any other connection at once.
  void end_because_of_stop();

 private:
  using Request = WebSocketSession::Request;
  /// Serves requests until the connection is to be closed. Returns true if that should be done in
  /// order.
  static boost::asio::awaitable<bool> serve(std::shared_ptr<WebConnection> self);
  static boost::asio::awaitable<HttpAnswer> answer_to(std::shared_ptr<WebConnection> self,
                                                      const Request& request, WebPlace place);
  static OperatorRequest operator_request(const WebConnection& self, const Request& request,
                                          WebPlace place, std::string form);
  /// Answers for a gateway with several servers, outside of their folders.
  static boost::asio::awaitable<HttpAnswer> answer_of_gateway(std::shared_ptr<WebConnection> self,
                                                              const Request& request);
  /// Writes an answer. Returns false if that failed.
  static boost::asio::awaitable<bool> write(std::shared_ptr<WebConnection> self,
                                            const HttpAnswer& answer, const Request& request,
                                            bool keeps_alive);
  /// Ends sending, and reads what still comes, so that the browser gets the last answer.
  static boost::asio::awaitable<void> finish(std::shared_ptr<WebConnection> self);
  /// Returns the answer that refuses this WebSocket, or nullopt.
  std::optional<HttpAnswer> refusal_of(const Request& request, WebPlace place) const;

  WebState& state_;
  const std::uint64_t id_;
  const AddressBlock from_;
  WebStream stream_;
  boost::beast::flat_buffer read_;
  bool is_closed_ = false;
  std::shared_ptr<WebSocketSession> websocket_;  // null: no WebSocket yet
};

}  // namespace runstone
