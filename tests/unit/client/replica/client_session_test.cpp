#include "client/replica/client_session.hpp"

#include <catch2/catch.hpp>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "tests/support/authority_model.hpp"
#include "tests/support/test_keys.hpp"

using namespace runstone;
using runstone::test::AuthorityModel;
using runstone::test::keys;

namespace {

constexpr std::int32_t kEdge = 16;
constexpr TimeUs kClockLead = 5'000'000;  // server clock minus client clock

SessionConfig config() {
  SessionConfig out;
  out.keys = keys(1);
  out.name = "ada";
  out.instance = 42;
  out.view = {{0, 0, 0}, 1, 1};
  return out;
}

/// The server's side, answered by hand.
struct Server {
  KeyPair own = keys(9);
  WorldId world_id{1, 2, 3};
  Hello hello;
  Welcome welcome;
  ClientSequence resolved = 0;
  AuthorityModel world{kEdge, 3};

  Welcome make_welcome() {
    welcome = {};
    welcome.world_id = world_id;
    welcome.epoch = world.epoch();
    welcome.durable = welcome.head = world.head();
    welcome.chunk_edge = kEdge;
    welcome.materials = default_material_table();
    welcome.server_key = own.public_key;
    welcome.challenge = {7};
    welcome.view_radius_max = 8;
    welcome.edit_volume_max = 1000;
    welcome.signature = sign(own, server_transcript(hello, welcome));
    return welcome;
  }
};

template <class T>
std::vector<T> take(std::vector<Message>& messages) {
  std::vector<T> out;
  for (const Message& message : messages) {
    if (const auto* wanted = std::get_if<T>(&message)) out.push_back(*wanted);
  }
  return out;
}

struct Fixture {
  void receive(Message message) { session.receive(std::move(message), {now, now, now}); }
  std::vector<Message> sent() { return session.take_outgoing(); }

  void greet() {
    session.connected({5}, now);
    auto out = sent();
    const auto hellos = take<Hello>(out);
    REQUIRE(hellos.size() == 1);
    server.hello = hellos[0];
  }
  std::vector<Message> open() {
    greet();
    receive(server.make_welcome());
    auto out = sent();
    const auto proofs = take<ClientAuth>(out);
    REQUIRE(proofs.size() == 1);
    CHECK(verify(server.hello.key, client_transcript(server.hello, server.welcome),
                 proofs[0].signature));
    receive(SessionAccepted{6, server.resolved});
    REQUIRE(session.is_open());
    return sent();
  }
  void pong() { receive(Pong{now - 200, now - 100 + kClockLead}); }

  Server server;
  ClientSession session{config()};
  TimeUs now = 1'000'000;
};

EditDescriptor set(VoxelPos at, Material material) { return {SetVoxel{at}, {}, material}; }

}  // namespace

TEST_CASE_METHOD(Fixture,
                 "a session opens by hello, welcome, proof and ready, then asks for its view",
                 "[replica]") {
  auto out = open();
  CHECK(server.hello.name == "ada");
  CHECK(server.hello.instance == 42);
  CHECK(server.hello.key == keys(1).public_key);
  const auto views = take<View>(out);
  REQUIRE(views.size() == 1);
  CHECK(views[0] == View{{0, 0, 0}, 1, 1});
  CHECK(take<Ping>(out).size() == 1);
  CHECK(session.author() == 6);
  CHECK(session.pinned().at(server.world_id) == server.own.public_key);
  CHECK_FALSE(session.loaded());
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (session.view().contains({x, y, z})) receive(server.world.snapshot({x, y, z}));
      }
    }
  }
  CHECK(session.view_chunks() == 15);
  CHECK(session.loaded());
}

TEST_CASE_METHOD(Fixture, "a view is loaded when each chunk came or is known to be unavailable",
                 "[replica]") {
  static_cast<void>(open());
  const ChunkKey damaged{0, {0, -1, 1}};
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const ChunkCoord at{x, y, z};
        if (session.view().contains(at) && at != damaged.at) receive(server.world.snapshot(at));
      }
    }
  }
  CHECK_FALSE(session.loaded());
  receive(ChunkUnavailable{{damaged}, UnavailableReason::damaged});
  CHECK(session.loaded());
  CHECK_FALSE(session.wants_close());
  session.disconnected();
  static_cast<void>(open());
  CHECK_FALSE(session.loaded());
}

