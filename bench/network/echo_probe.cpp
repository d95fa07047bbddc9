#include "bench/network/echo_probe.hpp"

#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/read.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <chrono>
#include <deque>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

namespace runstone::bench {
namespace {

using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Message = std::array<std::uint8_t, EchoProbe::kMessageBytes>;

/// Sends every received message back.
class Answerer {
 public:
  Answerer(TestbedLink& link, asio::error_code& error) {
    link.server_side().run([&] { acceptor_.open(tcp::v4(), error); });
    if (!error) acceptor_.bind({asio::ip::make_address(link.server_address()), 0}, error);
    if (!error) acceptor_.listen(1, error);
    if (error) return;
    acceptor_.async_accept([this](asio::error_code wrong, tcp::socket socket) {
      if (wrong) return;
      socket_ = std::move(socket);
      socket_.set_option(tcp::no_delay(true), wrong);
      read();
    });
    thread_ = std::thread([this] { io_.run(); });
  }
  ~Answerer() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }
  Answerer(const Answerer&) = delete;
  Answerer& operator=(const Answerer&) = delete;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void read() {
    asio::async_read(socket_, asio::buffer(message_), [this](asio::error_code error, std::size_t) {
      if (error) return;
      asio::async_write(socket_, asio::buffer(message_),
                        [this](asio::error_code wrong, std::size_t) {
                          if (!wrong) read();
                        });
    });
  }

  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  tcp::socket socket_{io_};
  Message message_{};
  std::thread thread_;
};

}  // namespace

struct EchoProbe::Parts {
  Parts(TestbedLink& link, double rate, asio::error_code& error)
      : server(link, error), interval(std::chrono::duration<double>(1 / rate)) {}

  void begin() {
    began = Clock::now();
    read();
    send();
    thread = std::thread([this] { io.run(); });
  }
  void send() {
    if (over) return;
    const auto due =
        began + std::chrono::duration_cast<Clock::duration>(interval * static_cast<double>(sent));
    timer.expires_at(due);
    timer.async_wait([this, due](asio::error_code error) {
      if (error || over) return;
      ++sent;
      under_way.push_back(due);
      out.push_back(Message{});
      if (out.size() == 1) write();
      send();
    });
  }
  void write() {
    asio::async_write(socket, asio::buffer(out.front()),
                      [this](asio::error_code error, std::size_t) {
                        if (error) return;
                        out.pop_front();
                        if (!out.empty()) write();
                      });
  }
  void read() {
    asio::async_read(socket, asio::buffer(in), [this](asio::error_code error, std::size_t) {
      if (error) return;
      back_ms.push_back(
          std::chrono::duration<double, std::milli>(Clock::now() - under_way.front()).count());
      under_way.pop_front();
      read();
    });
  }

  Answerer server;
  const std::chrono::duration<double> interval;
  asio::io_context io{1};
  tcp::socket socket{io};
  asio::steady_timer timer{io};
  // The thread uses these members until it ends.
  Clock::time_point began;
  std::uint64_t sent = 0;
  std::deque<Clock::time_point> under_way;
  std::deque<Message> out;
  Message in{};
  std::vector<double> back_ms;
  bool over = false;
  std::thread thread;
};

EchoProbe::EchoProbe(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
EchoProbe::~EchoProbe() {
  if (parts_->thread.joinable()) stop();
}

Result<std::unique_ptr<EchoProbe>, std::string> EchoProbe::start(TestbedLink& link, double rate) {
  asio::error_code error;
  auto parts = std::make_unique<Parts>(link, rate, error);
  if (error) return failure("the echo cannot listen: " + error.message());
  const auto port = link.entrance(parts->server.port());
  if (!port) return failure(port.error());
  link.client_side().run([&] { parts->socket.open(tcp::v4(), error); });
  if (!error) parts->socket.connect({asio::ip::make_address(link.server_address()), *port}, error);
  if (!error) parts->socket.set_option(tcp::no_delay(true), error);
  if (error) return failure("the echo cannot connect: " + error.message());
  parts->begin();
  return std::unique_ptr<EchoProbe>(new EchoProbe(std::move(parts)));
}

std::vector<double> EchoProbe::stop() {
  asio::post(parts_->io, [it = parts_.get()] {
    it->over = true;
    it->timer.expires_after(std::chrono::seconds(1));
    it->timer.async_wait([it](asio::error_code) { it->io.stop(); });
  });
  parts_->thread.join();
  std::vector<double> out = std::move(parts_->back_ms);
  out.insert(out.end(), parts_->under_way.size(), std::numeric_limits<double>::infinity());
  return out;
}

}  // namespace runstone::bench
