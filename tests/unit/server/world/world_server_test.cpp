#include "server/world/world_server.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "protocol/codec/handshake.hpp"
#include "server/interest/view_cells.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;
using Bench = WorldBench;

TEST_CASE("hello is answered by a welcome that the server signed, and a proof opens the session",
          "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  const Hello hello = bench.hello(1);
  bench.server.received(1, hello, bench.now());
  const Welcome welcome = bench.ports.messages<Welcome>(1, 0).at(0);
  CHECK(welcome.epoch == 1);
  CHECK(welcome.chunk_edge == kEdge);
  CHECK(welcome.materials == config().materials);
  CHECK(welcome.challenge[0] == 9);
  CHECK(welcome.encoding == ChunkEncoding::packed);
  CHECK(bench.ports.encodings.at(1) == ChunkEncoding::packed);
  CHECK(verify(welcome.server_key, server_transcript(hello, welcome), welcome.signature));
  CHECK(bench.ports.messages<SessionAccepted>(1, kEdge).empty());

  bench.server.received(1, bench.proof(1, hello, welcome), bench.now());
  const auto ready = bench.ports.messages<SessionAccepted>(1, kEdge);
  REQUIRE(ready.size() == 1);
  CHECK(ready[0].author == 1);
  CHECK(ready[0].resolved == 0);
  bench.tick();
  const auto roster = bench.ports.messages<PlayerList>(1, kEdge);
  REQUIRE(roster.size() == 1);
  CHECK(roster[0].players.at(0).name == "player1");
}

TEST_CASE("a client that can read raw chunks only gets raw chunks", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  Hello hello = bench.hello(1);
  hello.encodings = 1;
  bench.server.received(1, hello, bench.now());
  CHECK(bench.ports.messages<Welcome>(1, 0).at(0).encoding == ChunkEncoding::raw);
}

TEST_CASE("a client gets coded chunks where it reads nothing else, or the server prefers them",
          "[world]") {
  const auto chosen = [](ChunkEncoding preferred, std::uint8_t offered) {
    WorldConfig wanted = config();
    wanted.preferred_encoding = preferred;
    Bench bench(wanted);
    bench.server.connected(1, bench.now());
    Hello hello = bench.hello(1);
    hello.encodings = offered;
    bench.server.received(1, hello, bench.now());
    return bench.ports.messages<Welcome>(1, 0).at(0).encoding;
  };
  CHECK(chosen(ChunkEncoding::packed, 4) == ChunkEncoding::coded);
  CHECK(chosen(ChunkEncoding::coded, 7) == ChunkEncoding::coded);
  CHECK(chosen(ChunkEncoding::coded, 3) == ChunkEncoding::packed);
  CHECK(chosen(ChunkEncoding::raw, 6) == ChunkEncoding::packed);
}