TEST_CASE_METHOD(Fixture, "a session keeps to the heights and the volume that welcome announces",
                 "[replica]") {
  greet();
  Welcome welcome = server.make_welcome();
  welcome.heights = {-4, 4};
  welcome.edit_volume_max = 27;
  welcome.signature = sign(server.own, server_transcript(server.hello, welcome));
  receive(welcome);
  receive(SessionAccepted{6, 0});
  REQUIRE(session.is_open());
  CHECK(session.submit(set({0, 3, 0}, 1), now, now).has_value());
  CHECK_FALSE(session.submit(set({0, 4, 0}, 1), now, now).has_value());
  CHECK(session.submit({FillBox{{{0, 0, 0}, {3, 3, 3}}}, {}, 1}, now, now).has_value());
  CHECK_FALSE(session.submit({FillBox{{{0, 0, 0}, {4, 3, 3}}}, {}, 1}, now, now).has_value());
}

TEST_CASE_METHOD(Fixture, "features come from hello, and a server may not add any", "[replica]") {
  SessionConfig offering = config();
  offering.features = 0b110;
  session = ClientSession(offering);
  const auto answered = [&](std::uint64_t features) {
    greet();
    CHECK(server.hello.features == 0b110);
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature = sign(server.own, server_transcript(server.hello, welcome));
    receive(welcome);
    return !session.wants_close();
  };
  CHECK(answered(0));
  CHECK(answered(0b010));
  CHECK_FALSE(answered(0b011));
  CHECK(session.end()->reason == GoodbyeReason::malformed_message);
}

TEST_CASE_METHOD(Fixture, "a server that cannot prove its key is refused", "[replica]") {
  greet();
  Welcome welcome = server.make_welcome();
  welcome.epoch += 1;  // signed something else
  receive(welcome);
  CHECK(session.wants_close());
  REQUIRE(session.end());
  CHECK(session.end()->final);
  CHECK_FALSE(session.end()->by_server);
  CHECK(session.end()->reason == GoodbyeReason::not_authenticated);
  auto out = sent();
  CHECK(take<ClientAuth>(out).empty());
  CHECK(take<Goodbye>(out).size() == 1);
}

TEST_CASE_METHOD(Fixture, "a server key other than the pinned one is refused", "[replica]") {
  SessionConfig pinned = config();
  pinned.pinned[server.world_id] = keys(8).public_key;
  session = ClientSession(pinned);
  greet();
  receive(server.make_welcome());
  CHECK(session.wants_close());
  REQUIRE(session.end());
  CHECK(session.end()->final);
}

TEST_CASE_METHOD(Fixture, "messages out of turn end the session", "[replica]") {
  const auto refused = [&](Message message) {
    session = ClientSession(config());
    greet();
    receive(std::move(message));
    return session.wants_close();
  };
  CHECK(refused(SessionAccepted{1, 0}));
  CHECK(refused(Durable{1, 1}));
  CHECK(refused(Hello{}));
  session = ClientSession(config());
  static_cast<void>(open());
  receive(Ping{});
  CHECK(session.wants_close());
}

TEST_CASE_METHOD(Fixture,
                 "edits wait for the clock offset and carry the server's time of the click",
                 "[replica]") {
  static_cast<void>(open());
  const auto seq = session.submit(set({1, 2, 3}, 4), now - 300, now);
  REQUIRE(seq.has_value());
  auto out = sent();
  CHECK(take<EditRequest>(out).empty());
  pong();
  session.tick(now);
  out = sent();
  const auto edits = take<EditRequest>(out);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].client_seq == 1);
  CHECK(edits[0].submitted_us == now - 300 + kClockLead);
  CHECK(edits[0].edit == set({1, 2, 3}, 4));
  // From now on they go at once.
  REQUIRE(session.submit(set({1, 2, 3}, 5), now, now).has_value());
  out = sent();
  CHECK(take<EditRequest>(out).size() == 1);
}

