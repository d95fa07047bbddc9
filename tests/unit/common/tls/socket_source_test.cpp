#include "common/tls/socket_source.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>

#include "common/core/assert.hpp"

using namespace runstone;

namespace {

struct SocketPair {
  SocketPair() { RUNSTONE_ASSERT(::socketpair(AF_UNIX, SOCK_STREAM, 0, sockets.data()) == 0); }
  ~SocketPair() {
    ::close(sockets[0]);
    if (sockets[1] >= 0) ::close(sockets[1]);
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;
  void send(std::size_t bytes) const {
    const Bytes sent(bytes, 7);
    REQUIRE(::send(sockets[1], sent.data(), bytes, 0) == static_cast<ssize_t>(bytes));
  }
  void end() {
    ::close(sockets[1]);
    sockets[1] = -1;
  }
  std::array<int, 2> sockets{-1, -1};
};

}  // namespace

TEST_CASE("a source returns what has come, and never waits", "[tls]") {
  SocketPair pair;
  SocketSource source(pair.sockets[0]);
  std::array<std::uint8_t, 10> into{};
  CHECK(source.receive(into) == 0);
  CHECK_FALSE(source.is_at_end());
  pair.send(12);
  CHECK(source.receive(into) == 10);
  CHECK(source.receive(into) == 2);
  CHECK(source.take_count() == 12);
  CHECK(source.take_count() == 0);
  pair.end();
  CHECK(source.receive(into) == 0);
  CHECK(source.is_at_end());
}

TEST_CASE("a source returns no more than it is allowed to", "[tls]") {
  SocketPair pair;
  SocketSource source(pair.sockets[0]);
  std::array<std::uint8_t, 10> into{};
  pair.send(20);
  source.allow(15);
  CHECK(source.receive(into) == 10);
  CHECK_FALSE(source.is_used_up());
  CHECK(source.receive(into) == 5);
  CHECK(source.is_used_up());
  CHECK(source.receive(into) == 0);
  source.allow(15);
  CHECK(source.receive(into) == 5);
}

TEST_CASE("a source that holds bytes returns these alone until it is released", "[tls]") {
  SocketPair pair;
  SocketSource source(pair.sockets[0]);
  std::array<std::uint8_t, 10> into{};
  pair.send(12);
  source.hold(8);
  CHECK(source.receive(into) == 8);
  CHECK(source.receive(into) == 0);
  source.hold(3);
  source.release();
  CHECK(source.receive(std::span(into).first(2)) == 2);
  CHECK(source.receive(into) == 1);
  CHECK(source.receive(into) == 1);
  CHECK(source.take_count() == 12);
}