TEST_CASE("each message at the wrong moment closes the session with its reason", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  const Hello hello = bench.hello(1);
  const auto closes = [&](Message message, GoodbyeReason reason) {
    bench.server.received(1, std::move(message), bench.now());
    REQUIRE(bench.ports.closed.size() == 1);
    CHECK(bench.ports.closed[0].session == 1);
    CHECK(bench.ports.closed[0].reason == reason);
    CHECK(bench.server.session_count() == 0);
    bench.server.received(1, hello, bench.now());  // what still arrives is ignored
    bench.server.disconnected(1);
    CHECK(bench.ports.closed.size() == 1);
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
  SECTION("proof before hello") { closes(ClientAuth{}, GoodbyeReason::unexpected_message); }
  SECTION("a server's message") { closes(Pong{}, GoodbyeReason::unexpected_message); }
  SECTION("another protocol") {
    Hello other = hello;
    other.protocol = 7;
    closes(other, GoodbyeReason::wrong_protocol);
    CHECK(bench.ports.closed[0].text.find("7") != std::string::npos);
    CHECK(bench.ports.closed[0].text.find(std::to_string(kProtocolVersion)) != std::string::npos);
  }
  SECTION("goodbye") { closes(Goodbye{}, GoodbyeReason::closing); }
  SECTION("after hello") {
    bench.server.received(1, hello, bench.now());
    const Welcome welcome = bench.ports.messages<Welcome>(1, 0).at(0);
    SECTION("hello again") { closes(hello, GoodbyeReason::unexpected_message); }
    SECTION("an edit") {
      closes(EditRequest{1, 0, {kAtOrigin, {}, 1}}, GoodbyeReason::not_authenticated);
    }
    SECTION("a proof by another key") {
      closes(bench.proof(2, hello, welcome), GoodbyeReason::not_authenticated);
    }
    SECTION("a proof over other words") {
      Welcome other = welcome;
      other.challenge[0] ^= 1;
      closes(bench.proof(1, hello, other), GoodbyeReason::not_authenticated);
    }
    SECTION("a proof that the server made") {
      closes(ClientAuth{sign(key_pair_of(seed_of(1)), server_transcript(hello, welcome))},
             GoodbyeReason::not_authenticated);
    }
    SECTION("after proof") {
      bench.server.received(1, bench.proof(1, hello, welcome), bench.now());
      SECTION("hello again") { closes(hello, GoodbyeReason::unexpected_message); }
      SECTION("proof again") {
        closes(bench.proof(1, hello, welcome), GoodbyeReason::unexpected_message);
      }
      SECTION("a server's message") { closes(Durable{1, 1}, GoodbyeReason::unexpected_message); }
    }
  }
}

TEST_CASE("silence ends a session: soon during the handshake, late afterwards", "[world]") {
  WorldConfig c = config();
  c.handshake_us_max = 10'000'000;
  c.idle_us_max = 60'000'000;
  Bench bench(c);
  bench.join(1, 1);
  bench.server.connected(2, bench.now());
  bench.tick(9'999'999);
  CHECK(bench.ports.closed.empty());
  bench.tick(1);
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].session == 2);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::timed_out);
  bench.server.received(1, Ping{5}, bench.now());
  bench.tick(59'999'999);
  CHECK(bench.ports.closed.size() == 1);
  bench.tick(1);
  CHECK(bench.ports.closed.size() == 2);
}

TEST_CASE("one more session than the server holds is turned away", "[world]") {
  WorldConfig c = config();
  c.sessions_max = 2;
  Bench bench(c);
  bench.join(1, 1);
  bench.join(2, 2);
  bench.server.connected(3, bench.now());
  bench.server.received(3, bench.hello(3), bench.now());
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::server_full);
  bench.server.disconnected(1);
  bench.join(4, 4);
}

TEST_CASE("sockets that say nothing keep nobody out", "[world]") {
  WorldConfig c = config();
  c.sessions_max = 2;
  Bench bench(c);
  for (SessionId silent = 10; silent < 20; ++silent) bench.server.connected(silent, bench.now());
  bench.join(1, 1);
  bench.join(2, 2);
  CHECK(bench.ports.closed.empty());
}

TEST_CASE("the same key and instance again closes the older session; another instance does not",
          "[world]") {
  Bench bench;
  const SessionAccepted first = bench.join(1, 1, 50);
  const SessionAccepted other = bench.join(2, 1, 51);
  CHECK(other.author == first.author);
  CHECK(bench.ports.closed.empty());
  bench.join(3, 1, 50);
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].session == 1);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::already_connected);
  CHECK(bench.server.session_count() == 2);
}

TEST_CASE("a view brings its chunks, nearest first, each once", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, {{2, 0, 1}, 3, 1});
  std::set<ChunkKey> keys;
  std::int64_t last = 0;
  for (const auto& s : bench.ports.snapshots) {
    const std::int64_t distance = distance2({{2, 0, 1}, 3, 1}, s.key.at);
    CHECK(distance >= last);  // the fake port loads in order
    last = distance;
    CHECK(keys.insert(s.key).second);
  }
  CHECK(keys.size() == 29 * 3);
}

TEST_CASE("a view beyond the limit is cut to it", "[world]") {
  WorldConfig c = config();
  c.view_radius_max = 1;
  Bench bench(c);
  bench.join(1, 1);
  bench.view(1, {{0, 0, 0}, 60, 60});
  CHECK(bench.ports.snapshots.size() == 5 * 3);
}

TEST_CASE("no more loads wait for one session than allowed", "[world]") {
  WorldConfig c = config();
  c.loads_per_session_max = 4;
  Bench bench(c);
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 4, 4}, bench.now());
  CHECK(bench.ports.loads.size() == 4);
  const ChunkKey key = bench.ports.loads.front();
  bench.ports.loads.pop_front();
  bench.server.chunk_loaded(key, test::dotted_chunk(kEdge), bench.now());
  CHECK(bench.ports.loads.size() == 4);
  CHECK(bench.ports.snapshots.size() == 1);
}

