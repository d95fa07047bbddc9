#include "server/web/web_connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>
#include <vector>

#include "common/os/process_memory.hpp"
#include "server/web/operator_gate.hpp"
#include "server/web/page_form.hpp"
#include "server/web/page_link.hpp"
#include "server/web/web_log.hpp"

namespace runstone {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t kRequestHeaderBytesMax = 8 * 1024;
constexpr std::uint64_t kFinishSeconds = 2;
// Bytes that are read and dropped after the last request.
constexpr std::size_t kDroppedBytesMax = 64 * 1024;
// Bytes that may wait in the kernel, so that little terrain is ahead of an edit.
constexpr int kNotSentBytes = 16 * 1024;

// A browser that reads more slowly is not waited for.
constexpr std::size_t kSlowestBytesPerSecond = 8 * 1024;

const char* cache_control(HttpCaching caching) {
  switch (caching) {
    case HttpCaching::an_hour:
      return "max-age=3600";
    case HttpCaching::while_unchanged:
      return "no-cache";
    case HttpCaching::none:
      break;
  }
  return "no-store";
}

std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

HttpRequest asked_by(const WebSocketSession::Request& request, std::string_view target) {
  return {view_of(request.method_string()), target, view_of(request[http::field::accept_encoding]),
          view_of(request[http::field::if_none_match])};
}

/// Brings the counters up to date that are measured for a page.
void measure(WebState& state) {
  state.counters.memory_bytes = process_memory_bytes();
  state.counters.log_lines_dropped = dropped_web_lines();
  state.counters.map_cache_bytes = 0;
  for (const auto& world : state.worlds) state.counters.map_cache_bytes += world->map.cache_bytes();
}

/// Returns true for a form of the operators' page. No other request has a body.
bool is_form_of_operators(const WebState& state, const WebSocketSession::Request& request) {
  const WebPlace place = place_of(state, view_of(request.target()));
  return state.config.operators_page && request.method() == http::verb::post &&
         place.world != nullptr && is_for_operators(path_of(place.target));
}

HttpAnswer answer_to_broken_request(const boost::system::error_code& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return plain_answer(431, "the headers of the request are too long");
  if (error == http::error::body_limit || error == http::error::unexpected_body)
    return plain_answer(413, "a request must not have a body");
  return plain_answer(400, "the request is not understood");
}

}  // namespace

WebConnection::WebConnection(WebState& state, std::uint64_t id, WebStream::Socket socket,
                             AddressBlock from)
    : state_(state),
      id_(id),
      from_(from),
      stream_(std::move(socket), state.certificate.context()),
      read_(2 * kRequestHeaderBytesMax) {
  state_.connections.emplace(id_, this);
  ++state_.counters.connections_open;
  boost::system::error_code ignored;
  stream_.next_layer().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  // If the call fails, edits wait longer behind terrain. Nothing else changes.
  (void)::setsockopt(stream_.next_layer().native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT,
                     &kNotSentBytes, sizeof kNotSentBytes);
}

WebConnection::~WebConnection() {
  state_.connections.erase(id_);
  state_.limits.remove(from_);
  --state_.counters.connections_open;
}

boost::asio::awaitable<void> WebConnection::run(std::shared_ptr<WebConnection> self) {
  self->stream_.allow_s(self->state_.config.handshake_s);
  const bool is_secure = co_await WebStream::handshake(self->stream_);
  if (!is_secure) co_return;
  const bool is_in_order = co_await serve(self);
  if (is_in_order) co_await finish(self);
  self->stream_.close();
}

