// Clients that break a rule of the protocol. The server answers with a reason, and other sessions go
// on.
#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "protocol/codec/message_table.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

TEST_CASE("a client that breaks a rule ends its own session only, with a numbered reason",
          "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient good(server->port());
  REQUIRE(good.join(1).has_value());

  RawClient bad(server->port());
  Bytes hello;
  FrameWriter frames;
  frames.append(encode_message(bad.hello(2)), hello);
  GoodbyeReason expected = GoodbyeReason::malformed_frame;
  SECTION("noise instead of a frame") { bad.send_bytes(Bytes(64, 0xff)); }
  SECTION("a frame of an unknown kind") {
    hello[2] = kMessageKindCount + 1;
    bad.send_bytes(hello);
  }
  SECTION("a kind that clients may not send") {
    hello[2] = wire_number(kKindOf<Chunks>);
    bad.send_bytes(hello);
  }
  SECTION("an oversized fragment") {
    hello[0] = 0xff;
    hello[1] = 0xff;
    bad.send_bytes(hello);
  }
  SECTION("an empty frame") {
    hello[0] = hello[1] = 0;
    bad.send_bytes(hello);
  }
  SECTION("a frame counted wrongly") {
    hello[4] = 7;
    bad.send_bytes(hello);
  }
  SECTION("a frame repeated") {
    bad.send_bytes(hello);
    bad.send_bytes(hello);
  }
  SECTION("more fragments than a message may have") {
    FrameWriter writer;
    Bytes bytes;
    for (int i = 0; i < 8; ++i) {
      const FrameHeader header = writer.next(kKindOf<Hello>, 1024, true);
      bytes.insert(bytes.end(), header.begin(), header.end());
      bytes.insert(bytes.end(), 1024, 0);
    }
    bad.send_bytes(bytes);
  }
  SECTION("a flipped byte in the body") {
    hello[kFrameHeaderBytes] ^= 0xff;  // of the place of the table
    bad.send_bytes(hello);
    expected = GoodbyeReason::malformed_message;
  }
  SECTION("a truncated body") {
    Bytes bytes;
    const EncodedMessage whole = encode_message(bad.hello(2));
    const auto half = std::make_shared<Bytes>(whole.bytes->begin(), whole.bytes->begin() + 40);
    FrameWriter writer;
    writer.append({whole.kind, half}, bytes);
    bad.send_bytes(bytes);
    expected = GoodbyeReason::malformed_message;
  }
  SECTION("a server's message from a client") {
    Bytes bytes;
    FrameWriter writer;
    writer.append(encode_message(Pong{1, 2}), bytes);
    bad.send_bytes(bytes);
  }
  const auto goodbye = bad.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == expected);
  CHECK_FALSE(goodbye->text.empty());
  CHECK(bad.sees_the_end());
  good.send(Ping{42});
  const auto pong = good.next_of<Pong>();
  REQUIRE(pong.has_value());
  CHECK(pong->sent_us == 42);
}

TEST_CASE("a client that stops in the middle of a frame leaves nothing behind", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  for (std::size_t length : {0U, 1U, 11U, 12U, 40U}) {
    RawClient client(server->port());
    Bytes hello;
    FrameWriter frames;
    frames.append(encode_message(client.hello(1)), hello);
    hello.resize(length);
    client.send_bytes(hello);
    client.shutdown_send();
    CHECK(client.sees_the_end());
  }
  RawClient client(server->port());
  CHECK(client.join(1).has_value());
}

TEST_CASE("a frame that arrives in single bytes is still a frame", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient client(server->port());
  Bytes hello;
  FrameWriter frames;
  frames.append(encode_message(client.hello(1)), hello);
  for (const std::uint8_t byte : hello) client.send_bytes(ByteView(&byte, 1));
  CHECK(client.next_of<Welcome>().has_value());
}