TEST_CASE("an edit is committed to everyone who sees its chunk, and to its author", "[world]") {
  Bench bench;
  for (SessionId s = 1; s <= 4; ++s) bench.join(s, static_cast<std::uint8_t>(s));
  bench.view(1, kSmall);
  bench.view(2, kSmall);
  bench.view(3, {{50, 0, 0}, 1, 0});  // far away
  bench.edit(4, 1, kAtOrigin, 3);     // sees nothing at all
  CHECK(bench.commits(1).empty());
  const std::size_t before = bench.ports.sent.size();
  bench.server.commit(bench.now());
  for (const SessionId s : {1U, 2U, 4U}) {
    const auto commits = bench.commits(s);
    REQUIRE(commits.size() == 1);
    CHECK(commits[0].first == 1);
    CHECK(commits[0].edits.at(0).op == OperationId{4, 1, 1});
    CHECK(commits[0].edits[0].previous == std::vector<Sequence>{0});
  }
  CHECK(bench.commits(3).empty());
  // The same bytes for all.
  std::set<const Bytes*> bytes;
  for (std::size_t i = before; i < bench.ports.sent.size(); ++i) {
    const EncodedMessage& message = bench.ports.sent[i].message;
    if (message.frame_class == FrameClass::edits) bytes.insert(message.bytes.get());
  }
  CHECK(bytes.size() == 1);
  REQUIRE(bench.ports.records.size() == 1);
  CHECK(bench.ports.players.size() == 1);  // only who edits is written
  CHECK(bench.ports.players[0].author == 4);
}

TEST_CASE("what is queued together is one commit, and a late snapshot contains it", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.received(1, kSmall, bench.now());  // loads are asked for, not answered
  for (ClientSequence seq = 1; seq <= 10; ++seq) bench.edit(1, seq, kAtOrigin, 1 + seq % 4);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
  bench.answer_loads();
  for (const auto& s : bench.ports.snapshots) {
    if (s.key == ChunkKey{}) CHECK(s.chunk->version == Version{1, 10});
  }
  bench.edit(1, 11, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 2);
}

TEST_CASE("rejects name the client's sequence and the reason", "[world]") {
  WorldConfig c = config();
  c.reach_max = 50;
  Bench bench(c);
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin, 99);
  bench.edit(1, 2, SetVoxel{{100, 0, 0}});
  bench.edit(1, 3, kAtOrigin);
  bench.edit(1, 3, kAtOrigin);
  bench.ports.log_room = false;
  bench.edit(1, 4, kAtOrigin);
  const auto rejects = bench.ports.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 4);
  CHECK(rejects[0].reason == RejectReason::unknown_material);
  CHECK(rejects[1].reason == RejectReason::out_of_reach);
  CHECK(rejects[2].reason == RejectReason::already_resolved);
  CHECK(rejects[3].reason == RejectReason::busy);
  CHECK(rejects[3].client_seq == 4);
  bench.ports.log_room = true;
  bench.edit(1, 4, kAtOrigin);  // refused for good, and told so again
  bench.edit(1, 5, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.ports.records.size() == 2);
}

TEST_CASE("what became durable while a session opened is told to it, though the world rests",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  const Hello hello = bench.hello(2);
  bench.server.connected(2, bench.now());
  bench.server.received(2, hello, bench.now());
  const auto welcome = bench.ports.messages<Welcome>(2, 0);
  REQUIRE(welcome.size() == 1);
  CHECK(welcome[0].durable == 0);
  bench.server.durable(1, bench.now());
  bench.server.received(2, bench.proof(2, hello, welcome[0]), bench.now());
  bench.tick();
  const auto told = bench.ports.messages<Durable>(2, kEdge);
  REQUIRE(told.size() == 1);
  CHECK(told[0].seq == 1);
  bench.join(3, 3);  // whose welcome says it
  bench.tick();
  CHECK(bench.ports.messages<Durable>(3, kEdge).empty());
}

TEST_CASE("a session that edits too fast is told so, and goes on later", "[world]") {
  WorldConfig c = config();
  c.edits_per_second = 10;
  c.edit_burst = 2;
  Bench bench(c);
  bench.join(1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.edit(1, seq, kAtOrigin);
  const auto rejects = bench.ports.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].client_seq == 3);
  CHECK(rejects[0].reason == RejectReason::rate_limited);
  bench.tick(100'000);
  bench.edit(1, 4, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.server.head() == 3);
}

