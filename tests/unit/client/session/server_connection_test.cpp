#include "client/session/server_connection.hpp"
#include "tests/support/codec/test_keys.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace runstone;
using runstone::test::keys;

namespace {

using Dispatch = ServerConnection::Dispatch;

SessionConfig config() {
  SessionConfig out;
  out.keys = keys(1);
  out.name = "ada";
  out.view = {1, {0, 0, 0}, 9, 2};
  return out;
}

/// A connection, and its server played by the test.
struct ConnectionFixture {
  Dispatch receive(Message message) { return connection.receive(message, {now, now, now}); }
  /// Returns the queued messages of one kind. Drops the others.
  template <class T>
  std::vector<T> take() {
    std::vector<T> out;
    for (const Message& message : connection.take_outgoing()) {
      if (const auto* wanted = std::get_if<T>(&message)) out.push_back(*wanted);
    }
    return out;
  }
  void greet() {
    connection.connected({5}, std::nullopt, now);
    const auto hellos = take<Hello>();
    REQUIRE(hellos.size() == 1);
    hello = hellos[0];
  }
  Welcome welcome() const {
    Welcome out;
    out.world_id = world_id;
    out.epoch = epoch;
    out.chunk_edge = 16;
    out.materials = default_material_table();
    out.server_key = server.public_key;
    out.view_radius_max = 4;
    out.features = features;
    out.signature = sign(server, server_transcript(hello, out, std::nullopt));
    return out;
  }
  void open() {
    greet();
    receive(welcome());
    REQUIRE(receive(SessionAccepted{6, 0}) == Dispatch::session_accepted);
    REQUIRE(connection.is_open());
    connection.take_outgoing();
  }
  bool goes_on(TimeUs ping_every_us = kPingEveryUs) { return connection.tick(now, ping_every_us); }

  KeyPair server = keys(9);
  WorldId world_id{1, 2, 3};
  Epoch epoch = 1;
  std::uint64_t features = 0;
  Hello hello;
  TimeUs now = 1'000'000;
  ServerConnection connection{config()};
};

Pose pose_at(double x) {
  Pose out;
  out.at = {x, 0, 0};
  return out;
}

}  // namespace

TEST_CASE_METHOD(ConnectionFixture, "a connection opens with the handshake", "[session]") {
  CHECK(connection.state() == SessionState::offline);
  CHECK_FALSE(connection.accepts_input());
  greet();
  CHECK(hello.name == "ada");
  CHECK(connection.state() == SessionState::hello_sent);
  CHECK(connection.accepts_input());
  CHECK(receive(welcome()) == Dispatch::handled);
  CHECK(connection.state() == SessionState::authenticating);
  const auto proofs = take<ClientAuth>();
  REQUIRE(proofs.size() == 1);
  CHECK(verify(hello.key, client_transcript(hello, welcome(), std::nullopt), proofs[0].signature));
  CHECK_FALSE(goes_on());
  CHECK(receive(SessionAccepted{6, 0}) == Dispatch::session_accepted);
  CHECK(connection.is_open());
  CHECK(connection.author() == 6);
  CHECK(connection.connect_count() == 1);
  CHECK(goes_on());
  connection.disconnected();
  CHECK(connection.state() == SessionState::offline);
  CHECK_FALSE(goes_on());
  CHECK(connection.take_outgoing().empty());
  CHECK(connection.welcome());
  open();
  CHECK(connection.connect_count() == 2);
}

