#include "client/web/web_link.hpp"

#include <sodium.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/text.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/frame_bytes.hpp"

namespace runstone {
namespace {

constexpr unsigned short kNormalClosure = 1000;

std::string words_of_close(const EmscriptenWebSocketCloseEvent& event) {
  // A long reason is cut, which may damage its last character.
  if (event.reason[0] != '\0' && is_printable_utf8(event.reason)) return event.reason;
  return "the WebSocket was closed (code " + std::to_string(event.code) + ")";
}

}  // namespace

WebLink::WebLink(std::string url, LinkCallbacks& callbacks)
    : url_(std::move(url)),
      order_({url_}, kPauses, randombytes_uniform),
      attempt_(order_.next()),
      callbacks_(callbacks) {}

WebLink::~WebLink() { stop(); }

void WebLink::connect(TimeUs now_us) {
  connect_us_ = now_us;
  EmscriptenWebSocketCreateAttributes attributes;
  emscripten_websocket_init_create_attributes(&attributes);
  attributes.url = attempt_.address.c_str();
  socket_ = std::max(0, emscripten_websocket_new(&attributes));
  if (socket_ == 0) return disconnect("the browser makes no WebSocket to " + attempt_.address);
  emscripten_websocket_set_onopen_callback(socket_, this, on_open);
  emscripten_websocket_set_onmessage_callback(socket_, this, on_message);
  emscripten_websocket_set_onclose_callback(socket_, this, on_close);
}

int WebLink::on_open(int /*type*/, const EmscriptenWebSocketOpenEvent* event, void* link) {
  auto& self = *static_cast<WebLink*>(link);
  if (event->socket != self.socket_) return 0;
  self.is_open_ = true;
  self.is_closing_ = false;
  self.order_.connected();
  ++self.connection_;
  self.stats_.connections.fetch_add(1, std::memory_order_relaxed);
  self.stream_ = std::make_unique<MessageStream>(self.connection_, self.stats_, self.callbacks_,
                                                 steady_now_ns);
  // TLS ends at the gateway, and a page does not know the binding of its connection.
  self.callbacks_.on_connected(self.connection_, std::nullopt);
  self.flush();
  return 0;
}

int WebLink::on_message(int /*type*/, const EmscriptenWebSocketMessageEvent* event, void* link) {
  auto& self = *static_cast<WebLink*>(link);
  if (event->socket != self.socket_ || !self.is_open_ || self.is_lost_) return 0;
  if (event->isText) {
    self.is_lost_ = true;
    self.lost_ = "bad bytes from the server: a text message";
    return 0;
  }
  self.stats_.bytes_received.fetch_add(event->numBytes, std::memory_order_relaxed);
  self.received_bytes_ += event->numBytes;
  self.received_.push_back({Bytes(event->data, event->data + event->numBytes), steady_now_us()});
  if (self.received_bytes_ > kReceivedBytesMax) {
    self.is_lost_ = true;
    self.lost_ = "this browser handles the messages of the server too slowly";
  }
  return 0;
}

int WebLink::on_close(int /*type*/, const EmscriptenWebSocketCloseEvent* event, void* link) {
  auto& self = *static_cast<WebLink*>(link);
  if (event->socket != self.socket_ || self.is_lost_) return 0;
  self.is_lost_ = true;
  self.lost_ = self.is_open_ ? words_of_close(*event) : "cannot connect: " + words_of_close(*event);
  return 0;
}

void WebLink::disconnect(std::string why) {
  if (socket_ != 0) {
    emscripten_websocket_close(socket_, kNormalClosure, "");
    emscripten_websocket_delete(socket_);
  }
  socket_ = 0;
  is_lost_ = false;
  received_.clear();
  received_bytes_ = 0;
  const bool was_open = std::exchange(is_open_, false);
  callbacks_.on_disconnected(was_open ? connection_ : 0, std::move(why));
  attempt_ = order_.next();
  connect_us_ = steady_now_us() + attempt_.pause_ms * 1'000;
}

void WebLink::read(TimeUs until_us) {
  for (bool is_first = true; !received_.empty() && (is_first || steady_now_us() < until_us);
       is_first = false) {
    const Received next = std::move(received_.front());
    received_.pop_front();
    received_bytes_ -= next.bytes.size();
    const auto fed = stream_->receive(next.bytes, next.at_us);
    if (!fed) return disconnect(std::string("bad bytes from the server: ") + fed.error().what);
  }
}

std::size_t WebLink::room() const {
  constexpr unsigned short kOpen = 1;  // of WebSocket.readyState
  unsigned short state = 0;
  unsigned long long buffered = 0;
  if (emscripten_websocket_get_ready_state(socket_, &state) != EMSCRIPTEN_RESULT_SUCCESS ||
      state != kOpen ||
      emscripten_websocket_get_buffered_amount(socket_, &buffered) != EMSCRIPTEN_RESULT_SUCCESS)
    return 0;
  return kBufferedBytesMax -
         static_cast<std::size_t>(std::min<unsigned long long>(buffered, kBufferedBytesMax));
}

void WebLink::flush() {
  const std::size_t bytes_max = is_open_ ? room() : 0;
  if (bytes_max == 0) return;
  Bytes out;
  stream_->write(out, bytes_max);
  for (ByteView left(out); !left.empty();) {
    const std::size_t bytes = frame_bytes(left);
    emscripten_websocket_send_binary(socket_, const_cast<std::uint8_t*>(left.data()),
                                     static_cast<std::uint32_t>(bytes));
    left = left.subspan(bytes);
  }
  stats_.bytes_sent.fetch_add(out.size(), std::memory_order_relaxed);
}

void WebLink::step(TimeUs now_us) {
  if (is_lost_ && received_.empty()) return disconnect(std::move(lost_));
  if (socket_ == 0) {
    if (!is_stopped_ && now_us >= connect_us_) connect(now_us);
    return;
  }
  if (!is_open_) {
    if (now_us - connect_us_ > kConnectUsMax) disconnect("cannot connect: timed out");
    return;
  }
  static_cast<void>(stream_->acknowledge(now_us));
  flush();
  if (is_closing_ && !stream_->has_output()) disconnect("closed by this client");
}

void WebLink::set_servers(const Servers& list) {
  const bool is_encrypted = url_.starts_with("wss://");
  const std::string page_scheme = is_encrypted ? "https://" : "http://";
  std::vector<std::string> others;
  for (const ServerEntry& entry : others_of(list)) {
    if (entry.page.starts_with(page_scheme))
      others.push_back("ws" + web_socket_path(entry.page.substr(std::string("http").size())));
  }
  order_.set_others(std::move(others));
}

void WebLink::send(ConnectionNumber connection, const EncodedMessage& message) {
  if (!is_open_ || connection != connection_) return;
  if (!stream_->queue(message)) disconnect("send queue full");
}

void WebLink::close(ConnectionNumber connection) {
  if (connection == connection_) is_closing_ = true;
}

void WebLink::stop() {
  is_stopped_ = true;
  flush();
  if (socket_ == 0) return;
  emscripten_websocket_close(socket_, kNormalClosure, "");
  emscripten_websocket_delete(socket_);
  socket_ = 0;
  is_open_ = false;
}

}  // namespace runstone
