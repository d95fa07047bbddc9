#include "client/bots/headless_session.hpp"

#include <catch2/catch.hpp>

#include "tests/support/test_keys.hpp"

using namespace runstone;

namespace {

TimeUs clock_us = 0;
TimeUs read_clock() { return clock_us; }

constexpr ChunkCoord kHere{0, 0, 0};
constexpr std::uint16_t kEdge = 16;
constexpr AuthorId kAuthor = 7;

/// A server that says what a test wants, to one light session.
struct Bench {
  Bench() {
    config.keys = test::keys(1);
    config.instance = 11;
    session.emplace(config, crowd, read_clock);
    greet(1, 0);
    session->set_view({kHere, 0, 0});
    ChunkSnapshot snapshot;
    snapshot.key = {0, kHere};
    snapshot.chunk.voxels = uniform_chunk(Extent::cube(kEdge), 3);
    snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
    give(snapshot);
    CHECK(session->loaded());
    session->take_outgoing();
  }
  /// A new connection up to ready. Returns what the session has to say then.
  std::vector<Message> greet(Epoch epoch, ClientSequence resolved) {
    session->connected({5}, clock_us);
    const auto hello = std::get<Hello>(session->take_outgoing().at(0));
    Welcome welcome;
    welcome.epoch = epoch;
    welcome.chunk_edge = kEdge;
    welcome.world_id.fill(3);
    welcome.materials = default_material_table();
    welcome.server_key = keys.public_key;
    welcome.view_radius_max = 4;
    welcome.signature = sign(keys, server_transcript(hello, welcome));
    give(welcome);
    REQUIRE(std::holds_alternative<ClientAuth>(session->take_outgoing().at(0)));
    give(SessionAccepted{kAuthor, resolved});
    REQUIRE(session->is_open());
    return session->take_outgoing();
  }
  void give(Message message) {
    session->receive(std::move(message), {clock_us, clock_us, clock_us});
  }
  /// As a link does it.
  Result<bool> give_bytes(const Message& message) {
    const EncodedMessage encoded = encode_message(message);
    return session->receive_bytes(encoded.frame_class, *encoded.bytes, kEdge, clock_us);
  }
  /// Whether the session took the bytes of a sound message.
  bool takes(const Message& message) {
    const auto taken = give_bytes(message);
    REQUIRE(taken.has_value());
    return *taken;
  }
  /// One edit in the chunk that is seen.
  static OrderedEdit edit(Sequence previous, OperationId op = {1, 1, 1}) {
    OrderedEdit out;
    out.op = op;
    out.edit = {SetVoxel{{1, 2, 3}}, {}, 1};
    out.previous = {previous};
    return out;
  }
  ClientSequence submit(TimeUs due_us) {
    const auto seq = session->submit({SetVoxel{{1, 2, 3}}, {}, 1}, due_us, due_us);
    REQUIRE(seq.has_value());
    return *seq;
  }
  OperationId own(ClientSequence seq) const { return {kAuthor, config.instance, seq}; }
  const Violations& violations() const { return session->versions().violations(); }

  SessionConfig config;
  KeyPair keys = test::keys(9);
  FleetStatistics crowd;
  std::optional<HeadlessSession> session;
};

}  // namespace