TEST_CASE("ready names what was decided: by the store, by edits and by rejects of this run",
          "[world]") {
  WorldStart start;
  start.log = {4, 20, 0};
  start.checkpoint = 20;
  start.players.push_back({6, key_pair_of(seed_of(1)).public_key, "old name"});
  start.resolved.push_back({6, 1, 12});
  Bench bench(config(), start);
  CHECK(bench.join(1, 1).author == 6);
  CHECK(bench.ports.messages<SessionAccepted>(1, kEdge)[0].resolved == 12);
  bench.edit(1, 13, kAtOrigin);
  bench.edit(1, 14, kAtOrigin, 99);
  bench.server.commit(bench.now());
  CHECK(bench.server.head() == 21);
  CHECK(bench.join(2, 1).resolved == 14);
  CHECK(bench.join(3, 2).author == 7);
  REQUIRE(bench.ports.players.size() == 1);  // author 7 has not edited, author 6 has a new name
  CHECK(bench.ports.players[0].author == 6);
}

TEST_CASE("a new name of a known author is handed to the store once, without an edit", "[world]") {
  WorldStart start;
  start.players.push_back({6, key_pair_of(seed_of(1)).public_key, "old name"});
  Bench bench(config(), start);
  SECTION("at once while the log has room") {
    bench.join(1, 1);
    REQUIRE(bench.ports.players.size() == 1);
    CHECK(bench.ports.records.empty());
    bench.join(2, 1, 2);  // the same name again
    bench.edit(1, 1, kAtOrigin);
    bench.server.commit(bench.now());
  }
  SECTION("with the author's next edit otherwise") {
    bench.ports.log_room = false;
    bench.join(1, 1);
    CHECK(bench.ports.players.empty());
    bench.ports.log_room = true;
    bench.edit(1, 1, kAtOrigin);
    bench.server.commit(bench.now());
  }
  REQUIRE(bench.ports.players.size() == 1);
  CHECK(bench.ports.players[0].author == 6);
  CHECK(bench.ports.players[0].key == key_pair_of(seed_of(1)).public_key);
  CHECK(bench.ports.players[0].name == "player1");
  CHECK(bench.ports.records.size() == 1);
}

TEST_CASE(
    "an author who never edited is forgotten with its last session, and its number stays unused",
    "[world]") {
  Bench bench;
  CHECK(bench.join(1, 1).author == 1);
  bench.edit(1, 7, SetVoxel{{1, 1, 1}}, 99);  // refused: no such material
  bench.server.disconnected(1);
  bench.tick();
  const SessionAccepted again = bench.join(2, 1);
  CHECK(again.author == 2);
  CHECK(again.resolved == 0);
  CHECK(bench.join(3, 1, 2).author == 2);  // another instance of the same key
  bench.server.disconnected(2);
  bench.tick();
  CHECK(bench.join(4, 1).author == 2);  // one session was left
  bench.edit(4, 1, kAtOrigin);
  bench.server.disconnected(4);  // before the edit is ordered
  bench.server.disconnected(3);
  bench.tick();
  REQUIRE(bench.ports.players.size() == 1);
  CHECK(bench.ports.players[0].author == 2);
  const SessionAccepted known = bench.join(5, 1);
  CHECK(known.author == 2);
  CHECK(known.resolved == 1);
  CHECK(bench.join(6, 6).author == 3);
}

TEST_CASE("the durable watermark goes to the authors of edits at once, and again if it did not fit",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.join(3, 3);
  bench.tick();  // everybody has heard what there is
  bench.edit(1, 1, kAtOrigin);
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.ports.full.insert(2);
  bench.server.durable(2, bench.now());
  bench.server.durable(2, bench.now());  // no news
  CHECK(bench.ports.messages<Durable>(1, kEdge).size() == 1);
  CHECK(bench.ports.messages<Durable>(2, kEdge).empty());
  bench.ports.full.clear();
  bench.tick();
  const auto later = bench.ports.messages<Durable>(2, kEdge);
  REQUIRE(later.size() == 1);
  CHECK(later[0].seq == 2);
  CHECK(later[0].epoch == 1);
  // Who has no edit under way hears it once a second.
  CHECK(bench.ports.messages<Durable>(3, kEdge).empty());
  bench.tick(1'000'000);
  bench.tick(1'000'000);
  CHECK(bench.ports.messages<Durable>(1, kEdge).size() == 1);
  CHECK(bench.ports.messages<Durable>(3, kEdge).size() == 1);
}

