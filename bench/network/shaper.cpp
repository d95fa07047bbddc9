#include "bench/network/shaper.hpp"

#include <algorithm>
#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <chrono>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include "bench/harness/clocks.hpp"
#include "common/core/assert.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

using asio::ip::tcp;
using test::LinkFate;
using test::LinkModel;
using test::TimeNs;

constexpr std::size_t kSegmentBytes = 1448;  // of a TCP packet of 1,500 bytes with timestamps
constexpr std::size_t kHeaderBytes = 52;
constexpr std::size_t kReadBytes = 11 * kSegmentBytes;
constexpr int kSocketBytes = 16 * 1024;  // the queue is the model's, not the kernel's
constexpr TimeNs kFullNs = 200'000;      // until the next look at a full queue

TimeNs now() { return static_cast<TimeNs>(now_ns()); }
std::chrono::steady_clock::time_point at(TimeNs ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(ns));
}

/// Both sockets of a connection, closed together.
struct Pair {
  Pair(asio::io_context& io, tcp::socket from_client)
      : client(std::move(from_client)), server(io) {}
  void close() {
    asio::error_code ignored;
    client.close(ignored);
    server.close(ignored);
  }
  tcp::socket client, server;
};

/// One direction of a connection. It lives until nothing waits for it.
class Pipe : public std::enable_shared_from_this<Pipe> {
 public:
  Pipe(std::shared_ptr<Pair> pair, tcp::socket& from, tcp::socket& to,
       const test::LinkProfile& profile, std::uint64_t seed)
      : pair_(std::move(pair)),
        from_(from),
        to_(to),
        model_(profile, seed),
        pause_(from.get_executor()),
        next_(from.get_executor()) {}

  void read() {
    const std::uint64_t room = room_now();
    if (room == 0) {
      pause_.expires_at(at(now() + kFullNs));
      pause_.async_wait([self = shared_from_this()](asio::error_code error) {
        if (!error) self->read();
      });
      return;
    }
    const std::size_t most = std::min<std::size_t>(buffer_.size(), room);
    from_.async_read_some(asio::buffer(buffer_.data(), most),
                          [self = shared_from_this()](asio::error_code error, std::size_t bytes) {
                            if (error) return self->end();
                            self->take(bytes);
                            self->read();
                          });
  }

 private:
  struct Piece {
    TimeNs due_ns = 0;
    std::vector<std::uint8_t> bytes;  // empty: the end of the stream
  };

  /// Returns the number of bytes that certainly have room.
  std::uint64_t room_now() const {
    const test::LinkProfile& profile = model_.profile();
    if (profile.bits_per_second == 0) return buffer_.size();
    const std::uint64_t taken = model_.queued_bytes(now()) + kSegmentBytes + 16 * kHeaderBytes;
    return taken < profile.queue_bytes() ? profile.queue_bytes() - taken : 0;
  }

  void take(std::size_t bytes) {
    const TimeNs now_ns = now();
    for (std::size_t at = 0; at < bytes; at += kSegmentBytes) {
      const std::size_t part = std::min(kSegmentBytes, bytes - at);
      const auto passage = model_.push(part + kHeaderBytes, now_ns);
      RUNSTONE_ASSERT(passage.fate != LinkFate::no_room);
      TimeNs due_ns = passage.due_ns;
      if (passage.fate == LinkFate::lost) due_ns += model_.profile().round_trip_ns;
      last_due_ns_ = std::max(last_due_ns_, due_ns);
      const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(at);
      pieces_.push_back({last_due_ns_, {from, from + static_cast<std::ptrdiff_t>(part)}});
    }
    send();
  }

  void end() {
    pieces_.push_back({std::max(last_due_ns_, now() + model_.profile().round_trip_ns / 2), {}});
    send();
  }

  void send() {
    if (sending_ || pieces_.empty()) return;
    sending_ = true;
    next_.expires_at(at(pieces_.front().due_ns));
    next_.async_wait([self = shared_from_this()](asio::error_code) { self->write_due(); });
  }

