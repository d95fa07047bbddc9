#include "client/session/client_session.hpp"

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "tests/unit/client/session/session_bench.hpp"

using namespace runstone;
using namespace runstone::test::session_bench;
using runstone::test::keys;

TEST_CASE_METHOD(SessionBench, "a session opens with the handshake and then sends its view",
                 "[session]") {
  auto out = open();
  CHECK(server.hello.name == "ada");
  CHECK(server.hello.instance == 42);
  CHECK(server.hello.key == keys(1).public_key);
  const auto views = take<View>(out);
  REQUIRE(views.size() == 1);
  CHECK(views[0] == View{1, {0, 0, 0}, 1, 1});
  CHECK(take<Ping>(out).size() == 1);
  CHECK(session.author() == 6);
  CHECK(session.pinned().at(server.world_id) == server.keys_of_server.public_key);
  CHECK_FALSE(session.loaded());
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (session.view().contains({x, y, z}))
          receive(chunks_of(server.world.snapshot({x, y, z})));
      }
    }
  }
  CHECK(session.view_chunks() == 15);
  CHECK(session.loaded());
}

TEST_CASE_METHOD(SessionBench, "a view at the border of the world is loaded without chunks beyond",
                 "[session]") {
  static_cast<void>(open());
  const std::int32_t top = kWorldLimit / kEdge - 1;
  session.set_view({2, {0, top, 0}, 0, 1});
  REQUIRE(take<View>(sent()).size() == 1);
  receive(chunks_of(server.world.snapshot({0, top, 0}), 2));
  CHECK_FALSE(session.loaded());
  receive(chunks_of(server.world.snapshot({0, top - 1, 0}), 2));
  CHECK(session.view_chunks() == 2);
  CHECK(session.loaded());
}

TEST_CASE_METHOD(SessionBench, "a view is loaded when each chunk arrived or is unavailable",
                 "[session]") {
  static_cast<void>(open());
  const ChunkKey damaged{0, {0, -1, 1}};
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const ChunkCoord at{x, y, z};
        if (session.view().contains(at) && at != damaged.at)
          receive(chunks_of(server.world.snapshot(at)));
      }
    }
  }
  CHECK_FALSE(session.loaded());
  receive(ChunkUnavailable{1, {damaged}, UnavailableReason::damaged});
  CHECK(session.loaded());
  CHECK_FALSE(session.wants_close());
  session.disconnected();
  static_cast<void>(open());
  CHECK_FALSE(session.loaded());
}

TEST_CASE_METHOD(SessionBench,
                 "a session refuses edits beyond the heights and the volume in the welcome",
                 "[session]") {
  greet();
  Welcome welcome = server.make_welcome();
  welcome.heights = {-4, 4};
  welcome.edit_volume_max = 27;
  welcome.signature =
      sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
  receive(welcome);
  receive(SessionAccepted{6, 0});
  REQUIRE(session.is_open());
  CHECK(session.offer(set({0, 3, 0}, 1), now, now).has_value());
  CHECK_FALSE(session.offer(set({0, 4, 0}, 1), now, now).has_value());
  CHECK(session.offer({FillBox{{{0, 0, 0}, {3, 3, 3}}}, {}, 1}, now, now).has_value());
  CHECK_FALSE(session.offer({FillBox{{{0, 0, 0}, {4, 3, 3}}}, {}, 1}, now, now).has_value());
}

TEST_CASE_METHOD(SessionBench, "a welcome with a feature that hello did not offer is rejected",
                 "[session]") {
  SessionConfig offering = config();
  offering.features = 0b110;
  session = ClientSession(offering);
  const auto answered = [&](std::uint64_t features) {
    greet();
    CHECK(server.hello.features == 0b110);
    Welcome welcome = server.make_welcome();
    welcome.features = features;
    welcome.signature =
        sign(server.keys_of_server, server_transcript(server.hello, welcome, std::nullopt));
    receive(welcome);
    return !session.wants_close();
  };
  CHECK(answered(0));
  CHECK(answered(0b010));
  CHECK_FALSE(answered(0b011));
  CHECK(session.end()->reason == GoodbyeReason::malformed_message);
}