TEST_CASE(
    "an edit offered again is told to be durable at once, also in a session that opened since",
    "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.tick();
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.server.disconnected(1);
  bench.join(2, 1);
  bench.edit(2, 1, kAtOrigin);
  REQUIRE(bench.ports.messages<Reject>(2, kEdge).at(0).reason == RejectReason::already_resolved);
  bench.server.durable(1, bench.now());
  CHECK(bench.ports.messages<Durable>(2, kEdge).size() == 1);
}

TEST_CASE(
    "a full session loses commits, gets fresh snapshots later and an answer for its own edits",
    "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  CHECK(bench.ports.snapshots.size() == 5);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.ports.snapshot_room[1] = 0;
  bench.ports.refuse_edits.insert(1);
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).empty());
  CHECK(bench.server.counters().chunks_stale == 1);
  CHECK(bench.ports.messages<Reject>(1, kEdge)
            .empty());  // answers travel in order with commits: it is owed
  // While it is stale it gets no commits of that chunk, and no snapshot before there is room.
  bench.ports.refuse_edits.clear();
  bench.tick(0);
  const auto rejects = bench.ports.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].reason == RejectReason::already_resolved);
  bench.edit(1, 2, SetVoxel{{20, 1, 1}}, 2);  // the chunk to the east is still subscribed
  bench.server.commit(bench.now());
  CHECK(bench.commits(1).size() == 1);
  bench.tick(200'000);
  CHECK(bench.ports.snapshots.size() == 5);
  bench.ports.snapshot_room[1] = 100;
  bench.server.drained(1, bench.now());
  REQUIRE(bench.ports.snapshots.size() == 6);
  CHECK(bench.ports.snapshots[5].key == ChunkKey{});
  CHECK(bench.ports.snapshots[5].chunk->version == Version{1, 1});
}

TEST_CASE("answers that do not fit are owed in order, and too many of them close the session",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.ports.full.insert(1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.edit(1, seq, kAtOrigin, 99);
  CHECK(bench.ports.closed.empty());
  bench.ports.full.clear();
  bench.edit(1, 4, kAtOrigin, 99);
  bench.server.drained(1, bench.now());
  const auto rejects = bench.ports.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(rejects[i].client_seq == i + 1);
  bench.ports.full.insert(1);
  for (ClientSequence seq = 5; seq <= 5000 && bench.ports.closed.empty(); ++seq) {
    bench.edit(1, seq, kAtOrigin, 99);
  }
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::timed_out);
}

TEST_CASE("a client that cannot take its welcome is closed", "[world]") {
  Bench bench;
  bench.server.connected(1, bench.now());
  bench.ports.full.insert(1);
  bench.server.received(1, bench.hello(1), bench.now());
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::timed_out);
}

TEST_CASE("a full queue stops snapshots; they go on with the nearest missing one", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.ports.snapshot_room[1] = 2;
  bench.view(1, kSmall);
  CHECK(bench.ports.snapshots.size() == 2);
  bench.ports.snapshot_room[1] = 100;
  bench.tick(50'000);
  CHECK(bench.ports.snapshots.size() == 2);  // the retry interval has not passed
  bench.tick(60'000);
  CHECK(bench.ports.snapshots.size() == 5);
}

TEST_CASE("a chunk request brings chunks of the view again and ignores others", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.server.received(1, ChunkRequest{{{0, {0, 0, 0}}, {0, {40, 0, 0}}, {3, {0, 0, 0}}}},
                        bench.now());
  REQUIRE(bench.ports.snapshots.size() == 6);
  CHECK(bench.ports.snapshots[5].key == ChunkKey{});
  CHECK(bench.ports.loads.empty());
}

TEST_CASE("a quarantined chunk is reported, told to whoever wants it, and never loaded again",
          "[world]") {
  Bench bench;
  const ChunkUnavailable expected{{ChunkKey{}}, UnavailableReason::damaged};
  const auto told = [&](SessionId session) {
    return bench.ports.messages<ChunkUnavailable>(session, kEdge);
  };
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 0, 0}, bench.now());
  REQUIRE(bench.ports.loads.size() == 1);
  bench.ports.loads.clear();
  CHECK(told(1).empty());
  bench.server.chunk_failed({}, "world.sqlite: snapshot chunk=0,0,0: bad checksum", bench.now());
  REQUIRE(bench.ports.lines.size() >= 1);
  CHECK(bench.ports.lines.back().find("snapshot chunk=0,0,0: bad checksum") != std::string::npos);
  CHECK(told(1) == std::vector{expected});
  bench.join(2, 2);
  bench.view(2, kSmall);
  bench.tick(500'000);
  CHECK(bench.ports.snapshots.size() == 4);
  CHECK(told(2) == std::vector{expected});
  CHECK(told(1).size() == 1);
  bench.server.received(1, ChunkRequest{{ChunkKey{}}}, bench.now());
  CHECK(told(1).size() == 2);
  CHECK(bench.ports.loads.empty());
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.server.head() == 1);  // ordered, logged and answered all the same
  CHECK(bench.commits(1).size() == 1);
}

