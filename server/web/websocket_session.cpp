#include "server/web/websocket_session.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <string>

#include "protocol/codec/proxy_header.hpp"
#include "server/web/http_answer.hpp"
#include "server/web/link_error.hpp"

namespace runstone {
namespace {

namespace websocket = boost::beast::websocket;

// For the browser to answer the close frame.
constexpr std::uint64_t kCloseSeconds = 3;

PeerEndpoint peer_endpoint(const boost::asio::ip::tcp::endpoint& end) {
  if (end.address().is_v4()) return peer_endpoint_v4(end.address().to_v4().to_uint(), end.port());
  return {end.address().to_v6().to_bytes(), end.port()};
}

}  // namespace

WebSocketSession::WebSocketSession(WebState& state, WebStream& stream, AddressBlock from,
                                   const std::string& server)
    : state_(state),
      stream_(stream),
      from_(from),
      server_(server),
      websocket_(stream),
      link_(state.io.get_executor()),
      message_(kFrameBytesMax + 1),
      tasks_done_(state.io) {
  tasks_done_.expires_at(boost::asio::steady_timer::time_point::max());
  const std::chrono::seconds handshake(state.config.handshake_s), idle(state.config.idle_s);
  // Beast sends a ping after half of the idle time, and closes the socket after all of it.
  websocket_.set_option(websocket::stream_base::timeout{handshake, idle, true});
  websocket_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
    for (const auto& [name, value] : safety_headers(PageScripts::none, ""))
      response.set(name, value);
  }));
  websocket_.control_callback([this](websocket::frame_type kind, boost::beast::string_view) {
    if (kind != websocket::frame_type::close) on_control_frame();
  });
  websocket_.binary(true);
  websocket_.auto_fragment(false);
  // Messages above kFrameBytesMax are closed with words, see browser_to_server(). Beast closes what
  // no mistake of a client explains at once, by the length in its header, and without words.
  constexpr std::size_t kMessageBytesMax = std::size_t{16} << 20;
  websocket_.read_message_max(kMessageBytesMax);
}

boost::asio::awaitable<void> WebSocketSession::run(std::shared_ptr<WebSocketSession> self,
                                                   Request request) {
  const boost::system::error_code link_error = co_await open_link(self);
  boost::system::error_code error;
  co_await self->websocket_.async_accept(
      request, boost::asio::redirect_error(boost::asio::use_awaitable, error));
  if (error) co_return;
  self->is_open_ = true;
  self->stream_.forget_due();  // from here on Beast's times hold
  ++self->state_.counters.websockets;
  ++self->state_.counters.websockets_open;
  if (!link_error) {
    ++self->tasks_;
    self->read_link();
    co_await browser_to_server(self);
  } else {
    ++self->state_.counters.links_failed;
    const WebClose close = close_for_link_error(link_error);
    self->state_.link_line.print(steady_now_us(), "a WebSocket has no connection to " +
                                                      self->server_ + ": " + link_error.message() +
                                                      " (" + close.words + ")");
    self->end(close.code, close.words);
  }
  self->close_link();
  while (self->tasks_ > 0) {
    co_await self->tasks_done_.async_wait(
        boost::asio::redirect_error(boost::asio::use_awaitable, error));
  }
  --self->state_.counters.websockets_open;
}

void WebSocketSession::end(CloseCode code, const char* words) {
  if (std::exchange(is_ending_, true)) return;
  close_link();
  stream_.allow_s(kCloseSeconds);
  ++tasks_;
  boost::asio::co_spawn(state_.io, close_websocket(shared_from_this(), code, words),
                        boost::asio::detached);
}

boost::asio::awaitable<boost::system::error_code> WebSocketSession::open_link(
    std::shared_ptr<WebSocketSession> self) {
  boost::system::error_code error;
  const auto browser = self->stream_.next_layer().remote_endpoint(error);
  if (error) co_return error;
  const auto here = self->stream_.next_layer().local_endpoint(error);
  if (error) co_return error;
  const boost::asio::local::stream_protocol::endpoint server(self->server_);
  co_await self->link_.async_connect(
      server, boost::asio::redirect_error(boost::asio::use_awaitable, error));
  if (error) co_return error;
  const Bytes header = write_proxy_header(peer_endpoint(browser), peer_endpoint(here));
  co_await boost::asio::async_write(self->link_, boost::asio::buffer(header),
                                    boost::asio::redirect_error(boost::asio::use_awaitable, error));
  co_return error;
}

