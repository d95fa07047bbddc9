#include "server/world/world_server.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/handshake.hpp"
#include "tests/unit/server/world/commit/pasted_crowd.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;
using Bench = WorldBench;

TEST_CASE("rejects name the client's sequence and the reason", "[world]") {
  WorldConfig c = config();
  c.reach_max = 50;
  Bench bench(c);
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin, 99);
  bench.edit(1, 2, SetVoxel{{100, 0, 0}});
  bench.edit(1, 3, kAtOrigin);
  bench.edit(1, 3, kAtOrigin);  // it waits: the commit answers both
  CHECK(bench.environment.messages<Reject>(1, kEdge).size() == 2);
  bench.server.commit(bench.now());
  bench.edit(1, 3, kAtOrigin);
  bench.environment.log_room = false;
  bench.edit(1, 4, kAtOrigin);
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 4);
  CHECK(rejects[0].reason == RejectReason::unknown_material);
  CHECK(rejects[1].reason == RejectReason::out_of_reach);
  CHECK(rejects[2].reason == RejectReason::already_resolved);
  CHECK(rejects[3].reason == RejectReason::busy);
  CHECK(rejects[3].client_seq == 4);
  bench.environment.log_room = true;
  bench.edit(1, 4, kAtOrigin);  // the rejection is final and repeated
  bench.edit(1, 5, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.environment.records.size() == 2);
}

TEST_CASE("an edit that is offered again while it waits is answered by its commit", "[world]") {
  constexpr ClientSequence kPastes = 10;
  PastedCrowd bench(kPastes);
  bench.edit(2, 1, kAtOrigin);  // ordered before the last pastes
  bench.server.commit(bench.now());
  REQUIRE(bench.environment.records.back().op.author == 2);
  bench.server.disconnected(1);
  bench.join(21, 1);
  bench.edit(21, kPastes, bench.paste, kEmpty);
  CHECK(bench.environment.messages<Reject>(21, kEdge).empty());
  while (bench.commits(21).empty() || bench.commits(21).back().edits.back().op.seq < kPastes)
    bench.tick();
  const Sequence seq = bench.commits(21).back().edits.back().seq;
  bench.edit(21, kPastes, bench.paste, kEmpty);
  const auto rejects = bench.environment.messages<Reject>(21, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].reason == RejectReason::already_resolved);
  CHECK(rejects[0].seq >= seq);
}

TEST_CASE("a player's large edits beyond what may wait are refused, those of others are not",
          "[world]") {
  constexpr ClientSequence kPastes = 400;
  PastedCrowd bench(kPastes);
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE_FALSE(rejects.empty());
  CHECK(rejects.size() < kPastes - 100);
  CHECK(rejects[0].reason == RejectReason::busy);
  CHECK(rejects[0].detail == "too many large edits of players wait");
  bench.edit(2, 1, kAtOrigin);
  bench.edit(3, 1, bench.paste, kEmpty);
  bench.server.commit(bench.now());
  for (const SessionId session : {2U, 3U})
    CHECK(bench.environment.messages<Reject>(session, kEdge).empty());
  CHECK(bench.environment.records.back().op.author == 2);
  CHECK(bench.server.order().has_waiting_edit(3));
}

TEST_CASE("the row of a player who left is kept while an edit waits, whatever others do",
          "[world]") {
  constexpr ClientSequence kPastes = 10;
  PastedCrowd bench(kPastes);
  bench.server.disconnected(1);
  bench.server.disconnected(3);
  bench.tick();
  CHECK(bench.server.order().has_waiting_edit(1));
  // The player without edits is forgotten although the queue is not empty.
  REQUIRE(bench.server.order().players().visitors().size() == 1);
  CHECK(bench.server.order().players().visitors()[0].author == 3);
  while (bench.server.order().has_waiting_edit(1)) bench.tick();
  CHECK(bench.environment.records.size() == kPastes);
  CHECK(bench.environment.players.size() == 1);
  CHECK(bench.environment.players[0].author == 1);
}