TEST_CASE("a wrong protocol is answered with both versions", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient client(server->port());
  Hello hello = client.hello(1);
  hello.protocol = 77;
  client.send(hello);
  const auto goodbye = client.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::wrong_protocol);
  CHECK(goodbye->text.find("77") != std::string::npos);
}

TEST_CASE("a client that floods is closed", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.messages_per_second = 100;
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  for (int i = 0; i < 2'000 && client.is_open(); ++i) client.send(Ping{i});
  const auto goodbye = client.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::flooding);
}

TEST_CASE("a wrong receive ack closes the session, and so does one without the feature",
          "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient client(server->port());
  client.features = kFeatureReceiveAck;
  REQUIRE(client.join(1).has_value());
  CHECK(client.welcome.features == kFeatureReceiveAck);
  client.send(View{1, {0, 0, 0}, 1, 1});
  next_snapshots(client, 5 * 3);
  client.send(ReceiveAck{1ULL << 40});
  const auto goodbye = client.goodbye();
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::malformed_message);
  CHECK(goodbye->text.find("more chunk bytes than were sent") != std::string::npos);

  RawClient plain(server->port());
  REQUIRE(plain.join(2).has_value());
  plain.send(ReceiveAck{1});
  const auto refused = plain.goodbye();
  REQUIRE(refused.has_value());
  CHECK(refused->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("a command ends a session that did not offer the feature", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient plain(server->port());
  plain.features = kFeatureReceiveAck;
  REQUIRE(plain.join(1).has_value());
  plain.send(CommandRequest{1, "help"});
  std::vector<Message> before;
  const auto goodbye = plain.next_of<Goodbye>(&before);
  REQUIRE(goodbye.has_value());
  CHECK(goodbye->reason == GoodbyeReason::unexpected_message);
  for (const Message& message : before) CHECK_FALSE(std::holds_alternative<CommandOutput>(message));

  RawClient offering(server->port());
  offering.features = kFeatureCommands;
  REQUIRE(offering.join(1).has_value());
  offering.send(CommandRequest{1, "help"});
  const auto output = offering.next_of<CommandOutput>();
  REQUIRE(output.has_value());
  CHECK(output->id == 1);
}

TEST_CASE("an invalid descriptor is rejected as bad_edit and the session goes on",
          "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  // A valid message whose descriptor has an unknown kind in its first byte.
  const EditRequest valid = voxel_edit(1, {3, 70, 3}, 1);
  const Bytes descriptor = encode(valid.edit);
  Bytes bytes = *encode_message(valid).bytes;
  const auto at = std::search(bytes.begin(), bytes.end(), descriptor.begin(), descriptor.end());
  REQUIRE(at != bytes.end());
  *at = 0xff;
  const EncodedMessage invalid{kKindOf<EditRequest>, std::make_shared<const Bytes>(bytes)};

  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  client.send(View{1, {0, 4, 0}, 1, 1});
  for (int attempt = 0; attempt < 2; ++attempt) {
    client.send(invalid);
    const auto reject = client.next_of<Reject>();
    REQUIRE(reject.has_value());
    CHECK(reject->client_seq == 1);
    CHECK(reject->reason == RejectReason::bad_edit);
    CHECK(reject->detail.find("(at byte ") != std::string::npos);
    CHECK(reject->seq == 0);
  }
  client.send(voxel_edit(2, {3, 70, 3}, 1));
  const auto commit = client.next_of<Commit>();
  REQUIRE(commit.has_value());
  CHECK(commit->edits.at(0).seq == 1);
  CHECK(commit->edits.at(0).op.seq == 2);

  // The same client comes back and offers the edit again.
  RawClient again(server->port());
  const auto accepted = again.join(1);
  REQUIRE(accepted.has_value());
  CHECK(accepted->resolved == 2);
  again.send(invalid);
  const auto reject = again.next_of<Reject>();
  REQUIRE(reject.has_value());
  CHECK(reject->reason == RejectReason::bad_edit);
  again.send(Ping{7});
  CHECK(again.next_of<Pong>().has_value());
}

}  // namespace
}  // namespace runstone::test
