// What the owner of a world does for the servers that follow it.
#include "server/world/cluster/followers.hpp"

#include <catch2/catch.hpp>

#include "tests/support/textures/test_png.hpp"
#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

constexpr SessionId kLink = 50;

SetVoxel at_x(std::int32_t x) { return {{x, 1, 1}}; }

/// Does the handshake with this key and these features. Returns those in force.
std::uint64_t handshake(WorldBench& bench, SessionId session, std::uint8_t who,
                        std::uint64_t features) {
  bench.server.connected(session, bench.now());
  Hello hello = bench.hello(who);
  hello.features = features;
  hello.instance = session;
  bench.server.received(session, hello, bench.now());
  const auto welcome = bench.environment.messages<Welcome>(session, 0);
  REQUIRE(welcome.size() == 1);
  bench.server.received(session, bench.client_auth(who, hello, welcome[0]), bench.now());
  return welcome[0].features;
}

constexpr std::uint8_t kWorldKey = 200;  // the seed of config()

RelayOpen open_of(std::uint8_t who, SessionId session = 1) {
  RelayOpen open;
  open.session = session;
  open.key = key_pair_of(seed_of(who)).public_key;
  open.instance = 1;
  open.name = "player" + std::to_string(who);
  return open;
}

/// Returns the message of this kind that was relayed last to a session of the follower.
template <class Kind>
std::optional<Kind> relayed(const WorldBench& bench, SessionId session) {
  std::optional<Kind> found;
  for (const Relay& relay : bench.environment.messages<Relay>(kLink, kEdge)) {
    if (relay.message.kind != kKindOf<Kind>) continue;
    if (std::ranges::count(relay.sessions, session) == 0) continue;
    auto message = decode_message(Sender::server, relay.message.kind, *relay.message.bytes, kEdge);
    REQUIRE(message.has_value());
    found = std::get<Kind>(*std::move(message));
  }
  return found;
}

TEST_CASE("only a server with the world's key that says so becomes a follower",
          "[world][servers]") {
  WorldBench bench;
  std::uint8_t who = 3;
  std::uint64_t features = kFeatureServers;
  bool is_follower = false;
  SECTION("another key") {}
  SECTION("the world's key without the feature") {
    who = kWorldKey;
    features = kFeatureChat;
  }
  SECTION("both") {
    who = kWorldKey;
    is_follower = true;
  }
  const std::uint64_t in_force = handshake(bench, kLink, who, features);
  CHECK((in_force & kFeatureServers) == (is_follower ? kFeatureServers : 0));
  CHECK(bench.server.cluster().follower_count() == (is_follower ? 1 : 0));
  CHECK(bench.environment.trusted.size() == (is_follower ? 1 : 0));
  CHECK(bench.server.people().online().size() == (is_follower ? 0 : 1));
  const auto accepted = bench.environment.messages<SessionAccepted>(kLink, kEdge);
  REQUIRE(accepted.size() == 1);
  CHECK((accepted[0].author == 0) == is_follower);
  Message request = FollowRequest{};
  SECTION("a request") {}
  SECTION("a player") { request = open_of(4); }
  SECTION("a message") { request = Relay{{1}, encode_message(ChatRequest{"hello"})}; }
  bench.server.received(kLink, std::move(request), bench.now());
  if (is_follower) {
    CHECK(bench.environment.closed.empty());
  } else {
    REQUIRE(bench.environment.closed.size() == 1);
    CHECK(bench.environment.closed[0].reason == GoodbyeReason::unexpected_message);
    CHECK(bench.server.people().online().empty());
    CHECK(bench.environment.messages<FollowAnswer>(kLink, kEdge).empty());
  }
}

TEST_CASE("who has the world's key and no signature of it gets nothing", "[world][servers]") {
  WorldBench bench;
  bench.server.connected(kLink, bench.now());
  Hello hello = bench.hello(kWorldKey);
  hello.features = kFeatureServers;
  bench.server.received(kLink, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(kLink, 0).at(0);
  bench.server.received(kLink, bench.client_auth(3, hello, welcome), bench.now());
  CHECK(bench.server.cluster().follower_count() == 0);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::not_authenticated);
}