TEST_CASE("edits of the server leave room in the log for the large edits that wait", "[world]") {
  constexpr ClientSequence kPastes = 10;
  PastedCrowd bench(kPastes);
  const std::size_t waiting = kPastes - bench.environment.records.size();
  REQUIRE(waiting > 0);
  const AuthorId author = bench.environment.records.front().op.author;
  const EditOffer undo{{author, 77, 1}, Cause::undo, 0, {kAtOrigin, {}, 1}, 1};
  bench.environment.log_records_max = kPastes;
  CHECK(bench.server.changes().order_edits({undo}, 0, bench.now()).count == 0);
  bench.environment.log_records_max = kPastes + 1;
  CHECK(bench.server.changes().order_edits({undo}, 0, bench.now()).count == 1);
  CHECK(bench.environment.records.back().cause == Cause::undo);
}

TEST_CASE("once an edit of an action is rejected, so are its later edits", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  const auto send = [&](ClientSequence seq, ClientSequence action, Material material = 1) {
    const EditDescriptor edit{SetVoxel{{static_cast<std::int32_t>(seq), 1, 1}}, {}, material};
    bench.server.received(1, EditRequest{seq, 0, edit, std::nullopt, action}, bench.now());
  };
  constexpr Material kUnknown = 999;
  send(1, 1);
  send(2, 1, kUnknown);
  send(3, 1);
  send(4, 4);
  send(5, 0);
  bench.tick();
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 2);
  CHECK(rejects[0].client_seq == 2);
  CHECK(rejects[1].client_seq == 3);
  CHECK(rejects[1].reason == rejects[0].reason);
  CHECK(rejects[1].detail == "an earlier edit of the same action was refused");
  CHECK(bench.server.order().head() == 3);  // the edits 1, 4 and 5
}

TEST_CASE("rejections and requests for chunks count as much that was read", "[world]") {
  WorldConfig c = config();
  c.edit_budget = {1, 1};
  Bench bench(c);
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  CHECK(bench.environment.charged[1] == 0);
  bench.edit(1, 2, kAtOrigin);
  const std::size_t rejection = bench.environment.charged[1];
  CHECK(rejection > 1'000);
  bench.edit(1, 1, kAtOrigin);  // offered again
  CHECK(bench.environment.charged[1] == rejection);
  bench.server.received(1, ChunkRequest{{{0, {0, 0, 0}}, {0, {1, 0, 0}}}}, bench.now());
  CHECK(bench.environment.charged[1] > rejection);
}

TEST_CASE("an edit that is rejected busy costs no budget", "[world]") {
  WorldConfig c = config();
  c.edit_budget = {1, 2};
  Bench bench(c);
  bench.join(1, 1);
  bench.environment.log_room = false;
  for (ClientSequence seq = 1; seq <= 5; ++seq) bench.edit(1, seq, kAtOrigin);
  bench.environment.log_room = true;
  for (ClientSequence seq = 6; seq <= 8; ++seq) bench.edit(1, seq, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.environment.records.size() == 2);
  CHECK(bench.environment.messages<Reject>(1, kEdge).back().reason == RejectReason::rate_limited);
}

TEST_CASE("a player who jumps reaches what is there only as fast as the server believes",
          "[world]") {
  WorldConfig c = config();
  c.reach_max = 10;
  c.speed_max = 20;
  Bench bench(c);
  bench.join(1, 1);
  bench.time_us += 1'000'000;
  bench.server.received(1, Move{{{100, 0, 0}, 0, 0}}, bench.now());
  bench.edit(1, 1, SetVoxel{{100, 0, 0}});  // the server believes x = 0
  bench.time_us += 1'000'000;
  bench.edit(1, 2, SetVoxel{{100, 0, 0}});  // x = 20
  bench.edit(1, 3, SetVoxel{{25, 0, 0}});
  bench.time_us += 4'000'000;
  bench.edit(1, 4, SetVoxel{{100, 0, 0}});
  bench.server.commit(bench.now());
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 2);
  CHECK(rejects[0].client_seq == 1);
  CHECK(rejects[1].client_seq == 2);
  CHECK(rejects[1].reason == RejectReason::out_of_reach);
  CHECK(bench.environment.records.size() == 2);
}

