#include "bench/network/map_attacks.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bench/network/attack_thread.hpp"
#include "server/map/map_geometry.hpp"
#include "tests/support/net/web_peer.hpp"

namespace runstone::bench {
namespace {

/// Returns a request for a tile anywhere in the world, of any zoom.
std::string random_tile_request(SplitMix64& random) {
  const std::uint32_t zoom = random.below(kMapZoomMax + 1);
  const std::int32_t reach = kWorldLimit / (kMapTileSide << zoom);
  const std::int32_t x = random.between(-reach, reach - 1), z = random.between(-reach, reach - 1);
  return fmt::format("GET /map/tile/{}/{}/{}.png HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", zoom, x, z);
}

/// One stranger: a connection from an address of its own, on which one request waits.
class TileStranger {
 public:
  TileStranger(AttackThread& thread, unsigned number)
      : thread_(thread), from_(AttackThread::address(number)) {}

  /// Connects if there is no connection, and requests a tile. Does nothing if the thread may not
  /// connect now.
  void ask() {
    if (peer_ == nullptr || !peer_->is_open()) {
      if (!thread_.may_connect()) return;
      ++thread_.outcome.connections;
      const TlsContext* const tls = thread_.tls();
      peer_ = tls == nullptr
                  ? std::make_unique<test::WebPeer>(thread_.web_port(), from_)
                  : std::make_unique<test::WebPeer>(thread_.web_port(), from_, true, *tls);
    }
    const std::string request = random_tile_request(thread_.random());
    peer_->send(request);
    waits_ = peer_->is_open();
    if (waits_) thread_.outcome.bytes_sent += request.size();
  }
  /// Reads the answer that has come.
  void read() {
    const test::HttpReply reply = peer_->reply();
    ++thread_.outcome.endings[reply.status == 0 ? "closed without a word"
                                                : fmt::format("status {}", reply.status)];
    thread_.outcome.bytes_received += reply.head.size() + reply.body.size();
    waits_ = false;
  }
  bool waits() const { return waits_; }
  /// Requires waits().
  int socket() const { return peer_->native_handle(); }

 private:
  AttackThread& thread_;
  const std::uint32_t from_;
  std::unique_ptr<test::WebPeer> peer_;
  bool waits_ = false;
};

}  // namespace

void request_random_tiles(AttackThread& thread) {
  constexpr unsigned kStrangers = 8;
  constexpr int kWaitMs = 20;
  std::vector<TileStranger> strangers;
  for (unsigned i = 0; i < kStrangers; ++i)
    strangers.emplace_back(thread, thread.index() * kStrangers + i);
  while (!thread.is_over()) {
    std::array<pollfd, kStrangers> wanted{};
    for (unsigned i = 0; i < kStrangers; ++i) {
      if (!strangers[i].waits()) strangers[i].ask();
      wanted[i] = {strangers[i].waits() ? strangers[i].socket() : -1, POLLIN, 0};
    }
    (void)::poll(wanted.data(), wanted.size(), kWaitMs);
    for (unsigned i = 0; i < kStrangers; ++i) {
      if (wanted[i].revents != 0) strangers[i].read();
    }
  }
  for (const TileStranger& stranger : strangers) {
    if (stranger.waits()) ++thread.outcome.endings["still waits"];
  }
}

}  // namespace runstone::bench