TEST_CASE_METHOD(Fixture, "without any pong edits go after a while with an unknown time",
                 "[replica]") {
  static_cast<void>(open());
  REQUIRE(session.submit(set({1, 2, 3}, 4), now, now).has_value());
  now += kOffsetWaitUsMax;
  session.tick(now);
  auto out = sent();
  const auto edits = take<EditRequest>(out);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].submitted_us == 0);
}

TEST_CASE_METHOD(Fixture, "an unknown material is refused before it is shown", "[replica]") {
  static_cast<void>(open());
  const auto last = static_cast<Material>(default_material_table().size());
  CHECK_FALSE(session.submit(set({1, 2, 3}, last), now, now).has_value());
  // In the mask and in a clipboard, too.
  const auto masked = [](Material material) {
    return EditDescriptor{SetVoxel{{1, 2, 3}}, {MaskKind::only_material, material}, 1};
  };
  CHECK_FALSE(session.submit(masked(last), now, now).has_value());
  const auto paste = [](Material material) {
    ClipboardBuilder cells({2, 1, 1});
    cells.append(1, Material{1});
    cells.append(1, material);
    return EditDescriptor{Paste{{1, 2, 3}, *cells.finish(), {}}, {}, kEmpty};
  };
  CHECK_FALSE(session.submit(paste(last), now, now).has_value());
  CHECK_FALSE(session.submit({Paste{}, {}, kEmpty}, now, now).has_value());  // no clipboard at all
  CHECK(session.replica().local_edits().all().empty());
  const auto known = static_cast<Material>(last - 1);
  CHECK(session.submit(masked(known), now, now).has_value());
  CHECK(session.submit(paste(known), now, now).has_value());
}

TEST_CASE_METHOD(Fixture,
                 "after a cut the undecided edits are offered again in order, before newer ones",
                 "[replica]") {
  static_cast<void>(open());
  pong();
  for (int i = 0; i < 3; ++i) REQUIRE(session.submit(set({i, 2, 3}, 4), now, now).has_value());
  static_cast<void>(sent());
  session.disconnected();
  REQUIRE(session.submit(set({9, 2, 3}, 4), now, now).has_value());  // while away
  CHECK(sent().empty());
  server.resolved = 1;
  auto out = open();
  const auto edits = take<EditRequest>(out);
  REQUIRE(edits.size() == 4);
  CHECK(edits[0].client_seq == 1);  // decided, but how? The server answers or ignores it
  CHECK(edits[1].client_seq == 2);
  CHECK(edits[2].client_seq == 3);
  CHECK(edits[3].client_seq == 4);
  CHECK(session.connect_count() == 2);
}

TEST_CASE_METHOD(Fixture, "a restarted server has another clock", "[replica]") {
  static_cast<void>(open());
  pong();
  CHECK(session.clock().known());
  session.disconnected();
  static_cast<void>(open());
  CHECK(session.clock().known());
  session.disconnected();
  server.world.restart({});
  static_cast<void>(open());
  CHECK_FALSE(session.clock().known());
}

TEST_CASE_METHOD(Fixture, "another world under the same address starts from nothing", "[replica]") {
  static_cast<void>(open());
  receive(server.world.snapshot({0, 0, 0}));
  REQUIRE(session.submit(set({1, 2, 3}, 4), now, now).has_value());
  session.disconnected();
  server.world_id = {9};
  auto out = open();
  CHECK(session.replica().confirmed_count() == 0);
  CHECK(session.replica().local_edits().all().empty());
  CHECK(take<EditRequest>(out).empty());
}

TEST_CASE_METHOD(Fixture, "a gap is asked for with the next tick", "[replica]") {
  static_cast<void>(open());
  receive(server.world.snapshot({0, 0, 0}));
  static_cast<void>(server.world.commit({9, 1, 1}, set({1, 1, 1}, 2)));
  receive(server.world.commit({9, 1, 2}, set({2, 1, 1}, 2)));
  session.tick(now);
  auto out = sent();
  const auto requests = take<ChunkRequest>(out);
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].keys == std::vector<ChunkKey>{{0, {0, 0, 0}}});
}