TEST_CASE_METHOD(ConnectionFixture,
                 "handshake messages in the wrong state end the connection with one goodbye",
                 "[session]") {
  SECTION("ready before welcome") {
    greet();
    CHECK(receive(SessionAccepted{6, 0}) == Dispatch::handled);
  }
  SECTION("welcome twice") {
    greet();
    receive(welcome());
    CHECK(receive(welcome()) == Dispatch::handled);
  }
  SECTION("a message of the open session before welcome") {
    greet();
    CHECK(receive(Durable{1, 7}) == Dispatch::handled);
  }
  SECTION("command output in a session without commands") {
    open();
    CHECK(receive(CommandOutput{1, {}, true, true}) == Dispatch::handled);
  }
  SECTION("ready twice") {
    open();
    CHECK(receive(SessionAccepted{6, 0}) == Dispatch::handled);
  }
  REQUIRE(connection.wants_close());
  REQUIRE(connection.end());
  CHECK(connection.end()->reason == GoodbyeReason::unexpected_message);
  CHECK_FALSE(connection.end()->by_server);
  CHECK_FALSE(connection.end()->final);
  CHECK(receive(SessionAccepted{6, 0}) == Dispatch::handled);
  connection.fail_with(GoodbyeReason::malformed_message, "and another fault");
  connection.close(GoodbyeReason::closing, "done");
  CHECK_FALSE(goes_on());
  const auto goodbyes = take<Goodbye>();
  REQUIRE(goodbyes.size() == 1);
  CHECK(goodbyes[0].reason == GoodbyeReason::unexpected_message);
}

TEST_CASE_METHOD(ConnectionFixture, "messages for the session are left as they are", "[session]") {
  greet();
  receive(welcome());
  Message message = Durable{1, 7};
  CHECK(connection.receive(message, {now, now, now}) == Dispatch::for_session);
  CHECK(std::get<Durable>(message).seq == 7);
  // No ping is sent before the connection opens.
  CHECK(receive(Pong{now, now}) == Dispatch::for_session);
  CHECK(connection.pongs() == 0);
  receive(SessionAccepted{6, 0});
  CHECK(receive(Durable{1, 7}) == Dispatch::for_session);
  CHECK_FALSE(connection.wants_close());
  connection.disconnected();
  CHECK(receive(Durable{1, 7}) == Dispatch::handled);
}

TEST_CASE_METHOD(ConnectionFixture, "a server of another protocol is refused with both versions",
                 "[session]") {
  greet();
  Welcome newer;
  newer.protocol = kProtocolVersion + 1;
  receive(newer);
  REQUIRE(connection.end());
  CHECK(connection.end()->reason == GoodbyeReason::wrong_protocol);
  CHECK(connection.end()->text == "server speaks protocol " + std::to_string(newer.protocol) +
                                      ", client " + std::to_string(kProtocolVersion));
}

TEST_CASE_METHOD(ConnectionFixture,
                 "a goodbye of the server is not answered, and some reasons are final",
                 "[session]") {
  greet();
  GoodbyeReason reason = GoodbyeReason::closing;
  bool is_final = false;
  SECTION("later perhaps") {}
  SECTION("another protocol") {
    reason = GoodbyeReason::wrong_protocol;
    is_final = true;
  }
  SECTION("not believed") {
    reason = GoodbyeReason::not_authenticated;
    is_final = true;
  }
  CHECK(receive(Goodbye{reason, "bye"}) == Dispatch::handled);
  CHECK(connection.wants_close());
  CHECK(connection.end()->by_server);
  CHECK(connection.end()->text == "bye");
  CHECK(connection.end()->final == is_final);
  CHECK(connection.take_outgoing().empty());
  connection.connected({6}, std::nullopt, now);
  CHECK_FALSE(connection.end());
  CHECK_FALSE(connection.wants_close());
}

TEST_CASE_METHOD(ConnectionFixture, "the list of servers is kept until another world's begins",
                 "[session]") {
  const Servers list{{{"a:1"}, {"b:1"}}, 1};
  features = kFeatureServerList;
  open();
  CHECK(connection.servers_number() == 0);
  CHECK(receive(list) == Dispatch::handled);
  CHECK_FALSE(connection.wants_close());
  CHECK(connection.servers() == list);
  CHECK(connection.servers_number() == 1);
  receive(Pong{now, now});
  CHECK(connection.clock().known());
  open();
  CHECK(connection.servers() == list);
  CHECK(connection.servers_number() == 1);
  CHECK_FALSE(connection.clock().known());  // the server may be another one, with another clock
  world_id = {4};
  open();
  CHECK(connection.servers() == Servers{});
  CHECK(connection.servers_number() == 2);
}

