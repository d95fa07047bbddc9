#include "client/bots/headless_session.hpp"

#include <catch2/catch.hpp>

#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/codec/test_keys.hpp"

using namespace runstone;

namespace {

TimeUs clock_us = 0;
TimeUs read_clock() { return clock_us; }

constexpr ChunkCoord kSessionChunk{0, 0, 0};
constexpr std::uint16_t kSessionEdge = 16;
constexpr AuthorId kAuthor = 7;

/// A server played by the test, with one headless session.
struct Bench {
  Bench() {
    config.keys = test::keys(1);
    config.instance = 11;
    session.emplace(config, fleet, read_clock);
    greet(1, 0);
    session->set_view({1, kSessionChunk, 0, 0});
    ChunkSnapshot snapshot;
    snapshot.key = {0, kSessionChunk};
    snapshot.chunk.voxels = uniform_chunk(Extent::cube(kSessionEdge), 3);
    snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
    give(test::chunks_of(snapshot));
    CHECK(session->loaded());
    session->take_outgoing();
  }
  /// Opens a new connection. Returns the messages that the session sends then.
  std::vector<Message> greet(Epoch epoch, ClientSequence resolved) {
    session->connected({5}, std::nullopt, clock_us);
    const auto hello = std::get<Hello>(session->take_outgoing().at(0));
    Welcome welcome;
    welcome.epoch = epoch;
    welcome.chunk_edge = kSessionEdge;
    welcome.world_id.fill(3);
    welcome.materials = default_material_table();
    welcome.server_key = keys.public_key;
    welcome.view_radius_max = 4;
    welcome.features = features;
    welcome.signature = sign(keys, server_transcript(hello, welcome, std::nullopt));
    give(welcome);
    REQUIRE(std::holds_alternative<ClientAuth>(session->take_outgoing().at(0)));
    give(SessionAccepted{kAuthor, resolved});
    REQUIRE(session->is_open());
    return session->take_outgoing();
  }
  void give(Message message) {
    session->receive(std::move(message), {clock_us, clock_us, clock_us});
  }
  /// Passes the message as bytes, like a link.
  Result<bool> give_bytes(const Message& message) {
    const EncodedMessage encoded = encode_message(message);
    return session->receive_bytes(encoded.kind, *encoded.bytes, kSessionEdge, clock_us);
  }
  /// Returns true if the session took the bytes. Fails if they are malformed.
  bool takes(const Message& message) {
    const auto taken = give_bytes(message);
    REQUIRE(taken.has_value());
    return *taken;
  }
  /// Returns an edit of the chunk in view.
  static OrderedEdit edit(Sequence seq, Sequence previous, OperationId op = {1, 1, 1}) {
    OrderedEdit out;
    out.seq = seq;
    out.op = op;
    out.edit = {SetVoxel{{1, 2, 3}}, {}, 1};
    out.previous = {previous};
    return out;
  }
  ClientSequence offer(TimeUs due_us) {
    const auto seq = session->offer({SetVoxel{{1, 2, 3}}, {}, 1}, due_us, due_us);
    REQUIRE(seq.has_value());
    return *seq;
  }
  OperationId own(ClientSequence seq) const { return {kAuthor, config.instance, seq}; }
  const Violations& violations() const { return session->versions().violations(); }

  std::uint64_t features = 0;
  SessionConfig config;
  KeyPair keys = test::keys(9);
  FleetStatistics fleet;
  std::optional<HeadlessSession> session;
};

}  // namespace

