#include "server/world/people/joining.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/handshake.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;
using Bench = WorldBench;

TEST_CASE("hello is answered by a signed welcome, and the client's signature opens the session",
          "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  const Hello hello = bench.hello(1);
  bench.server.received(1, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(1, 0).at(0);
  CHECK(welcome.epoch == 1);
  CHECK(welcome.chunk_edge == kEdge);
  CHECK(welcome.materials == config().materials);
  CHECK(welcome.challenge[0] == 9);
  CHECK(welcome.encoding == ChunkEncoding::packed);
  CHECK(bench.environment.encodings.at(1).chunks == ChunkEncoding::packed);
  CHECK(verify(welcome.server_key, server_transcript(hello, welcome, std::nullopt),
               welcome.signature));
  CHECK(bench.environment.messages<SessionAccepted>(1, kEdge).empty());

  bench.server.received(1, bench.client_auth(1, hello, welcome), bench.now());
  const auto accepted = bench.environment.messages<SessionAccepted>(1, kEdge);
  REQUIRE(accepted.size() == 1);
  CHECK(accepted[0].author == 1);
  CHECK(accepted[0].resolved == 0);
  bench.tick();
  const auto lists = bench.environment.messages<PlayerList>(1, kEdge);
  REQUIRE(lists.size() == 1);
  CHECK(lists[0].players.at(0).name == "player1");
}

TEST_CASE("the operator learns of each player who comes and leaves, and of no other connection",
          "[world]") {
  Bench bench;
  bench.server.connected(9, bench.now());  // it never authenticates
  bench.join(1, 1);
  bench.join(2, 2);
  REQUIRE(bench.environment.came.size() == 2);
  CHECK(bench.environment.came[1].session == 2);
  CHECK(bench.environment.came[1].author == 2);
  CHECK(bench.environment.came[1].name == "player2");
  CHECK(bench.environment.came[1].key == bench.hello(2).key);
  CHECK(bench.environment.came[1].players == 2);
  CHECK(bench.environment.left.empty());

  bench.server.disconnected(1);
  bench.server.disconnected(1);
  bench.server.disconnected(9);
  REQUIRE(bench.environment.left.size() == 1);
  CHECK(bench.environment.left[0].name == "player1");
  CHECK(bench.environment.left[0].players == 1);
  bench.server.received(2, Goodbye{GoodbyeReason::closing, "bye"}, bench.now());
  bench.server.disconnected(2);
  REQUIRE(bench.environment.left.size() == 2);
  CHECK(bench.environment.left[1].players == 0);
}

TEST_CASE("a client that reads only raw chunks gets raw chunks", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  Hello hello = bench.hello(1);
  hello.encodings = 1;
  bench.server.received(1, hello, bench.now());
  CHECK(bench.environment.messages<Welcome>(1, 0).at(0).encoding == ChunkEncoding::raw);
}

namespace {

/// The encodings of a session after a Hello that offered some, with a host's preferred one.
SessionEncodings agreed_encodings(ChunkEncoding preferred, std::uint8_t offered) {
  WorldConfig wanted = config();
  wanted.preferred_encoding = preferred;
  Bench bench(wanted);
  bench.server.connected(1, bench.now());
  Hello hello = bench.hello(1);
  hello.encodings = offered;
  bench.server.received(1, hello, bench.now());
  const SessionEncodings agreed = bench.environment.encodings.at(1);
  CHECK(agreed.chunks == bench.environment.messages<Welcome>(1, 0).at(0).encoding);
  return agreed;
}

}  // namespace

TEST_CASE("a client gets coded chunks if it reads nothing else or the server prefers them",
          "[world]") {
  const auto chosen = [](ChunkEncoding preferred, std::uint8_t offered) {
    return agreed_encodings(preferred, offered).of({0, {1, 2, 3}});
  };
  CHECK(chosen(ChunkEncoding::packed, 4) == ChunkEncoding::coded);
  CHECK(chosen(ChunkEncoding::coded, 7) == ChunkEncoding::coded);
  CHECK(chosen(ChunkEncoding::coded, 3) == ChunkEncoding::packed);
  CHECK(chosen(ChunkEncoding::raw, 6) == ChunkEncoding::packed);
}

TEST_CASE("tiles are coded if the client reads that, unless the host chose another encoding",
          "[world]") {
  const auto chosen = [](ChunkEncoding preferred, std::uint8_t offered) {
    return agreed_encodings(preferred, offered).of({1, {1, 2, 3}});
  };
  CHECK(chosen(ChunkEncoding::packed, 7) == ChunkEncoding::coded);
  CHECK(chosen(ChunkEncoding::packed, 3) == ChunkEncoding::packed);
  CHECK(chosen(ChunkEncoding::packed, 1) == ChunkEncoding::raw);
  CHECK(chosen(ChunkEncoding::raw, 7) == ChunkEncoding::raw);
  CHECK(chosen(ChunkEncoding::coded, 7) == ChunkEncoding::coded);
}

TEST_CASE("a message at the wrong stage closes the session with its reason", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  const Hello hello = bench.hello(1);
  const auto closes = [&](Message message, GoodbyeReason reason) {
    bench.server.received(1, std::move(message), bench.now());
    REQUIRE(bench.environment.closed.size() == 1);
    CHECK(bench.environment.closed[0].session == 1);
    CHECK(bench.environment.closed[0].reason == reason);
    CHECK(bench.server.session_count() == 0);
    bench.server.received(1, hello, bench.now());  // messages of a closed session are ignored
    bench.server.disconnected(1);
    CHECK(bench.environment.closed.size() == 1);
  };
  SECTION("view before hello") { closes(View{}, GoodbyeReason::not_authenticated); }
  SECTION("edit before hello") {
    closes(EditRequest{1, 0, {kAtOrigin, {}, 1}}, GoodbyeReason::not_authenticated);
  }
  SECTION("chunk request before hello") {
    closes(ChunkRequest{}, GoodbyeReason::not_authenticated);
  }
  SECTION("move before hello") { closes(Move{}, GoodbyeReason::not_authenticated); }
  SECTION("ping before hello") { closes(Ping{}, GoodbyeReason::not_authenticated); }
  SECTION("client auth before hello") { closes(ClientAuth{}, GoodbyeReason::unexpected_message); }
  SECTION("a server's message") { closes(Pong{}, GoodbyeReason::unexpected_message); }
  SECTION("another protocol") {
    Hello other = hello;
    other.protocol = 7;
    closes(other, GoodbyeReason::wrong_protocol);
    CHECK(bench.environment.closed[0].text.find("7") != std::string::npos);
    CHECK(bench.environment.closed[0].text.find(std::to_string(kProtocolVersion)) !=
          std::string::npos);
  }
  SECTION("goodbye") { closes(Goodbye{}, GoodbyeReason::closing); }
  SECTION("after hello") {
    bench.server.received(1, hello, bench.now());
    const Welcome welcome = bench.environment.messages<Welcome>(1, 0).at(0);
    SECTION("hello again") { closes(hello, GoodbyeReason::unexpected_message); }
    SECTION("an edit") {
      closes(EditRequest{1, 0, {kAtOrigin, {}, 1}}, GoodbyeReason::not_authenticated);
    }
    SECTION("a signature by another key") {
      closes(bench.client_auth(2, hello, welcome), GoodbyeReason::not_authenticated);
    }
    SECTION("a signature of another transcript") {
      Welcome other = welcome;
      other.challenge[0] ^= 1;
      closes(bench.client_auth(1, hello, other), GoodbyeReason::not_authenticated);
    }
    SECTION("the server's signature") {
      closes(
          ClientAuth{sign(key_pair_of(seed_of(1)), server_transcript(hello, welcome, std::nullopt)),
                     {}},
          GoodbyeReason::not_authenticated);
    }
    SECTION("after client auth") {
      bench.server.received(1, bench.client_auth(1, hello, welcome), bench.now());
      SECTION("hello again") { closes(hello, GoodbyeReason::unexpected_message); }
      SECTION("client auth again") {
        closes(bench.client_auth(1, hello, welcome), GoodbyeReason::unexpected_message);
      }
      SECTION("a server's message") { closes(Durable{1, 1}, GoodbyeReason::unexpected_message); }
    }
  }
}

TEST_CASE("a session without messages is closed: soon during the handshake, late afterwards",
          "[world]") {
  WorldConfig c = config();
  c.handshake_us_max = 10'000'000;
  c.idle_us_max = 60'000'000;
  Bench bench(c);
  bench.join(1, 1);
  bench.server.connected(2, bench.now());
  bench.tick(9'999'999);
  CHECK(bench.environment.closed.empty());
  bench.tick(1);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 2);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::timed_out);
  bench.server.received(1, Ping{5}, bench.now());
  bench.tick(59'999'999);
  CHECK(bench.environment.closed.size() == 1);
  bench.tick(1);
  CHECK(bench.environment.closed.size() == 2);
}