TEST_CASE("a follower takes no seat, and a server that follows has no followers",
          "[world][servers]") {
  WorldConfig c = config();
  c.sessions_max = 1;
  ClusterBench bench(1, c);
  bench.join(0, 1, 1);
  bench.connect(bench.add_follower());
  bench.pump();
  CHECK(bench.world(0).cluster().follower_count() == 2);
  Hello hello = bench.hello(kWorldKey, kFeatureServers);
  bench.world(1).connected(kLink, bench.now());
  bench.world(1).received(kLink, hello, bench.now());
  REQUIRE(bench.end_of(1, kLink).has_value());
  CHECK(bench.end_of(1, kLink)->reason == GoodbyeReason::closing);
}

TEST_CASE("a follower gets every record with the rows of players, and the durable watermark",
          "[world][servers]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  handshake(bench, kLink, kWorldKey, kFeatureServers);
  bench.edit(1, 2, at_x(2));
  bench.server.commit(bench.now());
  CHECK(bench.environment.messages<LogPart>(kLink, kEdge).empty());  // not asked for
  bench.server.received(kLink, FollowRequest{{1, 0}}, bench.now());
  REQUIRE(bench.environment.messages<FollowAnswer>(kLink, kEdge).size() == 1);
  CHECK(bench.environment.messages<FollowAnswer>(kLink, kEdge)[0].head == 2);
  REQUIRE(bench.environment.messages<Durable>(kLink, kEdge).size() == 1);
  CHECK(bench.environment.messages<Durable>(kLink, kEdge)[0].seq == 0);

  bench.join(2, 2);
  bench.edit(1, 3, at_x(3));
  bench.edit(2, 1, at_x(4));
  bench.server.commit(bench.now());
  const auto parts = bench.environment.messages<LogPart>(kLink, kEdge);
  REQUIRE(parts.size() == 1);
  CHECK(parts[0].epoch == 1);
  REQUIRE(parts[0].players.size() == 1);
  CHECK(parts[0].players[0].author == 2);
  CHECK(parts[0].players[0].name == "player2");
  REQUIRE(parts[0].records.size() == 2);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(parts[0].records[i].record == bench.environment.records[i + 2]);
  bench.server.durable(3, bench.now());
  CHECK(bench.environment.messages<Durable>(kLink, kEdge).back().seq == 3);
  bench.server.set_disk_is_full(true, bench.now());
  CHECK(bench.environment.messages<Durable>(kLink, kEdge).back().is_read_only);

  // A player who joins under another name gets a row at once.
  bench.server.disconnected(2);
  bench.server.connected(3, bench.now());
  Hello hello = bench.hello(2);
  hello.name = "renamed";
  bench.server.received(3, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(3, 0).at(0);
  bench.server.received(3, bench.client_auth(2, hello, welcome), bench.now());
  const LogPart last = bench.environment.messages<LogPart>(kLink, kEdge).back();
  REQUIRE(last.players.size() == 1);
  CHECK(last.players[0].name == "renamed");
  CHECK(last.records.empty());
}

TEST_CASE("no correction of the time goes to a follower that cannot read it",
          "[world][servers][clock]") {
  WorldBench bench;
  const auto refused = [&] { return bench.server.cluster().correction_refusal().has_value(); };
  CHECK_FALSE(refused());
  handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
  CHECK_FALSE(refused());
  handshake(bench, kLink + 1, kWorldKey, kFeatureServers);
  CHECK(refused());
  bench.server.disconnected(kLink + 1);
  CHECK_FALSE(refused());
}

TEST_CASE(
    "a step of the time that would shorten a restriction waits for a follower that cannot read it",
    "[world][servers][clock]") {
  constexpr TimeUs kSecond = 1'000'000;
  WorldBench bench;
  handshake(bench, kLink, kWorldKey, kFeatureServers);
  const PublicKey key = key_pair_of(seed_of(5)).public_key;
  const TimeUs until_us = bench.now().utc_us + 10'000 * kSecond;
  const Restrict ban{RestrictionKind::ban, key, until_us, ""};
  REQUIRE(bench.server.changes().change_rights(ban, {}, 0, bench.now()).has_value());
  bench.wall_error_us = 20'000 * kSecond;
  const auto wait = [&](int seconds) {
    for (int i = 0; i < seconds; ++i) {
      bench.tick(kSecond);
      if (bench.server.cluster().follower_count() > 0)
        bench.server.received(kLink, Ping{7}, bench.now());
    }
  };
  const auto refusals = [&] {
    return std::ranges::count_if(bench.environment.lines, [](const std::string& line) {
      return line.find("the time of the log cannot follow") != std::string::npos;
    });
  };
  wait(3'590);
  CHECK(refusals() == 0);
  wait(20);
  CHECK(refusals() == 1);
  CHECK(bench.server.order().head() == 1);
  CHECK(bench.server.rights().time() == bench.now().utc_us - bench.wall_error_us);
  bench.server.disconnected(kLink);
  wait(1);
  CHECK(bench.server.order().head() == 2);
  CHECK(bench.server.rights().time() == bench.now().utc_us);
  const auto* moved = bench.server.rights().state().find_restriction(RestrictionKind::ban, key);
  REQUIRE(moved != nullptr);
  CHECK(moved->value.until_us == until_us + bench.wall_error_us);
}

TEST_CASE("a server that cannot read a correction does not follow a world whose time was corrected",
          "[world][servers][clock]") {
  WorldBench bench;
  handshake(bench, kLink, kWorldKey, kFeatureServers);
  bench.server.disconnected(kLink);
  // This one has sent its hello when the time is corrected.
  constexpr SessionId kWaiting = kLink + 1;
  Hello hello = bench.hello(kWorldKey);
  hello.features = kFeatureServers;
  bench.server.connected(kWaiting, bench.now());
  bench.server.received(kWaiting, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(kWaiting, 0).at(0);
  REQUIRE(bench.server.changes().change_rights(CorrectTime{-1, 1}, {}, 0, bench.now()).has_value());
  bench.server.received(kWaiting, bench.client_auth(kWorldKey, hello, welcome), bench.now());
  bench.server.connected(kLink, bench.now());
  bench.server.received(kLink, hello, bench.now());
  CHECK(bench.environment.messages<Welcome>(kLink, 0).size() == 1);  // that of the first time
  REQUIRE(bench.environment.closed.size() == 2);
  for (const auto& closed : bench.environment.closed) {
    CHECK(closed.reason == GoodbyeReason::wrong_protocol);
    CHECK(closed.text ==
          "the time of this world was corrected: start a version that can read this");
  }
  CHECK(bench.server.cluster().follower_count() == 0);
  handshake(bench, kLink + 2, kWorldKey, kFeaturesOfServers);
  CHECK(bench.server.cluster().follower_count() == 1);
}

TEST_CASE("no shapes go to a follower that cannot read them", "[world][servers][shapes]") {
  constexpr std::uint64_t kOlder = kFeaturesOfServers & ~kFeatureShapeRecords;
  WorldBench bench;
  const auto refused = [&] { return bench.server.cluster().shapes_refusal().has_value(); };
  handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
  CHECK_FALSE(refused());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  CHECK(refused());
  bench.server.disconnected(kLink + 1);
  CHECK_FALSE(refused());
  const GivenShape slab{1, {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}}};
  REQUIRE(bench.server.changes().give_shapes({slab}, bench.now()).has_value());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::wrong_protocol);
  CHECK(bench.environment.closed[0].text ==
        "this world has materials with shapes: start a version that can read this");
}

TEST_CASE("no textures go to a follower that cannot read them", "[world][servers][textures]") {
  constexpr std::uint64_t kOlder = kFeaturesOfServers & ~kFeatureTextureRecords;
  WorldBench bench;
  const auto refused = [&] { return bench.server.cluster().textures_refusal().has_value(); };
  handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
  CHECK_FALSE(refused());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  CHECK(refused());
  bench.server.disconnected(kLink + 1);
  CHECK_FALSE(refused());
  const std::vector<GivenTexturePtr> textures = {std::make_shared<const GivenTexture>(
      GivenTexture{plain_png(16, 16, {1, 2, 3, 255}), {{1, kAllTextureSides}}})};
  REQUIRE(bench.server.changes().give_textures(textures, bench.now()).has_value());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::wrong_protocol);
  CHECK(bench.environment.closed[0].text ==
        "this world has textures: start a version that can read this");
}