TEST_CASE_METHOD(Fixture,
                 "an edit rejected as bad_edit is not offered again, not even after a reconnection",
                 "[replica]") {
  static_cast<void>(open());
  pong();
  REQUIRE(session.submit(set({1, 2, 3}, 4), now, now).has_value());
  auto out = sent();
  REQUIRE(take<EditRequest>(out).size() == 1);
  receive(Reject{1, RejectReason::bad_edit, "unknown edit kind (at byte 0)", 0});
  now += 10 * kAnswerUsMax;
  pong();
  session.tick(now);
  out = sent();
  CHECK(take<EditRequest>(out).empty());
  session.disconnected();
  server.resolved = 0;  // a restarted server has forgotten the rejection
  out = open();
  CHECK(take<EditRequest>(out).empty());
  pong();
  session.tick(now + kOffsetWaitUsMax);
  out = sent();
  CHECK(take<EditRequest>(out).empty());
}

TEST_CASE_METHOD(Fixture,
                 "an edit without an answer is offered again after a while, once per while",
                 "[replica]") {
  static_cast<void>(open());
  pong();
  REQUIRE(session.submit(set({1, 2, 3}, 4), now, now).has_value());
  static_cast<void>(sent());
  now += kAnswerUsMax - 1;
  pong();
  session.tick(now);
  auto out = sent();
  CHECK(take<EditRequest>(out).empty());
  now += 1;
  session.tick(now);
  out = sent();
  CHECK(take<EditRequest>(out).size() == 1);
  session.tick(now + 1);
  out = sent();
  CHECK(take<EditRequest>(out).empty());
}

TEST_CASE_METHOD(Fixture, "the wished view is cut to the server's limit and sent when it changes",
                 "[replica]") {
  static_cast<void>(open());
  session.set_view({{1, 0, 0}, 60, 60});
  auto out = sent();
  auto views = take<View>(out);
  REQUIRE(views.size() == 1);
  CHECK(views[0] == View{{1, 0, 0}, 8, 8});
  session.set_view({{1, 0, 0}, 60, 60});
  out = sent();
  CHECK(take<View>(out).empty());
}

TEST_CASE_METHOD(Fixture, "poses go out when they change, at most twenty a second", "[replica]") {
  static_cast<void>(open());
  Pose pose;
  pose.at = {1, 2, 3};
  session.set_pose(pose);
  now += kMoveEveryUs;
  session.tick(now);
  auto out = sent();
  CHECK(take<Move>(out).size() == 1);
  now += kMoveEveryUs;
  session.tick(now);
  out = sent();
  CHECK(take<Move>(out).empty());
  pose.yaw = 5;
  session.set_pose(pose);
  session.tick(now);
  pose.yaw = 6;
  session.set_pose(pose);
  session.tick(now + 1);
  out = sent();
  CHECK(take<Move>(out).size() == 1);
}

TEST_CASE_METHOD(Fixture, "the others come with the roster and move with their poses",
                 "[replica]") {
  static_cast<void>(open());
  receive(PlayerList{{{6, "ada"}, {7, "bob"}}, false, {}});
  REQUIRE(session.others().size() == 1);
  CHECK(session.others().at(7).name == "bob");
  Pose pose;
  pose.at = {4, 5, 6};
  receive(PlayerPoses{{{7, pose}, {6, pose}}});
  CHECK(session.others().at(7).pose == pose);
  CHECK(session.others().size() == 1);
  receive(PlayerList{{{6, "ada"}, {7, "bob"}, {8, "eve"}}, false, {}});
  CHECK(session.others().at(7).pose == pose);
  receive(PlayerList{{{9, "mallory"}, {8, "eva"}}, true, {7}});
  REQUIRE(session.others().size() == 2);
  CHECK(session.others().at(8).name == "eva");
  CHECK(session.others().at(9).name == "mallory");
  receive(PlayerPoses{{{9, pose}}});
  receive(PlayerList{{{9, "trudy"}}, true, {}});
  CHECK(session.others().at(9).pose == pose);
  CHECK(session.others().size() == 2);
  receive(PlayerList{{{6, "ada"}}, false, {}});
  CHECK(session.others().empty());
}