TEST_CASE_METHOD(SessionBench, "a server that cannot prove its key is refused", "[session]") {
  greet();
  Welcome welcome = server.make_welcome();
  welcome.epoch += 1;  // not what was signed
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

TEST_CASE_METHOD(SessionBench, "a server key other than the pinned one is refused", "[session]") {
  SessionConfig pinned = config();
  pinned.pinned[server.world_id] = keys(8).public_key;
  session = ClientSession(pinned);
  greet();
  receive(server.make_welcome());
  CHECK(session.wants_close());
  REQUIRE(session.end());
  CHECK(session.end()->final);
}

TEST_CASE_METHOD(SessionBench, "messages in the wrong state end the session", "[session]") {
  const auto refused = [&](Message message) {
    session = ClientSession(config());
    greet();
    receive(std::move(message));
    return session.wants_close();
  };
  CHECK(refused(SessionAccepted{1, 0}));
  CHECK(refused(Durable{1, 1}));
  CHECK(refused(Hello{}));
  const auto refused_early = [&](Message message) {
    session = ClientSession(config());
    greet();
    receive(server.make_welcome());
    receive(std::move(message));
    return session.wants_close();
  };
  CHECK(refused_early(chunks_of(server.world.snapshot({0, 0, 0}))));  // no view was sent
  CHECK_FALSE(refused_early(Durable{3, 0}));  // SessionAccepted was overtaken
  session = ClientSession(config());
  static_cast<void>(open());
  receive(Ping{});
  CHECK(session.wants_close());
}

TEST_CASE_METHOD(SessionBench,
                 "edits wait for the clock offset and carry the server's time of the click",
                 "[session]") {
  static_cast<void>(open());
  const auto seq = session.offer(set({1, 2, 3}, 4), now - 300, now);
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
  // From now on edits are sent at once.
  REQUIRE(session.offer(set({1, 2, 3}, 5), now, now).has_value());
  out = sent();
  CHECK(take<EditRequest>(out).size() == 1);
}

TEST_CASE_METHOD(SessionBench,
                 "without a pong edits are sent after kOffsetWaitUsMax, with an unknown time",
                 "[session]") {
  static_cast<void>(open());
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
  now += kOffsetWaitUsMax;
  session.tick(now);
  auto out = sent();
  const auto edits = take<EditRequest>(out);
  REQUIRE(edits.size() == 1);
  CHECK(edits[0].submitted_us == 0);
}

TEST_CASE_METHOD(SessionBench, "an unknown material is refused before it is shown", "[session]") {
  static_cast<void>(open());
  const auto last = static_cast<Material>(default_material_table().size());
  CHECK_FALSE(session.offer(set({1, 2, 3}, last), now, now).has_value());
  // The same in the mask and in a clipboard.
  const auto masked = [](Material material) {
    return EditDescriptor{SetVoxel{{1, 2, 3}}, {MaskKind::only_material, material}, 1};
  };
  CHECK_FALSE(session.offer(masked(last), now, now).has_value());
  const auto paste = [](Material material) {
    ClipboardBuilder cells({2, 1, 1});
    cells.append(1, Material{1});
    cells.append(1, material);
    return EditDescriptor{Paste{{1, 2, 3}, *cells.finish(), {}}, {}, kEmpty};
  };
  CHECK_FALSE(session.offer(paste(last), now, now).has_value());
  CHECK_FALSE(session.offer({Paste{}, {}, kEmpty}, now, now).has_value());  // without a clipboard
  CHECK(session.replica().local_edits().all().empty());
  const auto known = static_cast<Material>(last - 1);
  CHECK(session.offer(masked(known), now, now).has_value());
  CHECK(session.offer(paste(known), now, now).has_value());
}

TEST_CASE_METHOD(SessionBench,
                 "after a reconnection pending edits are sent again in order, before newer ones",
                 "[session]") {
  static_cast<void>(open());
  pong();
  for (int i = 0; i < 3; ++i) REQUIRE(session.offer(set({i, 2, 3}, 4), now, now).has_value());
  static_cast<void>(sent());
  session.disconnected();
  REQUIRE(session.offer(set({9, 2, 3}, 4), now, now).has_value());  // while disconnected
  CHECK(sent().empty());
  server.resolved = 1;
  auto out = open();
  const auto edits = take<EditRequest>(out);
  REQUIRE(edits.size() == 4);
  CHECK(edits[0].client_seq == 1);  // resolved: sent again to get the answer
  CHECK(edits[1].client_seq == 2);
  CHECK(edits[2].client_seq == 3);
  CHECK(edits[3].client_seq == 4);
  CHECK(session.connect_count() == 2);
}

TEST_CASE_METHOD(SessionBench, "a restarted server has another clock", "[session]") {
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

TEST_CASE_METHOD(SessionBench, "another world at the same address starts with an empty replica",
                 "[session]") {
  static_cast<void>(open());
  receive(chunks_of(server.world.snapshot({0, 0, 0})));
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
  session.disconnected();
  server.world_id = {9};
  auto out = open();
  CHECK(session.replica().confirmed_count() == 0);
  CHECK(session.replica().local_edits().all().empty());
  CHECK(take<EditRequest>(out).empty());
}

TEST_CASE_METHOD(SessionBench, "a chunk with a gap is requested with the next tick", "[session]") {
  static_cast<void>(open());
  receive(chunks_of(server.world.snapshot({0, 0, 0})));
  static_cast<void>(server.world.commit({9, 1, 1}, set({1, 1, 1}, 2)));
  receive(server.world.commit({9, 1, 2}, set({2, 1, 1}, 2)));
  session.tick(now);
  auto out = sent();
  const auto requests = take<ChunkRequest>(out);
  REQUIRE(requests.size() == 1);
  CHECK(requests[0].keys == std::vector<ChunkKey>{{0, {0, 0, 0}}});
}

TEST_CASE_METHOD(SessionBench,
                 "an edit rejected as bad_edit is not offered again, not even after a reconnection",
                 "[session]") {
  static_cast<void>(open());
  pong();
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
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

TEST_CASE_METHOD(
    SessionBench,
    "an edit that the server lost and is too busy to take again is submitted until it is "
    "taken",
    "[session]") {
  static_cast<void>(open());
  pong();
  const EditDescriptor edit = set({1, 2, 3}, 4);
  REQUIRE(session.offer(edit, now, now).has_value());
  receive(server.world.commit(session.operation(1), edit));
  REQUIRE(session.replica().local_edits().find(1)->state == LocalEditState::confirmed);
  session.disconnected();
  now += 1'000;
  // The server ended before the edit was on disk.
  server.world = runstone::test::AuthorityModel{kEdge, 4};
  static_cast<void>(open());
  pong();
  session.tick(now);
  static_cast<void>(sent());
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    receive(Reject{seq, seq == 2 ? RejectReason::rate_limited : RejectReason::busy, "", 0});
    session.tick(now);
    auto out = sent();
    CHECK(take<EditRequest>(out).empty());
    now += LostEdits::kAgainUs;
    pong();
    session.tick(now);
    out = sent();
    const auto again = take<EditRequest>(out);
    REQUIRE(again.size() == 1);
    CHECK(again[0].client_seq == seq + 1);
    CHECK(again[0].edit == edit);
  }
  receive(server.world.commit(session.operation(4), edit));
  now += 2 * LostEdits::kAgainUs;
  pong();
  session.tick(now);
  auto out = sent();
  CHECK(take<EditRequest>(out).empty());
}

TEST_CASE_METHOD(SessionBench,
                 "edits made without a connection that exceed the budget are submitted again",
                 "[session]") {
  static_cast<void>(open());
  session.disconnected();
  now += 1'000;
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
  now += 1'000;
  static_cast<void>(open());
  pong();
  session.tick(now);
  auto out = sent();
  REQUIRE(take<EditRequest>(out).size() == 1);
  receive(Reject{1, RejectReason::rate_limited, "", 0});
  now += LostEdits::kAgainUs;
  pong();
  session.tick(now);
  out = sent();
  REQUIRE(take<EditRequest>(out).size() == 1);
  CHECK(take<EditRequest>(out)[0].client_seq == 2);
}

TEST_CASE_METHOD(SessionBench, "a session knows whether its server is read-only", "[session]") {
  static_cast<void>(open());
  CHECK_FALSE(session.is_server_read_only());
  receive(Durable{server.world.epoch(), server.world.head(), true});
  CHECK(session.is_server_read_only());
  receive(Durable{server.world.epoch(), server.world.head(), false});
  CHECK_FALSE(session.is_server_read_only());
  receive(Durable{server.world.epoch(), server.world.head(), true});
  session.disconnected();
  static_cast<void>(open());
  CHECK_FALSE(session.is_server_read_only());
}

TEST_CASE_METHOD(SessionBench, "an edit of this connection that is rejected busy is given up",
                 "[session]") {
  static_cast<void>(open());
  pong();
  now += 1'000;
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
  static_cast<void>(sent());
  receive(Reject{1, RejectReason::busy, "", 0});
  now += 2 * LostEdits::kAgainUs;
  pong();
  session.tick(now);
  auto out = sent();
  CHECK(take<EditRequest>(out).empty());
  CHECK(session.replica().drain_changes().rejects.size() == 1);
}

TEST_CASE_METHOD(SessionBench, "an edit without an answer is sent again once per kAnswerUsMax",
                 "[session]") {
  static_cast<void>(open());
  pong();
  REQUIRE(session.offer(set({1, 2, 3}, 4), now, now).has_value());
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

TEST_CASE_METHOD(SessionBench,
                 "the requested view is limited by the server and sent when it changes",
                 "[session]") {
  static_cast<void>(open());
  session.set_view({1, {1, 0, 0}, 60, 60});
  auto out = sent();
  auto views = take<View>(out);
  REQUIRE(views.size() == 1);
  CHECK(views[0] == View{2, {1, 0, 0}, 8, 8});
  session.set_view({1, {1, 0, 0}, 60, 60});
  out = sent();
  CHECK(take<View>(out).empty());
}

TEST_CASE_METHOD(SessionBench, "an answer to a view before the chunk left and came back is ignored",
                 "[session]") {
  static_cast<void>(open());
  session.set_view({1, {9, 0, 0}, 1, 1});
  session.set_view({1, {0, 0, 0}, 1, 1});
  auto out = sent();
  const auto views = take<View>(out);
  REQUIRE(views.size() == 2);
  CHECK(views[0].number == 2);
  CHECK(views[1].number == 3);
  const ChunkKey key{0, {0, 0, 0}};
  receive(chunks_of(server.world.snapshot(key.at), 1));
  CHECK(session.replica().confirmed(key) == nullptr);
  receive(chunks_of(server.world.snapshot(key.at), 3));
  CHECK(session.replica().confirmed(key) != nullptr);
}

TEST_CASE_METHOD(SessionBench, "view states show a moment of the past and the live world again",
                 "[session]") {
  static_cast<void>(open());
  receive(ViewState{0, 1, ViewPhase::complete, false, 0, 0, ""});
  CHECK_FALSE(session.wants_close());
  CHECK_FALSE(session.loading_history());
  const auto state = [&](std::uint32_t request, ViewPhase phase, bool past, Sequence seq) {
    receive(ViewState{request, 1, phase, past, seq, past ? 77 : 0, ""});
  };
  REQUIRE(session.request_history({1, HistoryTarget::sequence, 5, 0}).has_value());
  state(1, ViewPhase::begins, true, 5);
  CHECK(session.loading_history());
  REQUIRE(session.replica().past().has_value());
  CHECK(session.replica().past()->seq == 5);
  CHECK(session.replica().past()->utc_us == 77);
  state(1, ViewPhase::complete, true, 5);
  CHECK_FALSE(session.loading_history());
  REQUIRE(session.request_history({}).has_value());
  state(1, ViewPhase::complete, true, 5);  // of another view, before the request was answered
  CHECK(session.loading_history());
  CHECK(session.replica().past().has_value());
  state(2, ViewPhase::begins, false, 0);
  CHECK(session.loading_history());
  CHECK_FALSE(session.replica().past().has_value());
  state(2, ViewPhase::complete, false, 0);
  CHECK_FALSE(session.loading_history());
}

TEST_CASE_METHOD(SessionBench, "poses are sent when they change, at most twenty a second",
                 "[session]") {
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

TEST_CASE_METHOD(SessionBench, "other players come from the player list and their poses",
                 "[session]") {
  static_cast<void>(open());
  receive(PlayerList{{{6, "ada", {}}, {7, "bob", {}}}, false, {}});
  REQUIRE(session.others().size() == 1);
  CHECK(session.others().at(7).name == "bob");
  Pose pose;
  pose.at = {4, 5, 6};
  receive(PlayerPoses{{{7, pose}, {6, pose}}});
  CHECK(session.others().at(7).pose == pose);
  CHECK(session.others().size() == 1);
  receive(PlayerList{{{6, "ada", {}}, {7, "bob", {}}, {8, "eve", {}}}, false, {}});
  CHECK(session.others().at(7).pose == pose);
  receive(PlayerList{{{9, "mallory", {}}, {8, "eva", {}}}, true, {7}});
  REQUIRE(session.others().size() == 2);
  CHECK(session.others().at(8).name == "eva");
  CHECK(session.others().at(9).name == "mallory");
  receive(PlayerPoses{{{9, pose}}});
  receive(PlayerList{{{9, "trudy", {}}}, true, {}});
  CHECK(session.others().at(9).pose == pose);
  CHECK(session.others().size() == 2);
  receive(PlayerList{{{6, "ada", {}}}, false, {}});
  CHECK(session.others().empty());
}

TEST_CASE_METHOD(SessionBench,
                 "a silent server and a goodbye end the connection; silence is not final",
                 "[session]") {
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