TEST_CASE("the clock is not set while a follower cannot read it", "[world][servers][world_time]") {
  constexpr std::uint64_t kOlder = kFeaturesOfServers & ~kFeatureClockRecords;
  WorldBench bench;
  const auto refused = [&] { return bench.server.cluster().clock_refusal().has_value(); };
  handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
  CHECK_FALSE(refused());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  CHECK(refused());
  bench.server.disconnected(kLink + 1);
  REQUIRE(bench.server.changes().set_clock({1, 1}, 0, bench.now()).has_value());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::wrong_protocol);
  CHECK(bench.environment.closed[0].text ==
        "the clock of this world was set: start a version that can read this");
}

TEST_CASE("no role is given for some time while a follower cannot read it",
          "[world][servers][rights]") {
  constexpr std::uint64_t kOlder = kFeaturesOfServers & ~kFeatureTimedGrants;
  WorldBench bench;
  const auto refused = [&] { return bench.server.cluster().timed_grant_refusal().has_value(); };
  handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
  CHECK_FALSE(refused());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  CHECK(refused());
  bench.server.disconnected(kLink + 1);
  const GrantRole grant{PublicKey{1}, "moderator", bench.now().utc_us + 1'000'000'000};
  REQUIRE(bench.server.changes().change_rights(grant, {}, 0, bench.now()).has_value());
  handshake(bench, kLink + 1, kWorldKey, kOlder);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::wrong_protocol);
  CHECK(bench.environment.closed[0].text ==
        "this world has roles for some time: start a version that can read this");
}