TEST_CASE_METHOD(Fixture,
                 "a silent server and a goodbye both end the connection, the former not for good",
                 "[replica]") {
  static_cast<void>(open());
  session.tick(now + kServerSilenceUsMax + 1);
  CHECK(session.wants_close());
  CHECK_FALSE(session.end()->final);
  session.disconnected();
  static_cast<void>(open());
  CHECK_FALSE(session.end());
  receive(Goodbye{GoodbyeReason::closing, "restarting"});
  CHECK(session.wants_close());
  CHECK(session.end()->by_server);
  CHECK(session.end()->text == "restarting");
  CHECK_FALSE(session.end()->final);
}

namespace {

/// All chunks of the fixture's view.
std::vector<ChunkKey> view_keys(const ClientSession& session) {
  std::vector<ChunkKey> keys;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (session.view().contains({x, y, z})) keys.push_back({0, {x, y, z}});
      }
    }
  }
  return keys;
}

}  // namespace

TEST_CASE_METHOD(
    Fixture,
    "what was kept over a cut is claimed before the view, and called the same it is loaded",
    "[replica]") {
  static_cast<void>(open());
  for (const ChunkKey& key : view_keys(session)) receive(server.world.snapshot(key.at));
  REQUIRE(session.loaded());
  session.disconnected();
  auto out = open();
  REQUIRE(out.size() >= 2);
  REQUIRE(std::holds_alternative<CachedChunks>(out[0]));
  CHECK(std::holds_alternative<View>(out[1]));
  const auto& held = std::get<CachedChunks>(out[0]).chunks;
  REQUIRE(held.size() == 15);
  CHECK(held[0].digest == claim_digest(server.world.chunk(held[0].key.at).digest));
  CHECK_FALSE(session.loaded());
  ChunksNotModified same;
  for (const CachedChunk& chunk : held) same.chunks.push_back({chunk.key, chunk.version.seq});
  receive(same);
  CHECK(session.loaded());
  // Nothing is claimed twice.
  session.set_view({{0, 0, 0}, 2, 1});
  auto more = sent();
  CHECK(take<CachedChunks>(more).empty());
}

TEST_CASE_METHOD(Fixture, "chunks that a restarted server may have lost are not claimed",
                 "[replica]") {
  static_cast<void>(open());
  for (const ChunkKey& key : view_keys(session)) receive(server.world.snapshot(key.at));
  receive(server.world.commit({9, 1, 1}, set({1, 1, 1}, 2)));  // never durable
  session.disconnected();
  server.world.restart({});
  auto out = open();
  const auto held = take<CachedChunks>(out);
  REQUIRE(held.size() == 1);
  CHECK(held[0].chunks.size() == 14);
}