TEST_CASE_METHOD(ConnectionFixture,
                 "whatever answers at a listed address must prove the key of the same world",
                 "[session]") {
  open();
  connection.connected({6}, std::nullopt, now, true);
  hello = take<Hello>().at(0);
  SECTION("it does") {
    receive(welcome());
    CHECK(receive(SessionAccepted{6, 0}) == Dispatch::session_accepted);
    CHECK(connection.is_open());
    CHECK_FALSE(connection.end());
    receive(Goodbye{GoodbyeReason::not_admitted, "banned"});
    CHECK(connection.end()->final);
    return;
  }
  SECTION("another key") {
    server = keys(8);
    receive(welcome());
    CHECK(connection.end()->reason == GoodbyeReason::not_authenticated);
  }
  SECTION("another world") {
    world_id = {4};
    receive(welcome());
    CHECK(connection.config().pinned.size() == 1);
  }
  SECTION("another signature") {
    Welcome forged = welcome();
    forged.signature[0] ^= 1;
    receive(forged);
  }
  SECTION("a goodbye before it has proved anything") {
    receive(Goodbye{GoodbyeReason::not_admitted, "banned"});
  }
  // Nothing secret was sent, and another address may lead to the world.
  CHECK(take<ClientAuth>().empty());
  CHECK(connection.wants_close());
  REQUIRE(connection.end());
  CHECK_FALSE(connection.end()->final);
  CHECK(connection.welcome()->world_id == WorldId{1, 2, 3});
}

TEST_CASE_METHOD(ConnectionFixture,
                 "a server that is silent too long ends the connection in every state",
                 "[session]") {
  bool is_opened = false;
  SECTION("while greeting") { greet(); }
  SECTION("once open") {
    open();
    is_opened = true;
  }
  now += kServerSilenceUsMax;
  CHECK(goes_on() == is_opened);
  CHECK_FALSE(connection.wants_close());
  if (is_opened) {
    receive(Pong{now, now});
  } else {
    connection.note_message(now);
  }
  now += kServerSilenceUsMax;
  CHECK(goes_on() == is_opened);
  now += 1;
  CHECK_FALSE(goes_on());
  CHECK(connection.wants_close());
  CHECK(connection.end()->reason == GoodbyeReason::timed_out);
  CHECK_FALSE(connection.end()->final);
  now += 1;
  CHECK_FALSE(goes_on());
  CHECK(take<Goodbye>().size() == 1);
}