TEST_CASE("the features of servers are in force for no player", "[world][servers][clock]") {
  WorldBench bench;
  CHECK((handshake(bench, 1, 3, ~std::uint64_t{0}) & kFeaturesOfServers) == 0);
  CHECK(bench.server.cluster().follower_count() == 0);
}

TEST_CASE("no player corrects the time with an edit", "[world][clock]") {
  WorldBench bench;
  bench.join(1, 3);
  const bool is_relayed = GENERATE(false, true);
  const EncodedMessage request = encode_message(EditRequest{1, 0, rights_edit(CorrectTime{-1, 1})});
  if (is_relayed) {
    handshake(bench, kLink, kWorldKey, kFeaturesOfServers);
    bench.server.received(kLink, open_of(4), bench.now());
    bench.server.received(kLink, Relay{{1}, request}, bench.now());
  } else {
    auto message = decode_message(Sender::client, request.kind, *request.bytes, kEdge);
    if (message) bench.server.received(1, *std::move(message), bench.now());
  }
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 0);
  CHECK_FALSE(bench.server.rights().state().is_time_corrected());
}

TEST_CASE("a large commit goes to a follower in parts without gaps", "[world][servers]") {
  WorldBench bench;
  handshake(bench, kLink, kWorldKey, kFeatureServers);
  bench.server.received(kLink, FollowRequest{}, bench.now());
  bench.join(1, 1);
  constexpr ClientSequence kEdits = kLogPartRecordsMax * 2 + 5;
  for (ClientSequence seq = 1; seq <= kEdits; ++seq)
    bench.edit(1, seq, at_x(static_cast<std::int32_t>(seq % 16)));
  bench.server.commit(bench.now());
  Sequence next = 1;
  for (const LogPart& part : bench.environment.messages<LogPart>(kLink, kEdge)) {
    CHECK(part.records.size() <= kLogPartRecordsMax);
    CHECK(part.players.size() == (next == 1 ? 1 : 0));
    for (const LogPartRecord& record : part.records) CHECK(record.record.version.seq == next++);
  }
  CHECK(next == kEdits + 1);
}

struct FollowerBench : WorldBench {
  explicit FollowerBench(WorldConfig c = config()) : WorldBench(std::move(c)) {
    handshake(*this, kLink, kWorldKey, kFeatureServers);
    server.received(kLink, FollowRequest{}, now());
  }
  void send(Message message) { server.received(kLink, std::move(message), now()); }
  void send_from(SessionId session, const Message& message) {
    send(Relay{{session}, encode_message(message)});
  }
};