TEST_CASE("a loaded chunk that does not fit the log is told to be unavailable", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 0, 0}, bench.now());
  bench.ports.loads.clear();
  bench.server.chunk_loaded({}, test::empty_chunk(32), bench.now());
  CHECK(bench.ports.messages<ChunkUnavailable>(1, kEdge).size() == 1);
  CHECK(bench.ports.snapshots.empty());
}

TEST_CASE("the word that a chunk is unavailable waits for room like a snapshot", "[world]") {
  Bench bench;
  const auto told = [&] { return bench.ports.messages<ChunkUnavailable>(1, kEdge).size(); };
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 0, 0}, bench.now());
  bench.ports.loads.clear();
  bench.ports.full.insert(1);
  bench.server.chunk_failed({}, "damaged", bench.now());
  CHECK(told() == 0);
  bench.ports.full.clear();
  bench.server.drained(1, bench.now());
  CHECK(told() == 1);
  bench.tick(500'000);
  CHECK(told() == 1);
}

TEST_CASE("edits beyond the world's heights are rejected by name", "[world]") {
  WorldConfig c = config();
  c.heights = {-8, 8};
  Bench bench(c);
  bench.join(1, 1);
  CHECK(bench.ports.messages<Welcome>(1, 0).at(0).heights == HeightLimits{-8, 8});
  bench.edit(1, 1, FillSphere{{0, 0, 0}, 9});
  bench.edit(1, 2, FillSphere{{0, 0, 0}, 7});
  bench.server.commit(bench.now());
  const auto rejects = bench.ports.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].client_seq == 1);
  CHECK(rejects[0].reason == RejectReason::outside_world);
  CHECK(bench.server.head() == 1);
}

TEST_CASE("features are in force that both sides know; others are ignored", "[world]") {
  WorldConfig c = config();
  c.features = 0b0110;
  Bench bench(c);
  bench.server.connected(1, bench.now());
  Hello hello = bench.hello(1);
  hello.features = 1ULL << 63 | 0b1011;
  bench.server.received(1, hello, bench.now());
  const Welcome welcome = bench.ports.messages<Welcome>(1, 0).at(0);
  CHECK(welcome.features == 0b0010);
  bench.server.received(1, bench.proof(1, hello, welcome), bench.now());
  CHECK(bench.ports.messages<SessionAccepted>(1, kEdge).size() == 1);
}

TEST_CASE("a command in a session without the feature ends it, and the server does not execute it",
          "[world]") {
  Bench bench;
  bench.join(1, 1);  // offers no feature
  bench.server.received(1, CommandRequest{7, "undo"}, bench.now());
  CHECK(bench.ports.commands.empty());
  REQUIRE(bench.ports.closed.size() == 1);
  CHECK(bench.ports.closed[0].reason == GoodbyeReason::unexpected_message);

  bench.server.connected(2, bench.now());
  Hello hello = bench.hello(2);
  hello.features = kFeatureCommands;
  bench.server.received(2, hello, bench.now());
  const Welcome welcome = bench.ports.messages<Welcome>(2, 0).at(0);
  bench.server.received(2, bench.proof(2, hello, welcome), bench.now());
  bench.server.received(2, CommandRequest{7, "undo"}, bench.now());
  CHECK(bench.ports.commands == std::vector<std::string>{"undo"});
  CHECK(bench.ports.closed.size() == 1);
}