TEST_CASE("sessions of one key share its edit budget, and keys of one address share another",
          "[world]") {
  constexpr AddressBlock kHome = address_block_v4(1), kSchool = address_block_v4(2);
  WorldConfig c = config();
  c.edit_budget = {10, 2};
  c.budgets_per_address = 2;
  Bench bench(c);
  bench.join(1, 1, 1, kHome);
  bench.join(2, 1, 2, kSchool);  // the same key
  bench.join(3, 3, 1, kHome);
  bench.join(4, 4, 1, kHome);
  bench.join(5, 5, 1, kSchool);
  const auto is_refused = [&](SessionId session, ClientSequence seq) {
    const auto before = bench.environment.messages<Reject>(session, kEdge).size();
    bench.edit(session, seq, kAtOrigin);
    const auto rejects = bench.environment.messages<Reject>(session, kEdge);
    if (rejects.size() == before) return std::string();
    CHECK(rejects.back().reason == RejectReason::rate_limited);
    return rejects.back().detail;
  };
  CHECK(is_refused(1, 1).empty());
  CHECK(is_refused(2, 1).empty());
  CHECK(is_refused(2, 2) == "the edit budget of your key is used up: again in 0.1 s");
  for (ClientSequence seq = 1; seq <= 2; ++seq) CHECK(is_refused(3, seq).empty());
  CHECK(is_refused(4, 1).empty());  // the fourth unit of its address
  CHECK(is_refused(4, 2) == "the edit budget of your address is used up: again in 0.1 s");
  CHECK(is_refused(5, 1).empty());
  // Connecting again gains nothing.
  bench.server.disconnected(1);
  bench.join(6, 1, 3, kSchool);
  CHECK(is_refused(6, 1) == "the edit budget of your key is used up: again in 0.1 s");
}

TEST_CASE("a key and an address have a limited number of sessions", "[world]") {
  constexpr AddressBlock kHome = address_block_v4(1), kSchool = address_block_v4(2);
  WorldConfig c = config();
  c.sessions_per_key = 2;
  c.sessions_per_address = 3;
  Bench bench(c);
  const auto knock = [&](SessionId session, std::uint8_t who, ClientInstance instance,
                         AddressBlock from) {
    bench.server.connected(session, bench.now(), from);
    bench.server.received(session, bench.hello(who, instance), bench.now());
  };
  bench.join(1, 1, 1, kHome);
  bench.join(2, 1, 2, kSchool);
  knock(3, 1, 3, kSchool);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 3);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::server_full);
  CHECK(bench.environment.closed[0].text == "a key has 2 sessions at most");
  bench.join(4, 1, 2, kSchool);  // replaces its own session 2
  bench.join(5, 5, 1, kHome);
  bench.join(6, 6, 1, kHome);
  knock(7, 7, 1, kHome);
  REQUIRE(bench.environment.closed.size() == 3);
  CHECK(bench.environment.closed[2].session == 7);
  CHECK(bench.environment.closed[2].text == "an address has 3 sessions at most");
  bench.join(8, 7, 1, kSchool);
}