TEST_CASE("a player of a follower pays for what it does", "[world][servers]") {
  WorldConfig c = config();
  c.edit_budget = {1, 2};
  FollowerBench bench(c);
  bench.send(open_of(2));
  REQUIRE(relayed<SessionAccepted>(bench, 1).has_value());
  CHECK(relayed<SessionAccepted>(bench, 1)->author == 1);
  for (ClientSequence seq = 1; seq <= 3; ++seq)
    bench.send_from(1, EditRequest{seq, 0, {at_x(1), {}, 1}});
  bench.server.commit(bench.now());
  CHECK(bench.server.order().head() == 2);
  REQUIRE(relayed<Reject>(bench, 1).has_value());
  CHECK(relayed<Reject>(bench, 1)->client_seq == 3);
  CHECK(relayed<Reject>(bench, 1)->reason == RejectReason::rate_limited);
  const auto charges = bench.environment.messages<RelayCharge>(kLink, kEdge);
  REQUIRE(charges.size() == 1);
  CHECK(charges[0].session == 1);
  CHECK(charges[0].bytes > 1'000);
  // The follower sends commits, so the owner does not.
  CHECK_FALSE(relayed<Commit>(bench, 1).has_value());
}

TEST_CASE("a follower that sends what it may not is closed with its players", "[world][servers]") {
  FollowerBench bench;
  bench.send(open_of(2));
  bench.send(open_of(3, 2));
  CHECK(bench.server.people().online().size() == 2);
  SECTION("a session twice") { bench.send(open_of(4)); }
  SECTION("a view of a player") { bench.send_from(1, View{}); }
  SECTION("a message of a server") { bench.send_from(1, Pong{}); }
  SECTION("a message that does not decode") {
    EncodedMessage broken = encode_message(ChatRequest{"hello"});
    broken.bytes = std::make_shared<const Bytes>(3);
    bench.send(Relay{{1}, broken});
  }
  REQUIRE_FALSE(bench.environment.closed.empty());
  CHECK(bench.environment.closed.back().session == kLink);
  CHECK(bench.server.cluster().follower_count() == 0);
  CHECK(bench.server.people().online().empty());
  CHECK(bench.environment.left.size() == 2);
}

TEST_CASE("messages for sessions that are gone, and a session's end, are no mistake of a follower",
          "[world][servers]") {
  FollowerBench bench;
  bench.send(open_of(2));
  bench.send_from(9, ChatRequest{"hello"});
  bench.send(RelayClose{1, 1, ""});
  CHECK(bench.server.people().online().empty());
  bench.send(RelayClose{1, 1, ""});
  bench.send_from(1, ChatRequest{"hello"});
  CHECK(bench.environment.closed.empty());
  CHECK(bench.environment.messages<RelayClose>(kLink, kEdge).empty());
  bench.send(open_of(2));  // the number may come again
  CHECK(bench.server.people().online().size() == 1);
}

TEST_CASE("a silent follower is closed, and one that pings is not", "[world][servers]") {
  FollowerBench bench;
  bench.send(open_of(2));
  const bool pings = GENERATE(false, true);
  for (int i = 0; i < 60; ++i) {
    bench.tick(100'000);
    if (pings) bench.send(Ping{7});
    if (i == 48) CHECK(bench.server.cluster().follower_count() == 1);
  }
  CHECK(bench.server.cluster().follower_count() == (pings ? 1 : 0));
  CHECK(bench.server.people().online().size() == (pings ? 1 : 0));
  if (pings) {
    CHECK(bench.environment.messages<Pong>(kLink, kEdge).back().sent_us == 7);
  } else {
    CHECK(bench.environment.closed.back().reason == GoodbyeReason::timed_out);
    // Whether they end is for the follower to say, which may reach the owner again.
    CHECK(bench.environment.messages<RelayClose>(kLink, kEdge).empty());
  }
}

TEST_CASE("a player of a follower who is silent stays, because the follower watches over that",
          "[world][servers]") {
  WorldConfig c = config();
  c.idle_us_max = 1'000'000;
  FollowerBench bench(c);
  bench.send(open_of(2));
  for (int i = 0; i < 30; ++i) {
    bench.tick(100'000);
    bench.send(Ping{});
  }
  CHECK(bench.server.people().online().size() == 1);
}

TEST_CASE("a follower whose queue is full is closed by the next tick with its players",
          "[world][servers]") {
  FollowerBench bench;
  bench.join(1, 1);
  bench.send(open_of(2));
  bench.environment.full.insert(kLink);
  bench.edit(1, 1, kAtOrigin);
  bench.server.commit(bench.now());
  bench.environment.full.clear();
  bench.edit(1, 2, kAtOrigin);  // it has missed a record, so it gets no further one
  bench.server.commit(bench.now());
  CHECK(bench.environment.messages<LogPart>(kLink, kEdge).empty());
  CHECK(bench.server.cluster().follower_count() == 1);
  bench.tick();
  CHECK(bench.server.cluster().follower_count() == 0);
  CHECK(bench.server.people().online().size() == 1);
  REQUIRE_FALSE(bench.environment.closed.empty());
  CHECK(bench.environment.closed.back().session == kLink);
  CHECK(bench.commits(1).size() == 2);
}

TEST_CASE("the end of a link ends the sessions of its players at the owner, and no others",
          "[world][servers]") {
  ClusterBench bench(2);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.join(2, 1, 3);
  bench.tick();
  bench.cut(1);
  bench.tick();
  CHECK(bench.world(0).cluster().follower_count() == 1);
  CHECK(bench.world(0).people().online().size() == 2);
  CHECK(bench.sent<PlayerList>(0, 1).back().left == std::vector<AuthorId>{2});
  CHECK(bench.sent<PlayerList>(2, 1).back().left == std::vector<AuthorId>{2});
  CHECK(bench.is_open(1, 1));
}

TEST_CASE("a banned player's session does not go on at another owner", "[world][servers][rights]") {
  FollowerBench bench;
  RelayOpen open = open_of(5);
  open.author = 9;
  const auto done = bench.server.changes().change_rights(
      Restrict{RestrictionKind::ban, open.key, 0, ""}, {}, 0, bench.now());
  REQUIRE(done.has_value());
  bench.send(open);
  const auto ends = bench.environment.messages<RelayClose>(kLink, kEdge);
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].reason == static_cast<std::uint8_t>(GoodbyeReason::not_admitted));
  CHECK(bench.server.people().online().empty());
}

TEST_CASE("nobody joins an owner that is not sure to be one, and who is there stays",
          "[world][servers]") {
  FollowerBench bench;
  bench.join(1, 1);
  bench.send(open_of(2));
  bench.environment.is_owner = false;
  handshake(bench, 2, 3, 0);
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 2);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::closing);
  bench.send(open_of(4, 2));  // a player who joins through the follower
  RelayOpen going_on = open_of(5, 3);
  going_on.author = 9;
  bench.send(going_on);
  const auto ends = bench.environment.messages<RelayClose>(kLink, kEdge);
  REQUIRE(ends.size() == 2);
  CHECK(ends[0].session == 2);
  CHECK(ends[1].session == 3);
  CHECK_FALSE(bench.server.order().players().author_of(going_on.key).has_value());
  CHECK(bench.server.people().online().size() == 2);
  handshake(bench, 51, kWorldKey, kFeatureServers);
  bench.server.received(51, FollowRequest{}, bench.now());
  CHECK(bench.environment.messages<FollowAnswer>(51, kEdge).empty());
  CHECK(bench.server.cluster().follower_count() == 1);
  bench.environment.is_owner = true;
  handshake(bench, 3, 3, 0);
  CHECK(bench.server.people().online().size() == 3);
}

TEST_CASE("an owner that stops leaves the players of its followers where they are",
          "[world][servers]") {
  ClusterBench bench;
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.edit(1, 1, 1, at_x(1));
  bench.pump();
  bench.world(0).begin_stop(bench.now());
  CHECK(bench.world(0).cluster().hands_over());
  bench.pump();
  CHECK(bench.end_of(0, 1).has_value());
  CHECK_FALSE(bench.end_of(1, 1).has_value());
  CHECK(bench.is_open(1, 1));
  CHECK_FALSE(bench.world(1).cluster().is_live());
  CHECK(bench.world(1).order().head() == 1);  // the edit that was accepted came before
  bench.write();
  bench.gone.insert(0);
  REQUIRE(bench.take_over(1));
  bench.edit(1, 1, 2, at_x(2));
  bench.run();
  CHECK(bench.sequences(1, 1) == std::vector<Sequence>{1, 2});
}

TEST_CASE("an owner without followers hands nothing over when it stops", "[world][servers]") {
  WorldBench bench;
  bench.server.begin_stop(bench.now());
  CHECK_FALSE(bench.server.cluster().hands_over());
}

}  // namespace
}  // namespace runstone::test