boost::asio::awaitable<bool> WebConnection::serve(std::shared_ptr<WebConnection> self) {
  for (bool is_first = true;; is_first = false) {
    self->stream_.allow_s(self->state_.config.handshake_s);
    http::request_parser<http::empty_body> parser;
    parser.header_limit(kRequestHeaderBytesMax);
    parser.body_limit(kFormBytesMax);
    boost::system::error_code error;
    co_await http::async_read_header(
        self->stream_, self->read_, parser,
        boost::asio::redirect_error(boost::asio::use_awaitable, error));
    Request request;
    std::string form;  // the body
    if (!error && !parser.is_done() && is_form_of_operators(self->state_, parser.get())) {
      http::request_parser<http::string_body> whole(std::move(parser));
      co_await http::async_read(self->stream_, self->read_, whole,
                                boost::asio::redirect_error(boost::asio::use_awaitable, error));
      auto message = whole.release();
      form = std::move(message.body());
      request = Request(std::move(message.base()));
    } else if (!error && !parser.is_done()) {
      error = http::error::unexpected_body;
    } else if (!error) {
      request = parser.release();
    }
    if (error == http::error::end_of_stream) co_return true;
    const bool is_readable = !error;
    if (!is_readable && error.category() != make_error_code(http::error::bad_method).category())
      co_return false;  // the connection failed
    ++self->state_.counters.requests;
    if (!is_readable) {
      const HttpAnswer broken = answer_to_broken_request(error);
      const Request none;
      co_return co_await write(self, broken, none, false);
    }
    const WebPlace place = place_of(self->state_, view_of(request.target()));
    const bool is_for_map = place.world != nullptr && place.target.starts_with(kMapDataPath);
    const bool may_ask = is_for_map
                             ? place.world->map.ask(self->from_, steady_now_us())
                             : is_first || self->state_.limits.ask(self->from_, steady_now_us());
    if (!may_ask) {
      const HttpAnswer later = plain_answer(429, "too many requests from this address: ask later");
      co_return co_await write(self, later, request, false);
    }
    if (boost::beast::websocket::is_upgrade(request)) {
      const std::optional<HttpAnswer> refusal = self->refusal_of(request, place);
      if (refusal) co_return co_await write(self, *refusal, request, false);
      --self->state_.counters.requests;
      self->websocket_ = std::make_shared<WebSocketSession>(
          self->state_, self->stream_, self->from_, place.world->config.gateway_socket);
      co_await WebSocketSession::run(self->websocket_, std::move(request));
      co_return false;
    }
    HttpAnswer answer;
    if (place.world != nullptr && is_for_operators(path_of(place.target))) {
      // A page asks the server three times at most.
      self->stream_.allow_s(self->state_.config.handshake_s + 3 * kPageAnswerSeconds + 2);
      OperatorRequest asked = operator_request(*self, request, place, std::move(form));
      answer = co_await answer_operator(self->state_, *place.world, std::move(asked));
    } else {
      answer = co_await answer_to(self, request, place);
    }
    const bool keeps_alive = request.keep_alive();
    const bool is_written = co_await write(self, answer, request, keeps_alive);
    if (!is_written || !keeps_alive) co_return is_written;
  }
}

std::optional<HttpAnswer> WebConnection::refusal_of(const Request& request, WebPlace place) const {
  if (place.world == nullptr || path_of(place.target) != kPlayPath)
    return plain_answer(404, "there is no WebSocket at this address");
  const auto origin = request.find(http::field::origin);
  const bool has_origin = origin != request.end();
  const bool is_allowed =
      state_.origin.allows(has_origin ? std::optional(view_of(origin->value())) : std::nullopt,
                           view_of(request[http::field::host]));
  if (is_allowed && request.count(http::field::origin) <= 1) return std::nullopt;
  return plain_answer(403, "pages of this origin may not join this world");
}

OperatorRequest WebConnection::operator_request(const WebConnection& self, const Request& request,
                                                WebPlace place, std::string form) {
  const auto text = [&](http::field name) { return std::string(view_of(request[name])); };
  OperatorRequest out;
  out.from = self.from_;
  boost::system::error_code gone;
  out.port = self.stream_.next_layer().local_endpoint(gone).port();
  out.method = view_of(request.method_string());
  out.target = place.target;
  out.body = std::move(form);
  out.host = text(http::field::host);
  out.cookie = text(http::field::cookie);
  out.content_type = text(http::field::content_type);
  out.fetch_site = view_of(request["Sec-Fetch-Site"]);
  if (request.count(http::field::origin) == 1) out.origin = text(http::field::origin);
  return out;
}

boost::asio::awaitable<HttpAnswer> WebConnection::answer_to(std::shared_ptr<WebConnection> self,
                                                            const Request& request,
                                                            WebPlace place) {
  static const auto kNoStatus = std::make_shared<const ServerStatus>();
  if (place.world == nullptr) {
    HttpAnswer out = co_await answer_of_gateway(self, request);
    co_return out;
  }
  WebWorld& world = *place.world;
  const std::string_view path = path_of(place.target);
  const bool is_read = request.method() == http::verb::get || request.method() == http::verb::head;
  const bool is_for_map = is_read && path.starts_with(kMapDataPath);
  if (is_for_map) {
    // An answer of the map comes after at most this time.
    constexpr auto kMapSeconds = static_cast<std::uint64_t>(MapService::kAnswerUsMax / 1'000'000);
    self->stream_.allow_s(self->state_.config.handshake_s + kMapSeconds + 2);
  }
  const bool is_of_status = path == kMapPlayersPath || path == kMapBorderPath;
  if (is_for_map && is_of_status) {
    MapAnswer allowed = co_await world.map.answer(self->from_, kMapRightsPath, std::string());
    if (allowed.status != 200) {
      HttpAnswer out{allowed.status, std::move(allowed.type), ""};
      out.shared = std::move(allowed.body);
      co_return out;
    }
  }
  if (is_for_map && !is_of_status) {
    MapAnswer answer = co_await world.map.answer(
        self->from_, place.target, std::string(view_of(request[http::field::if_none_match])));
    HttpAnswer out{answer.status, std::move(answer.type), ""};
    out.tag = std::move(answer.etag);
    if (!out.tag.empty()) out.caching = HttpCaching::while_unchanged;
    out.shared = std::move(answer.body);
    co_return out;
  }
  std::shared_ptr<const ServerStatus> status = kNoStatus;
  std::string recent_edits;
  if (is_read && path == kStatusPath) {
    const std::shared_ptr<const std::string> recent = co_await world.recent_edits.newest();
    if (recent != nullptr) recent_edits = *recent;
  }
  if (shows_status(place.target)) {
    status = co_await world.status.newest(steady_now_us());
    measure(self->state_);
  }
  const PageContents contents{world.config,          self->state_.client, *status,
                              self->state_.counters, recent_edits,        world.name};
  co_return answer_request(asked_by(request, place.target), contents);
}