TEST_CASE("a range of addresses takes a share of the seats that the others leave", "[world]") {
  constexpr std::uint32_t kMany = 0xc0000200, kOther = 0xc6336401, kThird = 0xcb007101;
  WorldConfig c = config();
  c.sessions_max = 40;
  c.sessions_per_address = 10;
  c.range_seats_percent = 50;
  SessionId session = 0;
  // Returns the text of the refusal, or an empty text.
  const auto enters = [&session](Bench& bench, AddressBlock from) -> std::string {
    const auto who = static_cast<std::uint8_t>(++session);
    bench.server.connected(session, bench.now(), from);
    const Hello hello = bench.hello(who, 1);
    bench.server.received(session, hello, bench.now());
    const auto welcome = bench.environment.messages<Welcome>(session, 0);
    if (welcome.empty()) return bench.environment.closed.back().text;
    bench.server.received(session, bench.client_auth(who, hello, welcome[0]), bench.now());
    return "";
  };
  const auto let_in = [&](Bench& bench, std::uint32_t first, int addresses) {
    int in = 0;
    for (int i = 0; i < 45; ++i) {
      const auto at = first + static_cast<std::uint32_t>(i % addresses);
      in += enters(bench, address_block_v4(at)).empty() ? 1 : 0;
    }
    return in;
  };
  SECTION("so newcomers from elsewhere get in") {
    Bench bench(c);
    CHECK(let_in(bench, kMany, 5) == 20);  // of one /24
    CHECK(enters(bench, address_block_v4(kMany + 9)) ==
          "while few seats are free, your range of addresses has 20 sessions at most "
          "(range_seats_percent): come back later, or ask the server's host");
    CHECK(let_in(bench, kOther, 5) == 10);  // half of what is left
    CHECK(enters(bench, address_block_v4(kThird)).empty());
  }
  SECTION("which a host can change, for a school behind one address") {
    c.range_seats_percent = 100;
    c.sessions_per_address = 40;
    Bench bench(c);
    CHECK(let_in(bench, kMany, 1) == 40);
  }
  SECTION("not in a local network, and not without a limit for addresses") {
    Bench local(c);
    CHECK(let_in(local, 0xc0a80000, 5) == 40);
    c.sessions_per_address = 0;
    Bench open(c);
    CHECK(let_in(open, kMany, 1) == 40);
  }
  SECTION("of eight seats at least") {
    c.sessions_max = 10;
    Bench bench(c);
    CHECK(let_in(bench, kMany, 5) == 8);
  }
}

namespace {

/// A world with 256 seats, of which one range may take half of those that others leave.
struct SeatBench : Bench {
  SeatBench() : Bench(config_of_seats()) {}
  static WorldConfig config_of_seats() {
    WorldConfig c = config();
    c.sessions_max = 256;
    c.sessions_per_address = 64;
    c.range_seats_percent = 50;
    return c;
  }
  /// Returns the text of the refusal, or an empty text.
  std::string enters(AddressBlock from) {
    ++session;
    const auto who = static_cast<std::uint8_t>(session);
    server.connected(session, now(), from);
    const Hello first = hello(who, session);
    server.received(session, first, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    if (welcome.empty()) return environment.closed.back().text;
    server.received(session, client_auth(who, first, welcome[0]), now());
    return "";
  }
  /// Lets five addresses of a range take all seats that they get. Returns how many.
  int fill(AddressBlock first) {
    for (int taken = 0;; ++taken) {
      const auto at = static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(taken % 5);
      if (!enters(AddressBlock{at}).empty()) return taken;
    }
  }
  SessionId session = 0;
};

}  // namespace

TEST_CASE("many ranges of addresses leave seats to those without a session", "[world]") {
  SeatBench bench;
  // Each /24 lies in a /16 of its own.
  const auto range = [](std::uint32_t number) {
    return address_block_v4(0x0b000000 + (number << 16));
  };
  std::uint32_t next = 0;
  for (const int taken : {128, 64, 32}) CHECK(bench.fill(range(next++)) == taken);
  for (int i = 0; i < 31; ++i) {
    CAPTURE(i);
    CHECK(bench.fill(range(next++)) == 1);
  }
  CHECK(bench.server.session_count() == 255);
  CHECK(bench.enters(range(0)) ==
        "the last 16 seats are for networks (/16 of IPv4, /32 of IPv6) without a session "
        "(range_seats_percent): come back later, or ask the server's host");
  CHECK(bench.enters(range(next)).empty());
  CHECK(bench.enters(range(next + 1)) == "the server holds 256 sessions at most");
}

TEST_CASE("the ranges of one network leave seats to other networks", "[world]") {
  SeatBench bench;
  const auto range = [](std::uint64_t network, std::uint64_t number) {
    return AddressBlock{network << 32 | number << 16};
  };
  constexpr std::uint64_t kProvider = 0x20010db8;
  std::uint64_t next = 0;
  for (const int taken : {128, 64, 32}) CHECK(bench.fill(range(kProvider, next++)) == taken);
  CHECK(bench.enters(range(kProvider, 0)) ==
        "the last 32 seats are for ranges of addresses (/24 of IPv4, /48 of IPv6) without a "
        "session (range_seats_percent): come back later, or ask the server's host");
  for (int i = 0; i < 16; ++i) {
    CAPTURE(i);
    CHECK(bench.fill(range(kProvider, next++)) == 1);
  }
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    CHECK(bench.fill(range(kProvider, next++)) == 0);
  }
  CHECK(bench.server.session_count() == 240);
  for (std::uint64_t i = 1; i <= 16; ++i) {
    CAPTURE(i);
    CHECK(bench.enters(range(kProvider + i, 0)).empty());
  }
}

