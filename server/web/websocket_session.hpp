// WebSocketSession: passes frames between a browser's WebSocket and a connection to the server, in
// both directions. Nothing is queued: each direction holds what it has read, and reads again when
// the other side has taken it. Frames of the server that come together are one message, so that
// they cost the gateway and the browser only once. So a slow side slows the other one down, as TCP
// does. A WebSocket that breaks a rule is closed with a code and words. Its connection to the
// server then just ends.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <string>

#include "server/web/web_frame.hpp"
#include "server/web/web_state.hpp"
#include "server/web/web_stream.hpp"

namespace runstone {

class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;
  using CloseCode = boost::beast::websocket::close_code;

  /// All but `from` must outlive the session. `from` is charged if the browser breaks a rule.
  /// `server`: path of the socket of the server.
  WebSocketSession(WebState& state, WebStream& stream, AddressBlock from,
                   const std::string& server);

  /// Answers the request for a WebSocket, and serves it until it has ended.
  static boost::asio::awaitable<void> run(std::shared_ptr<WebSocketSession> self, Request request);
  /// Returns true from the answer to the request on.
  bool is_open() const { return is_open_; }
  /// Returns true once a message of the browser was passed on.
  bool has_sent() const { return has_sent_; }
  /// Closes the WebSocket with a code and words of at most 123 bytes. Later calls do nothing.
  /// Requires is_open().
  void end(CloseCode code, const char* words);
  /// Closes the connection to the server. What waits for it fails.
  void close_link();

 private:
  /// Connects to the server, and sends the address of the browser. Returns the error if that
  /// failed.
  static boost::asio::awaitable<boost::system::error_code> open_link(
      std::shared_ptr<WebSocketSession> self);
  static boost::asio::awaitable<void> browser_to_server(std::shared_ptr<WebSocketSession> self);
  // Frames of the server take a shorter way than coroutines and Beast, because each edit of a
  // player is sent to all others: they are read, and written past Beast in the same turn.
  void read_link();
  void on_link(const boost::system::error_code& error, std::size_t bytes);
  /// Waits until the browser has taken what was written, then goes on.
  void wait_until_sent();
  /// Reads more of the server, or ends if its stream is broken.
  void go_on();
  void on_link_end();
  static boost::asio::awaitable<void> close_websocket(std::shared_ptr<WebSocketSession> self,
                                                      CloseCode code, const char* words);
  /// Counts a ping or a pong of the browser. Ends the WebSocket if there are too many.
  void on_control_frame();
  /// Ends the WebSocket because of what the browser sent.
  void broke_rule(CloseCode code, const char* words);
  /// Counts and charges what the browser sent.
  void charge_fault();
  void task_ended();

  WebState& state_;
  WebStream& stream_;
  const AddressBlock from_;
  const std::string& server_;
  boost::beast::websocket::stream<WebStream&> websocket_;
  boost::asio::basic_stream_socket<boost::asio::local::stream_protocol,
                                   boost::asio::io_context::executor_type>
      link_;
  FrameCutter cutter_;
  Bytes message_;                     // from the browser
  bool has_sent_ = false;             // a frame of the browser was passed on
  bool has_answer_ = false;           // a frame of the server was passed on
  std::uint64_t control_frames_ = 0;  // since control_since_us_
  TimeUs control_since_us_ = 0;
  bool is_open_ = false;
  bool is_ending_ = false;
  int tasks_ = 0;                         // coroutines besides run()
  boost::asio::steady_timer tasks_done_;  // never expires; cancelled when the last task ends
};

}  // namespace runstone
