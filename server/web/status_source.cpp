#include "server/web/status_source.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <memory>

#include "common/os/steady_clock.hpp"
#include "server/web/web_log.hpp"

namespace runstone {
namespace {

namespace net = boost::asio;

constexpr TimeUs kStatusAgeUsMax = 1'000'000;
constexpr auto kAskTime = std::chrono::seconds(2);
constexpr std::size_t kStatusBytesMax = 1024 * 1024;

}  // namespace

StatusSource::StatusSource(net::io_context& io, std::string path)
    : io_(io), path_(std::move(path)), answered_(io) {
  answered_.expires_at(net::steady_timer::time_point::max());
}

net::awaitable<std::shared_ptr<const ServerStatus>> StatusSource::newest(TimeUs called_us) {
  while (newest_ == nullptr || asked_us_ + kStatusAgeUsMax < called_us) {
    if (is_asking_) {
      boost::system::error_code woken;
      co_await answered_.async_wait(net::redirect_error(net::use_awaitable, woken));
      continue;
    }
    is_asking_ = true;
    const TimeUs asked_us = steady_now_us();
    ServerStatus status = co_await ask();
    // For the host alone: the pages do not name paths and errors of this machine.
    if (!status.why.empty() && (newest_ == nullptr || newest_->why != status.why))
      log_web_line("cannot ask " + path_ + ": " + status.why);
    newest_ = std::make_shared<const ServerStatus>(std::move(status));
    asked_us_ = asked_us;
    is_asking_ = false;
    answered_.cancel();
  }
  co_return newest_;
}

net::awaitable<ServerStatus> StatusSource::ask() {
  const auto socket = std::make_shared<net::local::stream_protocol::socket>(io_);
  net::steady_timer deadline(io_, kAskTime);
  deadline.async_wait([socket](const boost::system::error_code& cancelled) {
    boost::system::error_code ignored;
    if (!cancelled) socket->close(ignored);
  });
  boost::system::error_code error;
  const net::local::stream_protocol::endpoint server(path_);
  co_await socket->async_connect(server, net::redirect_error(net::use_awaitable, error));
  const std::string question = "status\n";
  std::string answer;
  if (!error) {
    co_await net::async_write(*socket, net::buffer(question),
                              net::redirect_error(net::use_awaitable, error));
  }
  // The last line of an answer begins with "=", and no other one does.
  while (!error && answer.find("\n=") == std::string::npos) {
    const auto into = net::dynamic_buffer(answer, kStatusBytesMax);
    co_await net::async_read_until(*socket, into,
                                   "\n=", net::redirect_error(net::use_awaitable, error));
  }
  while (!error && answer.back() != '\n') {
    char more[64];
    const std::size_t got = co_await socket->async_read_some(
        net::buffer(more), net::redirect_error(net::use_awaitable, error));
    answer.append(more, got);
  }
  deadline.cancel();
  ServerStatus out;
  if (error) {
    out.why = error.message();
    co_return out;
  }
  auto parsed = parse_server_status(answer);
  if (parsed) co_return *std::move(parsed);
  out.why = parsed.error().what;
  co_return out;
}

}  // namespace runstone