TEST_CASE("seats are counted again when a session has proved its key", "[world]") {
  WorldConfig c = config();
  c.sessions_per_key = 1;
  Bench bench(c);
  const Hello one = bench.hello(1, 1), two = bench.hello(1, 2);
  for (const auto& [session, hello] :
       {std::pair{SessionId{1}, one}, std::pair{SessionId{2}, two}}) {
    bench.server.connected(session, bench.now());
    bench.server.received(session, hello, bench.now());
  }
  const auto prove = [&](SessionId session, const Hello& hello) {
    const auto welcome = bench.environment.messages<Welcome>(session, 0).at(0);
    bench.server.received(session, bench.client_auth(1, hello, welcome), bench.now());
  };
  prove(1, one);
  prove(2, two);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 2);
}

TEST_CASE("a session that edits too fast is rejected, and accepted again later", "[world]") {
  WorldConfig c = config();
  c.edit_budget = {10, 2};
  Bench bench(c);
  bench.join(1, 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq) bench.edit(1, seq, kAtOrigin);
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].client_seq == 3);
  CHECK(rejects[0].reason == RejectReason::rate_limited);
  bench.tick(100'000);
  bench.edit(1, 4, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 3);
}

TEST_CASE("a jump of the wall clock is reported to the operator, and no edit gets its time",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.tick();
  bench.environment.lines.clear();
  const Clocks right = bench.now();
  const Clocks wrong{right.steady_us + 50'000, right.utc_us + 100'000'000'000'000};
  bench.server.tick(wrong);
  REQUIRE(bench.environment.lines.size() == 1);
  CHECK(bench.environment.lines[0].find("the wall clock has jumped") != std::string::npos);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(wrong);
  REQUIRE(bench.environment.records.size() == 1);
  CHECK(bench.environment.records[0].time_us == right.utc_us + 50'000);
}

TEST_CASE("a new name of a known author is stored once, without an edit", "[world]") {
  WorldStart start;
  start.players.push_back({6, key_pair_of(seed_of(1)).public_key, "old name"});
  Bench bench(config(), start);
  SECTION("at once while the log has room") {
    bench.join(1, 1);
    REQUIRE(bench.environment.players.size() == 1);
    CHECK(bench.environment.records.empty());
    bench.join(2, 1, 2);  // the same name again
    bench.edit(1, 1, kAtOrigin);
    bench.server.commit(bench.now());
  }
  SECTION("with the author's next edit otherwise") {
    bench.environment.log_room = false;
    bench.join(1, 1);
    CHECK(bench.environment.players.empty());
    bench.environment.log_room = true;
    bench.edit(1, 1, kAtOrigin);
    bench.server.commit(bench.now());
  }
  REQUIRE(bench.environment.players.size() == 1);
  CHECK(bench.environment.players[0].author == 6);
  CHECK(bench.environment.players[0].key == key_pair_of(seed_of(1)).public_key);
  CHECK(bench.environment.players[0].name == "player1");
  CHECK(bench.environment.records.size() == 1);
}

TEST_CASE(
    "an author who never edited is removed with its last session, and its number is not reused",
    "[world]") {
  Bench bench;
  CHECK(bench.join(1, 1).author == 1);
  bench.edit(1, 7, SetVoxel{{1, 1, 1}}, 99);  // rejected: there is no such material
  bench.server.disconnected(1);
  bench.tick();
  const SessionAccepted again = bench.join(2, 1);
  CHECK(again.author == 2);
  CHECK(again.resolved == 0);
  CHECK(bench.join(3, 1, 2).author == 2);  // another instance of the same key
  bench.server.disconnected(2);
  bench.tick();
  CHECK(bench.join(4, 1).author == 2);  // one session was still open
  bench.edit(4, 1, kAtOrigin);
  bench.server.disconnected(4);  // before the edit is ordered
  bench.server.disconnected(3);
  bench.tick();
  REQUIRE(bench.environment.players.size() == 1);
  CHECK(bench.environment.players[0].author == 2);
  const SessionAccepted known = bench.join(5, 1);
  CHECK(known.author == 2);
  CHECK(known.resolved == 1);
  CHECK(bench.join(6, 6).author == 3);
}

TEST_CASE("edits beyond the world's heights are rejected", "[world]") {
  WorldConfig c = config();
  c.heights = {-8, 8};
  Bench bench(c);
  bench.join(1, 1);
  CHECK(bench.environment.messages<Welcome>(1, 0).at(0).heights == HeightLimits{-8, 8});
  bench.edit(1, 1, FillSphere{{0, 0, 0}, 9});
  bench.edit(1, 2, FillSphere{{0, 0, 0}, 7});
  bench.server.commit(bench.now());
  const auto rejects = bench.environment.messages<Reject>(1, kEdge);
  REQUIRE(rejects.size() == 1);
  CHECK(rejects[0].client_seq == 1);
  CHECK(rejects[0].reason == RejectReason::outside_world);
  CHECK(bench.server.order().head() == 1);
}

TEST_CASE("digest checks have version and digest of chunks that the session has", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.server.commit(bench.now());
  bench.tick(1'000'000);
  const auto checks = bench.environment.messages<DigestCheck>(1, kEdge);
  REQUIRE(checks.size() == 1);
  REQUIRE(checks[0].entries.size() == 5);  // every chunk, once each
  for (const DigestCheckEntry& entry : checks[0].entries) {
    const ChunkPtr chunk = bench.server.order().chunks().find(entry.key);
    CHECK(entry.version == chunk->version);
    CHECK(entry.digest == digest_of(chunk->voxels));
  }
  CHECK(bench.server.counters().digest_mismatches == 0);
}

TEST_CASE("a digest check finds a digest that differs from its runs", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.send_view(1, View{1, {0, 0, 0}, 0, 0});
  bench.environment.loads.clear();
  Chunk wrong = test::dotted_chunk(kEdge);
  wrong.digest.lane[0] = 1;
  bench.server.chunk_loaded({}, wrong, bench.now());
  bench.tick(1'000'000);
  CHECK(bench.server.counters().digest_mismatches == 1);
}

TEST_CASE("a stop sends goodbye, rejects edits and ends with every edit in snapshots", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin, 2);
  bench.edit(1, 2, SetVoxel{{100, 1, 1}}, 2);  // in no session's view
  bench.server.begin_stop(bench.now());
  CHECK(bench.environment.closed.at(0).reason == GoodbyeReason::closing);
  CHECK(bench.environment.records.size() == 2);  // accepted edits are ordered and logged
  bench.answer_loads();
  CHECK(bench.environment.saves.empty());
  CHECK_FALSE(bench.server.order().is_flushed());
  bench.server.durable(2, bench.now());
  REQUIRE(bench.environment.saves.size() == 1);
  CHECK(bench.environment.saves[0].chunks.size() == 2);
  CHECK(bench.environment.saves[0].checkpoint == 2);
  CHECK_FALSE(bench.server.order().is_flushed());
  bench.server.snapshots_saved(bench.now());
  CHECK(bench.server.order().is_flushed());
  CHECK(bench.server.order().checkpoint() == 2);
}

TEST_CASE("after a failed log every edit is rejected busy", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.server.log_failed();
  bench.edit(1, 1, kAtOrigin);
  CHECK(bench.environment.messages<Reject>(1, kEdge).at(0).reason == RejectReason::busy);
}

TEST_CASE("a restarted world continues its log: versions, previous sequences and voxels",
          "[world]") {
  WorldStart start;
  start.log = {2, 2, 0};
  Bench bench(config(), start);
  const EditDescriptor first{kAtOrigin, {}, 1};
  bench.server.replay_onto_stack({{1, 1}, {1, 1, 1}, 0, Cause::player, first});
  bench.server.replay_onto_stack({{1, 2}, {1, 1, 2}, 0, Cause::player, {kAtOrigin, {}, 3}});
  bench.join(1, 1);
  bench.view(1, kSmall);
  const ChunkPtr chunk = bench.server.order().chunks().find({});
  CHECK(chunk->version == Version{1, 2});
  CHECK(material_at(chunk->voxels, {1, 1, 1}) == 3);
  bench.edit(1, 3, kAtOrigin, 4);
  bench.server.commit(bench.now());
  const auto commits = bench.commits(1);
  REQUIRE(commits.size() == 1);
  CHECK(commits[0].epoch == 2);
  CHECK(commits[0].edits.at(0).seq == 3);
  CHECK(commits[0].edits[0].previous == std::vector<Sequence>{2});
}

}  // namespace