TEST_CASE("a light session verifies commits and measures each edit at each bot", "[bots][light]") {
  clock_us = 1'000;
  Bench bench;
  bench.crowd.due.add(99, 5, 400);
  clock_us = 2'000;
  const ClientSequence mine = bench.submit(1'900);
  clock_us = 2'500;
  const Commit commit{
      1,
      3,
      {Bench::edit(0, {2, 99, 5}), Bench::edit(3, bench.own(mine)), Bench::edit(4, {2, 98, 1})}};
  REQUIRE(bench.takes(commit));
  CHECK(bench.violations().total() == 0);
  CHECK(bench.session->versions().version(kHere) == 5);
  CHECK(bench.session->counts().commits == 1);
  CHECK(bench.session->counts().edits == 3);
  CHECK(bench.session->local_edits().counters().confirmed == 1);
  CHECK(bench.session->counts().confirm_us.max() == 600);
  CHECK(bench.crowd.seen_us().count() == 2);
  CHECK(bench.crowd.seen_us().max() == 2'100);
  CHECK(bench.crowd.unattributed() == 1);
  CHECK(bench.session->local_edits().all().size() == 1);
  bench.give(Durable{1, 5});
  CHECK(bench.session->local_edits().all().empty());
  CHECK(bench.session->local_edits().counters().durable == 1);
}

TEST_CASE("bytes of another class, and messages that are no commits, are left to be decoded",
          "[bots][light]") {
  Bench bench;
  CHECK_FALSE(bench.takes(Pong{1, 2}));
  CHECK_FALSE(bench.takes(Durable{1, 2}));
  CHECK(bench.violations().total() == 0);
}

TEST_CASE("hostile commits end the connection", "[bots][light]") {
  Bench bench;
  SECTION("of another epoch") {
    CHECK_FALSE(bench.give_bytes(Commit{2, 1, {Bench::edit(0)}}).has_value());
  }
  SECTION("cut short") {
    const EncodedMessage encoded = encode_message(Commit{1, 1, {Bench::edit(0)}});
    Bytes bytes = *encoded.bytes;
    bytes.resize(bytes.size() / 2);
    CHECK_FALSE(bench.session->receive_bytes(FrameClass::edits, bytes, kEdge, 0).has_value());
  }
  SECTION("with a list of previous sequences that does not fit") {
    OrderedEdit edit = Bench::edit(0);
    edit.edit = {FillBox{{{-1, 0, 0}, {1, 1, 1}}}, {}, 1};
    CHECK_FALSE(bench.give_bytes(Commit{1, 1, {edit}}).has_value());
  }
}

TEST_CASE("sequences ascend: what comes again is a violation", "[bots][light]") {
  Bench bench;
  REQUIRE(bench.give_bytes(Commit{1, 3, {Bench::edit(0), Bench::edit(3)}}));
  REQUIRE(bench.takes(Commit{1, 9, {Bench::edit(4)}}) ==
          true);  // numbers between are of chunks elsewhere
  CHECK(bench.violations().total() == 0);
  REQUIRE(bench.give_bytes(Commit{1, 9, {Bench::edit(4)}}));
  CHECK(bench.violations().all().at("repeated sequence").count == 1);
  REQUIRE(bench.takes(Commit{1, 8, {Bench::edit(4), Bench::edit(8)}}));
  CHECK(bench.violations().all().at("repeated sequence").count == 3);
}

TEST_CASE("a gap in a chunk's versions is found through the session, and asked for",
          "[bots][light]") {
  clock_us = 1'000;
  Bench bench;
  REQUIRE(bench.takes(Commit{1, 5, {Bench::edit(4)}}));
  CHECK_FALSE(bench.session->loaded());
  clock_us += kResendUsMax;
  bench.session->tick(clock_us);
  CHECK(bench.violations().all().contains("gap"));
  bool asks = false;
  for (const Message& message : bench.session->take_outgoing())
    asks |= std::holds_alternative<ChunkRequest>(message);
  CHECK(asks);
}

TEST_CASE("an own edit is answered once, and only if it was made", "[bots][light]") {
  Bench bench;
  const ClientSequence mine = bench.submit(0);
  REQUIRE(bench.takes(Commit{1, 1, {Bench::edit(0, bench.own(mine))}}));
  CHECK(bench.violations().total() == 0);
  SECTION("not confirmed twice") {
    REQUIRE(bench.takes(Commit{1, 2, {Bench::edit(1, bench.own(mine))}}));
  }
  SECTION("not rejected after that") { bench.give(Reject{mine, RejectReason::busy, "", 0}); }
  SECTION("not one that was never made") {
    REQUIRE(bench.takes(Commit{1, 2, {Bench::edit(1, bench.own(mine + 5))}}));
  }
  CHECK(bench.violations().all().at("answer twice").count == 1);
}

TEST_CASE("a rejected edit is counted and may not be applied later", "[bots][light]") {
  Bench bench;
  const ClientSequence mine = bench.submit(0);
  bench.give(Reject{mine, RejectReason::busy, "", 0});
  CHECK(bench.session->local_edits().counters().rejected == 1);
  CHECK(bench.session->local_edits().all().empty());
  CHECK(bench.violations().total() == 0);
  REQUIRE(bench.takes(Commit{1, 1, {Bench::edit(0, bench.own(mine))}}));
  CHECK(bench.violations().all().contains("answer twice"));
}

TEST_CASE("the durable watermark is of the epoch and never goes back", "[bots][light]") {
  Bench bench;
  bench.give(Durable{1, 5});
  bench.give(Durable{1, 5});
  CHECK(bench.violations().total() == 0);
  SECTION("back") { bench.give(Durable{1, 4}); }
  SECTION("another epoch") { bench.give(Durable{2, 9}); }
  CHECK(bench.violations().all().at("durable").count == 1);
}

TEST_CASE("a light session offers edits that the server does not know again", "[bots][light]") {
  Bench bench;
  const ClientSequence first = bench.submit(0), second = bench.submit(0), third = bench.submit(0);
  REQUIRE(bench.takes(Commit{1, 1, {Bench::edit(0, bench.own(first))}}));
  bench.session->disconnected();
  std::vector<ClientSequence> offered;
  bool sends_view = false;
  for (const Message& message : bench.greet(2, first)) {
    if (const auto* request = std::get_if<EditRequest>(&message))
      offered.push_back(request->client_seq);
    sends_view |= std::holds_alternative<View>(message);
  }
  CHECK(offered == std::vector<ClientSequence>{second, third});
  CHECK(sends_view);
  CHECK_FALSE(bench.session->loaded());
  CHECK(bench.session->connect_count() == 2);
}

TEST_CASE("chunks of one material are seen, and built upon", "[bots][light]") {
  Bench bench;
  bench.session->set_view({kHere, 0, 1});
  CHECK_FALSE(bench.session->loaded());
  bench.give(UniformChunks{{{{0, {0, -1, 0}}, 3, {}}, {{0, {0, 1, 0}}, kEmpty, {}}}});
  CHECK(bench.session->loaded());
  CHECK(bench.crowd.ground.chunks() == 3);
  CHECK(bench.crowd.ground.surface(1, 1) == kEdge - 1);
}

TEST_CASE("a message that no server sends unasked ends the session with its reason",
          "[bots][light]") {
  Bench bench;
  bench.give(CommandOutput{1, {}, true, true});
  CHECK(bench.session->wants_close());
  REQUIRE(bench.session->end().has_value());
  CHECK(bench.session->end()->reason == GoodbyeReason::unexpected_message);
}
