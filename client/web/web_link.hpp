// WebLink: a link to a server over a WebSocket of the browser. After a loss it connects again, to
// the gateway of another server of the world if it knows one (ConnectOrder). A binary message is
// one frame (docs/protocol.md). A page cannot stop a WebSocket from receiving, so received messages
// wait here until read(). The server sends chunks only as fast as they are acknowledged, and they
// are acknowledged when they are read. If kReceivedBytesMax bytes wait, the connection is closed,
// and the session resumes on the next one.
// Thread: the page's only one. Callbacks come from read() and step().
#pragma once
#include <emscripten/websocket.h>

#include <deque>
#include <memory>
#include <string>

#include "client/stream/connect_order.hpp"
#include "client/stream/link_callbacks.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class WebLink {
 public:
  static constexpr std::size_t kReceivedBytesMax = std::size_t{64} << 20;
  /// The bytes that may wait in the WebSocket. Further messages stay in the queue of the stream,
  /// which has a bound of its own (kSendBytesMax).
  static constexpr std::size_t kBufferedBytesMax = std::size_t{1} << 20;
  static constexpr TimeUs kConnectUsMax = 10'000'000;
  static constexpr ConnectPauses kPauses{250, 5'000};

  /// `url` begins with ws:// or wss://. `callbacks` must outlive the link.
  WebLink(std::string url, LinkCallbacks& callbacks);
  ~WebLink();
  WebLink(const WebLink&) = delete;
  WebLink& operator=(const WebLink&) = delete;

  /// Handles received messages until this time, one at least.
  void read(TimeUs until_us);
  /// Sends what is queued, acknowledges, and connects when it is time. Call it about every 10 ms.
  void step(TimeUs now_us);
  using Attempt = ConnectOrder<std::string>::Attempt;

  /// Takes the servers of the world. The list is one of the server that the link is connected to.
  /// Those count whose gateway has a page that is encrypted like the one of the link.
  void set_servers(const Servers& list);
  /// Returns the newest attempt to connect, with its URL.
  const Attempt& attempt() const { return attempt_; }
  /// Queues a message. Does nothing if the connection has ended.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once all queued messages are sent. The link connects again after a
  /// pause.
  void close(ConnectionNumber connection);
  /// Sends what is queued, closes the connection and makes no other one.
  void stop();
  const LinkStats& stats() const { return stats_; }

 private:
  void connect(TimeUs now_us);
  void disconnect(std::string why);
  void flush();
  /// Returns how many bytes the WebSocket takes now. It takes none if it is about to close; its
  /// event follows.
  std::size_t room() const;

  static int on_open(int type, const EmscriptenWebSocketOpenEvent* event, void* link);
  static int on_message(int type, const EmscriptenWebSocketMessageEvent* event, void* link);
  static int on_close(int type, const EmscriptenWebSocketCloseEvent* event, void* link);

  struct Received {
    Bytes bytes;
    TimeUs at_us = 0;
  };

  const std::string url_;  // that the page has given
  ConnectOrder<std::string> order_;
  Attempt attempt_;
  LinkCallbacks& callbacks_;
  LinkStats stats_;
  EMSCRIPTEN_WEBSOCKET_T socket_ = 0;  // 0: none
  bool is_open_ = false, is_closing_ = false, is_stopped_ = false;
  ConnectionNumber connection_ = 0;  // the newest one
  std::unique_ptr<MessageStream> stream_;
  std::deque<Received> received_;
  std::size_t received_bytes_ = 0;  // of received_
  std::string lost_;                // why the connection ended; reported after received_
  bool is_lost_ = false;
  TimeUs connect_us_ = 0;  // when the next attempt begins, or the one under way began
};

}  // namespace runstone