TEST_CASE("a command in a session without the feature ends it, and the server does not execute it",
          "[world]") {
  Bench bench;
  bench.join(1, 1);  // offers no feature
  bench.server.received(1, CommandRequest{7, "undo"}, bench.now());
  CHECK(bench.environment.commands.empty());
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::unexpected_message);

  bench.server.connected(2, bench.now());
  Hello hello = bench.hello(2);
  hello.features = kFeatureCommands;
  bench.server.received(2, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(2, 0).at(0);
  bench.server.received(2, bench.client_auth(2, hello, welcome), bench.now());
  bench.server.received(2, CommandRequest{7, "undo"}, bench.now());
  CHECK(bench.environment.commands == std::vector<std::string>{"undo"});
  CHECK(bench.environment.closed.size() == 1);
}

TEST_CASE("an invalid descriptor is rejected as bad_edit, costs one unit and is resolved",
          "[world]") {
  WorldConfig c = config();
  c.edit_budget = {1, 2};
  Bench bench(c);
  bench.join(1, 1);
  const auto offer = [&](ClientSequence seq) {
    bench.server.received(
        1, EditRequest{seq, 0, {}, Error{ErrorCode::unknown_kind, "unknown edit kind", 3}},
        bench.now());
    return bench.environment.messages<Reject>(1, kEdge).back();
  };
  const Reject first = offer(1);
  CHECK(first.client_seq == 1);
  CHECK(first.reason == RejectReason::bad_edit);
  CHECK(first.detail == "unknown edit kind (at byte 3)");
  CHECK(offer(1) == first);  // costs nothing: the operation is resolved
  CHECK(offer(2).reason == RejectReason::bad_edit);
  CHECK(offer(3).reason == RejectReason::rate_limited);
  CHECK_FALSE(bench.server.has_ready_edits(bench.now().steady_us));
  CHECK(bench.server.order().resolved(1, 1) == 3);
  CHECK(bench.server.session_count() == 1);
}

}  // namespace runstone