boost::asio::awaitable<void> WebSocketSession::browser_to_server(
    std::shared_ptr<WebSocketSession> self) {
  WebCounters& counters = self->state_.counters;
  while (!self->is_ending_) {
    boost::system::error_code error;
    std::size_t bytes = 0;
    do {
      const auto room = boost::asio::buffer(self->message_) + bytes;
      bytes += co_await self->websocket_.async_read_some(
          room, boost::asio::redirect_error(boost::asio::use_awaitable, error));
    } while (!error && !self->websocket_.is_message_done() && bytes <= kFrameBytesMax);
    // Beast has ended the WebSocket already.
    const bool is_fault = error == websocket::condition::protocol_violation ||
                          error == websocket::error::message_too_big;
    if (is_fault && !self->is_ending_) self->charge_fault();
    if (error || self->is_ending_) break;  // the browser has closed, or the close is under way
    if (!self->websocket_.got_binary()) {
      self->broke_rule(CloseCode::unknown_data, "only binary messages are read here");
      break;
    }
    const ByteView message = ByteView(self->message_).first(bytes);
    if (const char* fault = fault_of_web_message(message)) {
      self->broke_rule(bytes > kFrameBytesMax ? CloseCode::too_big : CloseCode::bad_payload, fault);
      break;
    }
    co_await boost::asio::async_write(
        self->link_, boost::asio::buffer(message.data(), message.size()),
        boost::asio::redirect_error(boost::asio::use_awaitable, error));
    // If the write failed, on_link() passes on what the server has said at last.
    if (error) continue;
    self->has_sent_ = true;
    ++counters.frames_in;
    counters.bytes_in += bytes;
  }
}

void WebSocketSession::read_link() {
  cutter_.drop_taken();
  const auto room = cutter_.room();
  link_.async_read_some(
      boost::asio::buffer(room.data(), room.size()),
      [self = shared_from_this()](const boost::system::error_code& error, std::size_t bytes) {
        self->on_link(error, bytes);
      });
}

void WebSocketSession::on_link(const boost::system::error_code& error, std::size_t bytes) {
  if (error || is_ending_) return on_link_end();
  cutter_.add(bytes);
  ByteView frames;
  std::uint64_t frame_count = 0;
  while (const auto frame = cutter_.next()) {
    frames = {frame_count == 0 ? frame->data() : frames.data(), frames.size() + frame->size()};
    ++frame_count;
  }
  if (frame_count == 0) return go_on();
  Bytes& message = state_.message;
  message.clear();
  append_web_header(message, frames.size());
  message.insert(message.end(), frames.begin(), frames.end());
  if (!stream_.write_now(message)) return on_link_end();
  has_answer_ = true;
  state_.counters.frames_out += frame_count;
  state_.counters.bytes_out += frames.size();
  if (!stream_.has_unsent()) return go_on();
  // A browser that does not take this within so long is closed, even if it sends.
  stream_.allow_s(state_.config.idle_s);
  wait_until_sent();
}

void WebSocketSession::wait_until_sent() {
  stream_.next_layer().async_wait(
      WebStream::Socket::wait_write,
      [self = shared_from_this()](const boost::system::error_code& error) {
        if (error || !self->stream_.send_now()) return self->on_link_end();
        if (self->stream_.has_unsent()) return self->wait_until_sent();
        if (!self->is_ending_) self->stream_.forget_due();
        self->go_on();
      });
}

void WebSocketSession::go_on() {
  if (cutter_.broken()) return on_link_end();
  read_link();
}

void WebSocketSession::on_link_end() {
  if (cutter_.broken() || !cutter_.is_between_frames()) {
    end(CloseCode::internal_error, "the server's stream is broken");
  } else if (cutter_.has_goodbye()) {
    end(CloseCode::normal, "the server has ended the session");
  } else if (has_answer_) {
    end(CloseCode::service_restart,
        "the server has ended without a goodbye, and may be restarting: try again soon");
  } else {
    end(CloseCode::try_again_later, "the server has not taken the connection: try again soon");
  }
  task_ended();
}

boost::asio::awaitable<void> WebSocketSession::close_websocket(
    std::shared_ptr<WebSocketSession> self, CloseCode code, const char* words) {
  boost::system::error_code error;
  const websocket::close_reason reason(code, words);
  co_await self->websocket_.async_close(
      reason, boost::asio::redirect_error(boost::asio::use_awaitable, error));
  self->stream_.close();  // a read of browser_to_server() ends
  self->task_ended();
}

void WebSocketSession::on_control_frame() {
  // A page cannot send pings, and answers those of the gateway, which sends one in idle_s / 2.
  constexpr std::uint64_t kControlFramesMax = 100;  // in ten seconds
  constexpr TimeUs kControlUs = 10'000'000;
  const TimeUs now_us = steady_now_us();
  if (now_us - control_since_us_ >= kControlUs) {
    control_since_us_ = now_us;
    control_frames_ = 0;
  }
  if (++control_frames_ == kControlFramesMax)
    broke_rule(CloseCode::policy_error, "a browser sends no pings");
}

void WebSocketSession::broke_rule(CloseCode code, const char* words) {
  if (is_ending_) return;
  charge_fault();
  end(code, words);
}

void WebSocketSession::charge_fault() {
  ++state_.counters.rules_broken;
  state_.limits.broke_rule(from_, steady_now_us());
}

void WebSocketSession::close_link() {
  boost::system::error_code ignored;
  link_.close(ignored);
}

void WebSocketSession::task_ended() {
  if (--tasks_ == 0) tasks_done_.cancel();
}

}  // namespace runstone