TEST_CASE("an invalid descriptor is rejected as bad_edit, costs one token and is resolved",
          "[world]") {
  WorldConfig c = config();
  c.edits_per_second = 1;
  c.edit_burst = 2;
  Bench bench(c);
  bench.join(1, 1);
  const auto offer = [&](ClientSequence seq) {
    bench.server.received(
        1, EditRequest{seq, 0, {}, Error{ErrorCode::unknown_kind, "unknown edit kind", 3}},
        bench.now());
    return bench.ports.messages<Reject>(1, kEdge).back();
  };
  const Reject first = offer(1);
  CHECK(first.client_seq == 1);
  CHECK(first.reason == RejectReason::bad_edit);
  CHECK(first.detail == "unknown edit kind (at byte 3)");
  CHECK(offer(1) == first);  // costs nothing: the operation is resolved
  CHECK(offer(2).reason == RejectReason::bad_edit);
  CHECK(offer(3) == Reject{3, RejectReason::rate_limited, "", 0});
  CHECK_FALSE(bench.server.has_queued());
  CHECK(bench.server.resolved(1, 1) == 3);
  CHECK(bench.server.session_count() == 1);
}

TEST_CASE("audits carry version and digest of chunks the session has", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.server.commit(bench.now());
  bench.tick(1'000'000);
  const auto audits = bench.ports.messages<DigestCheck>(1, kEdge);
  REQUIRE(audits.size() == 1);
  REQUIRE(audits[0].entries.size() == 5);  // all of them, each once
  for (const DigestCheckEntry& entry : audits[0].entries) {
    const ChunkPtr chunk = bench.server.find_chunk(entry.key);
    CHECK(entry.version == chunk->version);
    CHECK(entry.digest == digest_of(chunk->voxels));
  }
  CHECK(bench.server.counters().audit_mismatches == 0);
}

TEST_CASE("an audit finds a digest that does not fit its runs", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.received(1, View{{0, 0, 0}, 0, 0}, bench.now());
  bench.ports.loads.clear();
  Chunk wrong = test::dotted_chunk(kEdge);
  wrong.digest.lane[0] = 1;
  bench.server.chunk_loaded({}, wrong, bench.now());
  bench.tick(1'000'000);
  CHECK(bench.server.counters().audit_mismatches == 1);
}

TEST_CASE("stopping says goodbye, refuses edits and ends with everything in snapshots", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.edit(1, 2, SetVoxel{{100, 1, 1}}, 2);  // in no session's view
  bench.server.begin_stop(bench.now());
  CHECK(bench.ports.closed.at(0).reason == GoodbyeReason::closing);
  CHECK(bench.ports.records.size() == 2);  // what was accepted is ordered and logged
  bench.answer_loads();
  CHECK(bench.ports.saves.empty());
  CHECK_FALSE(bench.server.is_settled());
  bench.server.durable(2, bench.now());
  REQUIRE(bench.ports.saves.size() == 1);
  CHECK(bench.ports.saves[0].chunks.size() == 2);
  CHECK(bench.ports.saves[0].checkpoint == 2);
  CHECK_FALSE(bench.server.is_settled());
  bench.server.snapshots_saved(bench.now());
  CHECK(bench.server.is_settled());
  CHECK(bench.server.checkpoint() == 2);
}

TEST_CASE("after a failed log every edit is rejected busy", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.log_failed();
  bench.edit(1, 1, kAtOrigin);
  CHECK(bench.ports.messages<Reject>(1, kEdge).at(0).reason == RejectReason::busy);
}

TEST_CASE("a restarted world goes on from its log: versions, previous sequences and voxels",
          "[world]") {
  WorldStart start;
  start.log = {2, 2, 0};
  Bench bench(config(), start);
  const EditDescriptor first{kAtOrigin, {}, 1};
  bench.server.replay_onto_stack({{1, 1}, {1, 1, 1}, 0, Cause::player, first});
  bench.server.replay_onto_stack({{1, 2}, {1, 1, 2}, 0, Cause::player, {kAtOrigin, {}, 3}});
  bench.join(1, 1);
  bench.view(1, kSmall);
  const ChunkPtr chunk = bench.server.find_chunk({});
  CHECK(chunk->version == Version{1, 2});
  CHECK(material_at(chunk->voxels, {1, 1, 1}) == 3);
  bench.edit(1, 3, kAtOrigin, 4);
  bench.server.commit(bench.now());
  const auto commits = bench.commits(1);
  REQUIRE(commits.size() == 1);
  CHECK(commits[0].epoch == 2);
  CHECK(commits[0].first == 3);
  CHECK(commits[0].edits[0].previous == std::vector<Sequence>{2});
}

}  // namespace
}  // namespace runstone