TEST_CASE_METHOD(Fixture, "the view waits for the cache, but not for long", "[replica]") {
  SessionConfig caching = config();
  caching.has_cache = true;
  session = ClientSession(caching);
  auto out = open();
  CHECK(take<View>(out).empty());
  auto question = session.take_question();
  REQUIRE(question.has_value());
  CHECK(question->keys == view_keys(session));
  CHECK(question->world.id == server.world_id);
  CHECK_FALSE(session.take_question().has_value());
  const ChunkKey key{0, {0, -1, 0}};
  SECTION("its answer is shown and claimed, and the view follows") {
    session.answer({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}}, now);
    CHECK(session.replica().shown(key) != nullptr);
    out = sent();
    REQUIRE(take<CachedChunks>(out).size() == 1);
    CHECK(take<CachedChunks>(out)[0].chunks.size() == 1);
    CHECK(take<View>(out).size() == 1);
    // It is kept in the cache as it is: only others are to be written.
    for (const ChunkKey& other : view_keys(session)) receive(server.world.snapshot(other.at));
    CHECK(session.replica().take_unkept(100).size() == 14);
    CHECK(session.replica().take_unkept(100).empty());
    receive(server.world.commit({9, 1, 1}, set({1, -2, 1}, 2)));
    const auto unkept = session.replica().take_unkept(100);
    REQUIRE(unkept.size() == 1);
    CHECK(unkept[0].first == key);
    // What leaves the view is kept as it was.
    receive(server.world.commit({9, 1, 2}, set({1, -2, 1}, 3)));
    session.set_view({{50, 0, 0}, 0, 0});
    const auto left = session.replica().take_unkept(100);
    REQUIRE(left.size() == 1);
    CHECK(left[0].second->version.seq == 2);
  }
  SECTION(
      "without an answer the view goes out after a while, and a late answer counts all the same") {
    now += kCacheWaitUsMax;
    receive(Pong{0, 0});
    session.tick(now);
    out = sent();
    CHECK(take<View>(out).size() == 1);
    session.answer({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}}, now);
    out = sent();
    CHECK(take<CachedChunks>(out).size() == 1);
  }
  SECTION("an answer to an earlier connection is not taken for one of this") {
    session.disconnected();
    server.world_id = {9};
    out = open();
    REQUIRE(session.take_question().has_value());
    session.answer({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}}, now);
    CHECK(session.replica().shown(key) == nullptr);
    out = sent();
    CHECK(take<View>(out).empty());
    session.answer({}, now);
    out = sent();
    CHECK(take<View>(out).size() == 1);
  }
}

TEST_CASE_METHOD(Fixture, "missing edits bring a copy up to date, from wherever it stands",
                 "[replica]") {
  static_cast<void>(open());
  const ChunkKey key{0, {0, 0, 0}};
  receive(server.world.snapshot(key.at));
  session.disconnected();
  ChunkEdits update{key, 0, {}, {}, {}};
  std::vector<Commit> commits;
  for (Sequence seq = 1; seq <= 3; ++seq) {
    const auto edit = set({static_cast<int>(seq), 1, 1}, static_cast<Material>(seq));
    commits.push_back(server.world.commit({9, 1, seq}, edit));
    update.edits.push_back({seq, edit});
  }
  update.to = server.world.chunk(key.at).version;
  update.digest = server.world.chunk(key.at).digest;
  static_cast<void>(open());
  const auto is_newest = [&] {
    const ChunkPtr held = session.replica().confirmed(key);
    return held->version == update.to && digest_of(held->voxels) == update.digest;
  };
  SECTION("from the version claimed") {
    receive(update);
    CHECK(is_newest());
    CHECK(session.replica().counters().updates_taken == 1);
  }
  SECTION("a commit that overtook them has led part of the way") {
    receive(commits[0]);
    receive(update);
    CHECK(is_newest());
  }
  SECTION("commits that follow came before them") {
    const Commit next = server.world.commit({9, 1, 4}, set({9, 9, 9}, 4));
    receive(next);
    receive(update);
    CHECK(session.replica().confirmed(key)->version.seq == 4);
    CHECK(session.replica().confirmed(key)->digest == server.world.chunk(key.at).digest);
  }
  SECTION(
      "edits that start elsewhere, or end in another digest, are not taken: the chunk is asked "
      "for") {
    const bool starts_elsewhere = GENERATE(true, false);
    if (starts_elsewhere) {
      update.from = 1;
      update.edits.erase(update.edits.begin());
    } else {
      update.digest.lane[0] ^= 1;
    }
    receive(update);
    CHECK(session.replica().confirmed(key)->version.seq == 0);
    session.tick(now);
    auto out = sent();
    CHECK(take<ChunkRequest>(out).size() == 1);
    receive(server.world.snapshot(key.at));
    CHECK(session.replica().confirmed(key)->version == server.world.chunk(key.at).version);
  }
  SECTION("the same, of a newer version than is held, is not believed") {
    receive(ChunksNotModified{{{key, 2}}});
    session.tick(now);
    auto out = sent();
    CHECK(take<ChunkRequest>(out).size() == 1);
  }
}