boost::asio::awaitable<HttpAnswer> WebConnection::answer_of_gateway(
    std::shared_ptr<WebConnection> self, const Request& request) {
  WebState& state = self->state_;
  std::vector<WorldStatus> worlds;
  if (shows_status(view_of(request.target()))) {
    // They are asked all at once, and an answer to this call counts although it is older than the next
    // one. So servers that do not answer delay the page for the time of one question.
    const TimeUs called_us = steady_now_us();
    for (const auto& world : state.worlds)
      boost::asio::co_spawn(state.io, world->status.newest(called_us), boost::asio::detached);
    for (const auto& world : state.worlds) {
      const std::shared_ptr<const ServerStatus> status = co_await world->status.newest(called_us);
      worlds.push_back({world->name, world->config.title, status});
    }
    measure(state);
  } else {
    for (const auto& world : state.worlds)
      worlds.push_back({world->name, world->config.title, nullptr});
  }
  co_return answer_gateway_request(asked_by(request, view_of(request.target())),
                                   {state.config, worlds, state.counters});
}

boost::asio::awaitable<bool> WebConnection::write(std::shared_ptr<WebConnection> self,
                                                  const HttpAnswer& answer, const Request& request,
                                                  bool keeps_alive) {
  const std::string_view bytes = answer.bytes();
  self->stream_.allow_s(self->state_.config.handshake_s + bytes.size() / kSlowestBytesPerSecond);
  http::response<http::span_body<const char>> response;
  response.result(answer.status);
  response.version(request.version());
  response.set(http::field::content_type, answer.type);
  response.set(http::field::cache_control, cache_control(answer.caching));
  if (answer.scripts == PageScripts::client) response.set(http::field::vary, "Accept-Encoding");
  if (answer.status == 429 || answer.status == 503) response.set(http::field::retry_after, "1");
  if (!answer.tag.empty()) response.set(http::field::etag, answer.tag);
  if (!answer.encoding.empty()) response.set(http::field::content_encoding, answer.encoding);
  if (!answer.cookie.empty()) response.set(http::field::set_cookie, answer.cookie);
  if (!answer.location.empty()) response.set(http::field::location, answer.location);
  if (!answer.allow.empty()) response.set(http::field::allow, answer.allow);
  if (answer.status == 426) response.set(http::field::upgrade, "websocket");
  const auto safety = safety_headers(answer.scripts, self->state_.origin.sockets());
  for (const auto& [name, value] : safety) response.set(name, value);
  if (answer.status != 304) response.content_length(bytes.size());
  response.keep_alive(keeps_alive);
  if (request.method() != http::verb::head) response.body() = {bytes.data(), bytes.size()};
  boost::system::error_code error;
  co_await http::async_write(self->stream_, response,
                             boost::asio::redirect_error(boost::asio::use_awaitable, error));
  co_return !error;
}

boost::asio::awaitable<void> WebConnection::finish(std::shared_ptr<WebConnection> self) {
  self->stream_.allow_s(kFinishSeconds);
  boost::system::error_code error;
  self->stream_.end_sending();
  std::size_t dropped = 0;
  while (!error && dropped < kDroppedBytesMax) {
    self->read_.clear();
    const auto room = self->read_.prepare(kRequestHeaderBytesMax);
    dropped += co_await self->stream_.async_read_some(
        room, boost::asio::redirect_error(boost::asio::use_awaitable, error));
  }
}

std::string WebConnection::address() const {
  boost::system::error_code gone;
  const auto end = stream_.next_layer().remote_endpoint(gone);
  return gone ? "an unknown address" : end.address().to_string();
}

void WebConnection::end_because_of_stop() {
  if (!websocket_ || !websocket_->is_open()) return close();
  websocket_->end(WebSocketSession::CloseCode::going_away, "the gateway stops");
}

}  // namespace runstone