TEST_CASE("a session beyond the server's limit is closed", "[world]") {
  WorldConfig c = config();
  c.sessions_max = 2;
  Bench bench(c);
  bench.join(1, 1);
  bench.join(2, 2);
  bench.server.connected(3, bench.now());
  bench.server.received(3, bench.hello(3), bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::server_full);
  bench.server.disconnected(1);
  bench.join(4, 4);
}

TEST_CASE("silent sockets keep no player out", "[world]") {
  WorldConfig c = config();
  c.sessions_max = 2;
  Bench bench(c);
  for (SessionId silent = 10; silent < 20; ++silent) bench.server.connected(silent, bench.now());
  bench.join(1, 1);
  bench.join(2, 2);
  CHECK(bench.environment.closed.empty());
}

TEST_CASE("the same key and instance again closes the older session, and another instance does not",
          "[world]") {
  Bench bench;
  const SessionAccepted first = bench.join(1, 1, 50);
  const SessionAccepted other = bench.join(2, 1, 51);
  CHECK(other.author == first.author);
  CHECK(bench.environment.closed.empty());
  bench.join(3, 1, 50);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::already_connected);
  CHECK(bench.server.session_count() == 2);
}

TEST_CASE("session accepted has the watermark of the store, of edits and of rejections",
          "[world]") {
  WorldStart start;
  start.log = {4, 20, 0};
  start.checkpoint = 20;
  start.players.push_back({6, key_pair_of(seed_of(1)).public_key, "old name"});
  start.resolved.push_back({6, 1, 12});
  Bench bench(config(), start);
  CHECK(bench.join(1, 1).author == 6);
  CHECK(bench.environment.messages<SessionAccepted>(1, kEdge)[0].resolved == 12);
  bench.edit(1, 13, kAtOrigin);
  bench.edit(1, 14, kAtOrigin, 99);
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 21);
  CHECK(bench.join(2, 1).resolved == 14);
  CHECK(bench.join(3, 2).author == 7);
  REQUIRE(bench.environment.players.size() ==
          1);  // author 7 has not edited, author 6 has a new name
  CHECK(bench.environment.players[0].author == 6);
}

TEST_CASE("a client that cannot take its welcome is closed", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  bench.environment.full.insert(1);
  bench.server.received(1, bench.hello(1), bench.now());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::timed_out);
}

TEST_CASE("features that both sides know are in force, and others are ignored", "[world]") {
  WorldConfig c = config();
  c.features = 0b0110;
  Bench bench(c);
  bench.server.connected(1, bench.now());
  Hello hello = bench.hello(1);
  hello.features = 1ULL << 63 | 0b1011;
  bench.server.received(1, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(1, 0).at(0);
  CHECK(welcome.features == 0b0010);
  bench.server.received(1, bench.client_auth(1, hello, welcome), bench.now());
  CHECK(bench.environment.messages<SessionAccepted>(1, kEdge).size() == 1);
}

}  // namespace
}  // namespace runstone