TEST_CASE("a headless session verifies commits and times each edit", "[bots][headless]") {
  clock_us = 1'000;
  Bench bench;
  bench.fleet.due.add(99, 5, 400);
  clock_us = 2'000;
  const ClientSequence mine = bench.offer(1'900);
  clock_us = 2'500;
  const Commit commit{1,
                      {Bench::edit(3, 0, {2, 99, 5}), Bench::edit(4, 3, bench.own(mine)),
                       Bench::edit(5, 4, {2, 98, 1})}};
  REQUIRE(bench.takes(commit));
  CHECK(bench.violations().total() == 0);
  CHECK(bench.session->versions().version(kSessionChunk) == 5);
  CHECK(bench.session->counts().commits == 1);
  CHECK(bench.session->counts().edits == 3);
  CHECK(bench.session->local_edits().counters().confirmed == 1);
  CHECK(bench.session->counts().confirm_us.max() == 600);
  CHECK(bench.fleet.seen_us().count() == 2);
  CHECK(bench.fleet.seen_us().max() == 2'100);
  CHECK(bench.fleet.unattributed() == 1);
  CHECK(bench.session->local_edits().all().size() == 1);
  bench.give(Durable{1, 5});
  CHECK(bench.session->local_edits().all().empty());
  CHECK(bench.session->local_edits().counters().durable == 1);
}

TEST_CASE("bytes of another class, and messages that are not commits, are not taken",
          "[bots][headless]") {
  Bench bench;
  CHECK_FALSE(bench.takes(Pong{1, 2}));
  CHECK_FALSE(bench.takes(Durable{1, 2}));
  CHECK(bench.violations().total() == 0);
}

TEST_CASE("hostile commits end the connection", "[bots][headless]") {
  Bench bench;
  SECTION("of another epoch") {
    CHECK_FALSE(bench.give_bytes(Commit{2, {Bench::edit(1, 0)}}).has_value());
  }
  SECTION("cut short") {
    const EncodedMessage encoded = encode_message(Commit{1, {Bench::edit(1, 0)}});
    Bytes bytes = *encoded.bytes;
    bytes.resize(bytes.size() / 2);
    CHECK_FALSE(bench.session->receive_bytes(encoded.kind, bytes, kSessionEdge, 0).has_value());
  }
  SECTION("with a list of previous sequences that does not fit") {
    OrderedEdit edit = Bench::edit(1, 0);
    edit.edit = {FillBox{{{-1, 0, 0}, {1, 1, 1}}}, {}, 1};
    CHECK_FALSE(bench.give_bytes(Commit{1, {edit}}).has_value());
  }
}

TEST_CASE("a sequence that comes again is a violation", "[bots][headless]") {
  Bench bench;
  REQUIRE(bench.give_bytes(Commit{1, {Bench::edit(3, 0), Bench::edit(4, 3)}}));
  REQUIRE(bench.takes(Commit{1, {Bench::edit(9, 4)}}) ==
          true);  // sequences in between are of other chunks
  CHECK(bench.violations().total() == 0);
  REQUIRE(bench.give_bytes(Commit{1, {Bench::edit(9, 4)}}));
  CHECK(bench.violations().all().at("repeated sequence").count == 1);
  REQUIRE(bench.takes(Commit{1, {Bench::edit(8, 4), Bench::edit(9, 8)}}));
  CHECK(bench.violations().all().at("repeated sequence").count == 3);
}

TEST_CASE("a gap in the versions of a chunk is found, and the chunk is requested",
          "[bots][headless]") {
  clock_us = 1'000;
  Bench bench;
  REQUIRE(bench.takes(Commit{1, {Bench::edit(5, 4)}}));
  CHECK_FALSE(bench.session->loaded());
  clock_us += kResendUsMax;
  bench.session->tick(clock_us);
  CHECK(bench.violations().all().contains("gap"));
  bool asks = false;
  for (const Message& message : bench.session->take_outgoing())
    asks |= std::holds_alternative<ChunkRequest>(message);
  CHECK(asks);
}

TEST_CASE("a second answer to a local edit, or to none, is a violation", "[bots][headless]") {
  Bench bench;
  const ClientSequence mine = bench.offer(0);
  REQUIRE(bench.takes(Commit{1, {Bench::edit(1, 0, bench.own(mine))}}));
  CHECK(bench.violations().total() == 0);
  SECTION("not confirmed twice") {
    REQUIRE(bench.takes(Commit{1, {Bench::edit(2, 1, bench.own(mine))}}));
  }
  SECTION("not rejected after that") { bench.give(Reject{mine, RejectReason::busy, "", 0}); }
  SECTION("not one that was never made") {
    REQUIRE(bench.takes(Commit{1, {Bench::edit(2, 1, bench.own(mine + 5))}}));
  }
  CHECK(bench.violations().all().at("answer twice").count == 1);
}

TEST_CASE("a rejected edit is counted, and a commit of it is a violation", "[bots][headless]") {
  Bench bench;
  const ClientSequence mine = bench.offer(0);
  bench.give(Reject{mine, RejectReason::busy, "", 0});
  CHECK(bench.session->local_edits().counters().rejected == 1);
  CHECK(bench.session->local_edits().all().empty());
  CHECK(bench.violations().total() == 0);
  REQUIRE(bench.takes(Commit{1, {Bench::edit(1, 0, bench.own(mine))}}));
  CHECK(bench.violations().all().contains("answer twice"));
}

TEST_CASE("a durable watermark of another epoch, or a lower one, is a violation",
          "[bots][headless]") {
  Bench bench;
  bench.give(Durable{1, 5});
  bench.give(Durable{1, 5});
  CHECK(bench.violations().total() == 0);
  SECTION("back") { bench.give(Durable{1, 4}); }
  SECTION("another epoch") { bench.give(Durable{2, 9}); }
  CHECK(bench.violations().all().at("durable").count == 1);
}

TEST_CASE("a headless session offers edits again that the server has lost", "[bots][headless]") {
  Bench bench;
  const ClientSequence first = bench.offer(0), second = bench.offer(0), third = bench.offer(0);
  REQUIRE(bench.takes(Commit{1, {Bench::edit(1, 0, bench.own(first))}}));
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

TEST_CASE("chunks of one material become ground", "[bots][headless]") {
  Bench bench;
  bench.session->set_view({1, kSessionChunk, 0, 1});
  CHECK_FALSE(bench.session->loaded());
  bench.give(UniformChunks{2, {{{0, {0, -1, 0}}, 3, {}}, {{0, {0, 1, 0}}, kEmpty, {}}}});
  CHECK(bench.session->loaded());
  CHECK(bench.fleet.ground.chunks() == 3);
  CHECK(bench.fleet.ground.surface(1, 1) == kSessionEdge - 1);
}

TEST_CASE("a headless session checks that its view is complete", "[bots][headless]") {
  Bench bench;
  bench.give(ViewState{0, 1, ViewPhase::complete, false, 0, 0, ""});
  CHECK(bench.violations().total() == 0);
  bench.session->set_view({1, kSessionChunk, 0, 1});
  bench.give(ViewState{0, 2, ViewPhase::complete, false, 0, 0, ""});
  CHECK(bench.violations().all().contains("incomplete view"));
  CHECK_FALSE(bench.session->wants_close());
}

TEST_CASE("a headless session is not taken to the past", "[bots][headless]") {
  Bench bench;
  bench.give(ViewState{1, 1, ViewPhase::begins, true, 0, 0, ""});
  CHECK(bench.session->wants_close());
}

TEST_CASE("a message that was not requested ends the session with its reason", "[bots][headless]") {
  Bench bench;
  bench.give(CommandOutput{1, {}, true, true});
  CHECK(bench.session->wants_close());
  REQUIRE(bench.session->end().has_value());
  CHECK(bench.session->end()->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("a headless session takes new materials, and ends if they do not fit",
          "[bots][headless]") {
  Bench bench;
  const auto first = static_cast<Material>(default_material_table().size());
  const MaterialsAdded added{first, {{"lime", {1, 2, 3, 255}, Visibility::opaque}}};
  bench.give(added);
  CHECK(bench.session->wants_close());  // the feature is not in force
  CHECK(bench.session->end()->reason == GoodbyeReason::unexpected_message);
  bench.features = kFeatureMaterials;
  bench.session->disconnected();
  bench.greet(1, 0);
  bench.give(added);
  CHECK_FALSE(bench.session->wants_close());
  CHECK(bench.session->welcome()->materials.find("lime") == first);
  bench.give(added);
  CHECK(bench.session->end()->reason == GoodbyeReason::malformed_message);
}