  void write_due() {
    out_.clear();
    bool ends = false;
    const TimeNs now_ns = now();
    while (!pieces_.empty() && pieces_.front().due_ns <= now_ns && !ends) {
      const Piece& piece = pieces_.front();
      out_.insert(out_.end(), piece.bytes.begin(), piece.bytes.end());
      ends = piece.bytes.empty();
      pieces_.pop_front();
    }
    asio::async_write(to_, asio::buffer(out_),
                      [self = shared_from_this(), ends](asio::error_code error, std::size_t) {
                        self->sending_ = false;
                        if (error) return self->pair_->close();
                        asio::error_code ignored;
                        if (ends) {
                          self->to_.shutdown(tcp::socket::shutdown_send, ignored);
                        } else {
                          self->send();
                        }
                      });
  }

  const std::shared_ptr<Pair> pair_;
  tcp::socket& from_;
  tcp::socket& to_;
  LinkModel model_;
  asio::steady_timer pause_, next_;
  std::array<std::uint8_t, kReadBytes> buffer_{};
  std::deque<Piece> pieces_;
  std::vector<std::uint8_t> out_;
  TimeNs last_due_ns_ = 0;
  bool sending_ = false;
};

}  // namespace

struct Shaper::Parts {
  Parts(const test::LinkProfile& link, std::uint64_t random_seed, std::uint16_t port)
      : profile(link), seed(random_seed), server(asio::ip::address_v4::loopback(), port) {}

  void accept() {
    acceptor.async_accept([this](asio::error_code error, tcp::socket client) {
      if (error) return;
      join(std::move(client));
      accept();
    });
  }

  void join(tcp::socket client) {
    auto pair = std::make_shared<Pair>(io, std::move(client));
    pair->server.open(tcp::v4());
    pair->server.set_option(tcp::socket::receive_buffer_size(kSocketBytes));
    pair->server.async_connect(server, [this, pair](asio::error_code error) {
      if (error) return pair->close();
      pair->client.set_option(tcp::no_delay(true), error);
      pair->server.set_option(tcp::no_delay(true), error);
      const auto up =
          std::make_shared<Pipe>(pair, pair->client, pair->server, profile, mix64(seed + joined++));
      const auto down =
          std::make_shared<Pipe>(pair, pair->server, pair->client, profile, mix64(seed + joined++));
      up->read();
      down->read();
    });
  }

  const test::LinkProfile profile;
  const std::uint64_t seed;
  const tcp::endpoint server;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  std::uint64_t joined = 0;
  std::thread thread;
};

Shaper::Shaper(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Shaper::~Shaper() {
  parts_->io.stop();
  parts_->thread.join();
}

Result<std::unique_ptr<Shaper>, std::string> Shaper::start(const test::LinkProfile& profile,
                                                           std::uint64_t seed,
                                                           std::uint16_t server_port) {
  auto parts = std::make_unique<Parts>(profile, seed, server_port);
  asio::error_code error;
  const auto then = [&error](auto&& step) {
    if (!error) step();
  };
  tcp::acceptor& acceptor = parts->acceptor;
  then([&] { acceptor.open(tcp::v4(), error); });
  then([&] { acceptor.set_option(tcp::socket::receive_buffer_size(kSocketBytes), error); });
  then([&] { acceptor.bind({asio::ip::address_v4::loopback(), 0}, error); });
  then([&] { acceptor.listen(asio::socket_base::max_listen_connections, error); });
  if (error) return failure("cannot listen on loopback: " + error.message());
  parts->accept();
  parts->thread = std::thread([it = parts.get()] { it->io.run(); });
  return std::unique_ptr<Shaper>(new Shaper(std::move(parts)));
}

std::uint16_t Shaper::port() const { return parts_->acceptor.local_endpoint().port(); }

}  // namespace runstone::bench