TEST_CASE_METHOD(ConnectionFixture, "pings are sent at once and then at the given interval",
                 "[session]") {
  open();
  CHECK(goes_on());
  CHECK(take<Ping>() == std::vector{Ping{now}});
  now += kPingEveryUs - 1;
  goes_on();
  CHECK(take<Ping>().empty());
  now += 1;
  goes_on();
  CHECK(take<Ping>() == std::vector{Ping{now}});
  now += 50'000;
  goes_on(50'000);
  CHECK(take<Ping>() == std::vector{Ping{now}});
  goes_on(50'000);
  CHECK(take<Ping>().empty());
}

TEST_CASE_METHOD(ConnectionFixture,
                 "a pong gives the server's clock, in which edits carry their time", "[session]") {
  open();
  LocalEdit own;
  own.edit = {SetVoxel{{1, 2, 3}}, {}, 4};
  own.submitted_us = now;
  connection.send_edit(1, own);
  CHECK(take<EditRequest>() == std::vector{EditRequest{1, 0, own.edit}});
  CHECK(receive(Pong{now - 200, now + 4'900}) == Dispatch::handled);
  CHECK(connection.pongs() == 1);
  connection.send_edit(2, own);
  CHECK(take<EditRequest>() == std::vector{EditRequest{2, now + 5'000, own.edit}});
}

TEST_CASE_METHOD(ConnectionFixture, "poses are sent when they change, one per kMoveEveryUs",
                 "[session]") {
  open();
  CHECK(goes_on());
  CHECK(take<Move>() ==
        std::vector{Move{pose_at(0)}});  // the first pose of a connection is always sent
  connection.set_pose(pose_at(1));
  now += kMoveEveryUs - 1;
  goes_on();
  CHECK(take<Move>().empty());
  connection.set_pose(pose_at(2));
  now += 1;
  goes_on();
  CHECK(take<Move>() == std::vector{Move{pose_at(2)}});
  now += kMoveEveryUs;
  connection.set_pose(pose_at(2));
  goes_on();
  CHECK(take<Move>().empty());
  connection.disconnected();
  open();
  goes_on();
  CHECK(take<Move>() == std::vector{Move{pose_at(2)}});
}

TEST_CASE_METHOD(ConnectionFixture, "a connection knows when its next tick is due", "[session]") {
  CHECK(connection.tick_due_us(kPingEveryUs) == std::numeric_limits<TimeUs>::max());
  greet();
  CHECK(connection.tick_due_us(kPingEveryUs) == now + kServerSilenceUsMax + 1);
  open();
  CHECK(connection.tick_due_us(kPingEveryUs) <= now);
  goes_on();
  CHECK(connection.tick_due_us(kPingEveryUs) == now + kPingEveryUs);
  CHECK(connection.tick_due_us(70'000) == now + 70'000);
  connection.set_pose(pose_at(1));
  CHECK(connection.tick_due_us(70'000) == now + kMoveEveryUs);
  connection.set_pose(pose_at(0));
  now += kServerSilenceUsMax;
  goes_on();
  CHECK(connection.tick_due_us(kPingEveryUs) == now + 1);  // no message has arrived since
}

TEST_CASE_METHOD(ConnectionFixture, "a view is sent within the server's limits when it changes",
                 "[session]") {
  CHECK(connection.view() == View{1, {0, 0, 0}, 9, 2});
  open();
  CHECK(connection.view() == View{1, {0, 0, 0}, 4, 2});
  CHECK_FALSE(connection.view_was_sent());
  CHECK(connection.send_view());
  CHECK(connection.view_was_sent());
  CHECK(take<View>() == std::vector{View{1, {0, 0, 0}, 4, 2}});
  connection.set_view({1, {0, 0, 0}, 8, 2});
  CHECK_FALSE(connection.send_view());
  connection.set_view({1, {1, 0, 0}, 2, 8});
  CHECK(connection.send_view());
  CHECK(take<View>() == std::vector{View{2, {1, 0, 0}, 2, 4}});
  connection.disconnected();
  CHECK_FALSE(connection.view_was_sent());
  open();
  CHECK(connection.send_view());
}

TEST_CASE_METHOD(ConnectionFixture, "each view that is sent has the next number of its connection",
                 "[session]") {
  open();
  CHECK(connection.view().number == 1);  // that of the view to be sent
  connection.send_view();
  CHECK(connection.view().number == 1);
  View view = connection.view();
  view.yaw = 100;
  view.number = 77;  // ignored
  connection.set_view(view);
  CHECK(connection.view().number == 2);
  view.centre.x = 9;
  connection.set_view(view);
  CHECK(connection.view().number == 2);  // the view before was not sent
  connection.send_view();
  connection.send_view();
  const auto views = take<View>();
  REQUIRE(views.size() == 2);
  CHECK(views[0].number == 1);
  CHECK(views[1].number == 2);
  connection.disconnected();
  open();
  CHECK(connection.view().number == 1);
}

TEST_CASE_METHOD(ConnectionFixture, "chunk requests are split by the limit of keys per message",
                 "[session]") {
  open();
  connection.request_chunks({});
  CHECK(connection.take_outgoing().empty());
  std::vector<ChunkKey> keys;
  for (std::size_t i = 0; i < 2 * kChunkRequestKeysMax + 1; ++i) {
    keys.push_back({0, {static_cast<std::int32_t>(i), 0, 0}});
  }
  connection.request_chunks(keys);
  const auto requests = take<ChunkRequest>();
  REQUIRE(requests.size() == 3);
  std::vector<ChunkKey> asked;
  for (const ChunkRequest& request : requests) {
    CHECK(request.keys.size() <= kChunkRequestKeysMax);
    asked.insert(asked.end(), request.keys.begin(), request.keys.end());
  }
  CHECK(asked == keys);
}

TEST_CASE_METHOD(ConnectionFixture,
                 "a pin outlives a restart of the server, and another world gets its own pin",
                 "[session]") {
  open();
  receive(Pong{now - 200, now});
  REQUIRE(connection.clock().known());
  connection.disconnected();
  open();
  CHECK(connection.clock().known());
  ++epoch;
  greet();
  CHECK(receive(welcome()) == Dispatch::handled);
  CHECK_FALSE(connection.clock().known());  // a restarted server has another clock
  receive(SessionAccepted{6, 0});
  receive(Pong{now - 200, now});
  const WorldId first = world_id;
  const PublicKey first_key = server.public_key;
  world_id[0] ^= 1U;
  server = keys(8);
  greet();
  CHECK(receive(welcome()) == Dispatch::another_world);
  CHECK_FALSE(connection.clock().known());
  CHECK(connection.config().pinned.at(first) == first_key);
  CHECK(connection.config().pinned.at(world_id) == server.public_key);
  // At the first world again, only its pinned key is accepted.
  world_id = first;
  greet();
  CHECK(receive(welcome()) == Dispatch::handled);
  CHECK(connection.wants_close());
  CHECK(connection.end()->reason == GoodbyeReason::not_authenticated);
  CHECK(connection.end()->final);
  CHECK(connection.config().pinned.at(first) == first_key);
  CHECK(take<Goodbye>().size() == 1);
  server = keys(9);
  greet();
  CHECK(receive(welcome()) == Dispatch::another_world);
}

TEST_CASE_METHOD(ConnectionFixture, "a password goes to an encrypted server that asks for one",
                 "[session]") {
  connection.set_password(std::make_shared<PasswordKeys>("correct horse"));
  const ChannelBinding binding{4};
  const auto auth_for = [&](const std::optional<PasswordSalt>& salt) {
    connection.connected({5}, binding, now);
    hello = take<Hello>().at(0);
    Welcome welcome = this->welcome();
    welcome.signature = sign(server, server_transcript(hello, welcome, binding));
    welcome.password_salt = salt;
    receive(welcome);
    return take<ClientAuth>().at(0);
  };
  CHECK_FALSE(auth_for(std::nullopt).password_key.has_value());
  const PasswordSalt first{1}, second{2};
  const PasswordKey key = password_key("correct horse", first).value();
  CHECK(auth_for(first).password_key == key);
  CHECK(auth_for(first).password_key == key);
  CHECK(auth_for(second).password_key == password_key("correct horse", second).value());
}

TEST_CASE_METHOD(ConnectionFixture, "a password is never sent without encryption", "[session]") {
  connection.set_password(std::make_shared<PasswordKeys>("correct horse"));
  greet();
  Welcome forged = welcome();
  forged.password_salt = PasswordSalt{1};
  receive(forged);
  CHECK(take<ClientAuth>().empty());
  REQUIRE(connection.end().has_value());
  CHECK(connection.end()->text == "a password is sent on encrypted connections only");
  CHECK(connection.end()->final);
}

TEST_CASE_METHOD(ConnectionFixture, "a refused player is asked for the password of the world",
                 "[session]") {
  const auto refused_by = [&](GoodbyeReason reason, bool has_password) {
    greet();
    Welcome welcome = this->welcome();
    if (has_password) welcome.password_salt = PasswordSalt{1};
    receive(welcome);
    receive(Goodbye{reason, "no"});
    return connection.lacks_password();
  };
  CHECK_FALSE(refused_by(GoodbyeReason::not_admitted, false));
  CHECK_FALSE(refused_by(GoodbyeReason::server_full, true));
  CHECK(refused_by(GoodbyeReason::not_admitted, true));
  greet();
  receive(Goodbye{GoodbyeReason::not_admitted, "your address is banned"});  // before welcome
  CHECK_FALSE(connection.lacks_password());
  REQUIRE(refused_by(GoodbyeReason::not_admitted, true));
  connection.set_password(std::make_shared<PasswordKeys>("correct horse"));
  CHECK_FALSE(connection.lacks_password());
  CHECK_FALSE(connection.end().has_value());
}
