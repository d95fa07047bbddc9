#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <set>
#include <thread>

#include "common/core/hash.hpp"
#include "common/runs/dense.hpp"
#include "server/interest/view_cells.hpp"
#include "tests/integration/server/app/raw_client.hpp"
#include "tests/integration/server/app/server_bench.hpp"

namespace runstone::test {
namespace {

EditRequest edit(ClientSequence seq, VoxelPos at, Material material) {
  return {seq, 0, {SetVoxel{at}, {}, material}};
}

Material some_material(ClientSequence seq) { return static_cast<Material>(1 + seq % 3); }

/// Reads until so many snapshots have arrived. Returns them in order.
std::vector<ChunkSnapshot> snapshots(RawClient& client, std::size_t count) {
  std::vector<ChunkSnapshot> got;
  while (got.size() < count) {
    auto next = client.next_of<ChunkSnapshot>();
    REQUIRE(next.has_value());
    got.push_back(*std::move(next));
  }
  return got;
}

TEST_CASE("a client joins, gets its view nearest first, edits, and gets the durable watermark",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.worker_threads = 1;  // one worker answers loads in the order of the requests
  const auto server = start_server(config, flat_creation());
  const std::uint64_t dense_before = dense_expansions();

  RawClient client(server->port());
  const auto accepted = client.join(1);
  REQUIRE(accepted.has_value());
  CHECK(accepted->author == 1);
  CHECK(client.welcome.chunk_edge == 16);
  const View view{{0, 0, 0}, 3, 1};
  client.send(view);
  const auto got = snapshots(client, 29 * 3);
  std::set<ChunkKey> keys;
  std::int64_t last = 0;
  for (const auto& s : got) {
    if (!s.chunk.voxels.is_uniform()) {  // uniform chunks come together
      CHECK(distance2(view, s.key.at) >= last);
      last = distance2(view, s.key.at);
    }
    keys.insert(s.key);
    CHECK(s.chunk.digest == digest_of(s.chunk.voxels));
    CHECK(s.chunk.version == Version{});
  }
  CHECK(keys.size() == 29 * 3);

  client.send(edit(1, {1, 1, 1}, 2));
  std::vector<Message> seen;
  const auto commit = client.next_of<Commit>(&seen);
  REQUIRE(commit.has_value());
  CHECK(commit->epoch == 1);
  CHECK(commit->first == 1);
  CHECK(commit->edits.at(0).op == OperationId{1, 1, 1});
  std::optional<Durable> durable;
  for (const Message& message : seen) {
    if (const auto* d = std::get_if<Durable>(&message)) durable = *d;
  }
  if (!durable) durable = client.next_of<Durable>();
  REQUIRE(durable.has_value());
  CHECK(durable->seq == 1);
  client.send(Goodbye{GoodbyeReason::closing, ""});
  CHECK(client.sees_the_end());
  CHECK(dense_expansions() == dense_before);
}

TEST_CASE("several clients see each other's edits as equal commits", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::uint8_t who = 1; who <= 3; ++who) {
    clients.push_back(std::make_unique<RawClient>(server->port()));
    REQUIRE(clients.back()->join(who).has_value());
    clients.back()->send(View{1, {0, 0, 0}, 1, 0});
    snapshots(*clients.back(), 5);
  }
  constexpr ClientSequence kEdits = 50;
  for (ClientSequence seq = 1; seq <= kEdits; ++seq) {
    for (auto& client : clients)
      client->send(edit(seq, {static_cast<std::int32_t>(seq % 16), 3, 3}, some_material(seq)));
  }
  std::vector<std::vector<OperationId>> orders;
  for (auto& client : clients) {
    std::vector<OperationId> order;
    Sequence next = 1;
    while (order.size() < 3 * kEdits) {
      const auto commit = client->next_of<Commit>();
      REQUIRE(commit.has_value());
      CHECK(commit->first == next);
      for (const OrderedEdit& e : commit->edits) {
        CHECK(e.previous == std::vector<Sequence>{next - 1});  // every edit is in one chunk
        order.push_back(e.op);
        ++next;
      }
    }
    orders.push_back(std::move(order));
  }
  CHECK(orders[0] == orders[1]);
  CHECK(orders[0] == orders[2]);
}

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
  SECTION("a frame of an unknown class") {
    hello[4] = 9;
    bad.send_bytes(hello);
  }
  SECTION("a class that clients may not use") {
    hello[4] = static_cast<std::uint8_t>(FrameClass::chunks);
    bad.send_bytes(hello);
  }
  SECTION("an oversized fragment") {
    hello[0] = 0xff;
    hello[1] = 0xff;
    hello[2] = 0xff;
    bad.send_bytes(hello);
  }
  SECTION("an empty frame") {
    hello[0] = hello[1] = hello[2] = hello[3] = 0;
    bad.send_bytes(hello);
  }
  SECTION("a frame counted wrongly") {
    hello[8] = 7;
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
      const FrameHeader header = writer.next(FrameClass::control, 1024, true);
      bytes.insert(bytes.end(), header.begin(), header.end());
      bytes.insert(bytes.end(), 1024, 0);
    }
    bad.send_bytes(bytes);
  }
  SECTION("a flipped byte in the body") {
    hello[kFrameHeaderBytes + 4] ^= 0xff;  // the file identifier of the schema
    bad.send_bytes(hello);
    expected = GoodbyeReason::malformed_message;
  }
  SECTION("a truncated body") {
    Bytes bytes;
    const EncodedMessage whole = encode_message(bad.hello(2));
    const auto half = std::make_shared<Bytes>(whole.bytes->begin(), whole.bytes->begin() + 40);
    FrameWriter writer;
    writer.append({whole.frame_class, half}, bytes);
    bad.send_bytes(bytes);
    expected = GoodbyeReason::malformed_message;
  }
  SECTION("a server's message from a client") {
    Bytes bytes;
    FrameWriter writer;
    writer.append(encode_message(Pong{1, 2}), bytes);
    bad.send_bytes(bytes);
    expected = GoodbyeReason::malformed_message;
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

TEST_CASE("a client that sends faster than it is read has to wait and is not closed",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.read_kib_per_second = 1;
  const auto server = start_server(config, flat_creation());
  RawClient greedy(server->port());
  REQUIRE(greedy.join(1).has_value());
  RawClient calm(server->port());
  REQUIRE(calm.join(2).has_value());
  constexpr int kPings = 4'000;  // more than a minute at the read limit
  for (int i = 0; i < kPings; ++i) greedy.send(Ping{i});
  for (int i = 0; i < 3; ++i) {
    calm.send(Ping{i});
    CHECK(calm.next_of<Pong>().has_value());
  }
  std::size_t answered = 0;
  while (const auto message = greedy.next(100))
    answered += std::holds_alternative<Pong>(*message) ? 1 : 0;
  CHECK(answered > 0);
  CHECK(answered < kPings / 2);
  CHECK(greedy.is_open());
}

TEST_CASE("a wrong receive ack closes the session, and so does one without the feature",
          "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient liar(server->port());
  liar.features = kFeatureReceiveAck;
  REQUIRE(liar.join(1).has_value());
  CHECK(liar.welcome.features == kFeatureReceiveAck);
  liar.send(View{1, {0, 0, 0}, 1, 1});
  snapshots(liar, 5 * 3);
  liar.send(ReceiveAck{1ULL << 40});
  const auto told = liar.goodbye();
  REQUIRE(told.has_value());
  CHECK(told->reason == GoodbyeReason::malformed_message);
  CHECK(told->text.find("more chunk bytes than were sent") != std::string::npos);

  RawClient plain(server->port());
  REQUIRE(plain.join(2).has_value());
  plain.send(ReceiveAck{1});
  const auto refused = plain.goodbye();
  REQUIRE(refused.has_value());
  CHECK(refused->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("a client that sends no receive acks still gets its view", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient quiet(server->port());
  quiet.features = kFeatureReceiveAck;
  REQUIRE(quiet.join(1).has_value());
  quiet.send(View{1, {0, 0, 0}, 2, 1});
  CHECK(snapshots(quiet, 13 * 3).size() == 13 * 3);
}

TEST_CASE("a client that never reads loses chunks and commits, and the server goes on",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.chunk_queue_kib = 64;
  config.edit_queue_kib = 64;
  config.edits_per_second = 0;
  config.messages_per_second = 0;
  const auto server = start_server(config, flat_creation());
  RawClient deaf(server->port());
  REQUIRE(deaf.join(1).has_value());
  deaf.send(View{1, {0, 0, 0}, 16, 16});
  RawClient good(server->port());
  REQUIRE(good.join(2).has_value());
  good.send(View{1, {0, 0, 0}, 1, 0});
  snapshots(good, 5);
  // The small queue may also fill for the client that reads. Then a commit is dropped, and a reject
  // answers the edit.
  constexpr ClientSequence kEdits = 4'000;
  std::set<ClientSequence> answered;
  std::size_t answers = 0;
  std::thread reader([&] {
    while (answers < kEdits) {
      const auto message = good.next();
      if (!message) break;
      if (const auto* commit = std::get_if<Commit>(&*message)) {
        for (const OrderedEdit& e : commit->edits) {
          answered.insert(e.op.seq);
          ++answers;
        }
      } else if (const auto* reject = std::get_if<Reject>(&*message)) {
        answered.insert(reject->client_seq);
        ++answers;
      }
    }
  });
  for (ClientSequence seq = 1; seq <= kEdits; ++seq) {
    good.send(edit(seq, {static_cast<std::int32_t>(seq % 16), 3, 3}, some_material(seq)));
  }
  reader.join();
  CHECK(answers == kEdits);  // each edit is answered exactly once
  CHECK(answered.size() == kEdits);
}

TEST_CASE("a restarted server continues the world: sequences, voxels, authors and resolved edits",
          "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  Digest before;
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(5, 33).has_value());
    client.send(View{1, {0, 0, 0}, 1, 1});
    for (ClientSequence seq = 1; seq <= 20; ++seq) {
      client.send(
          edit(seq, {static_cast<std::int32_t>(seq) * 7 % 40 - 20, 1, 2}, some_material(seq)));
    }
    REQUIRE(client.sees_durable(20));
    const StopReport report = server->stop();
    CHECK(report.is_clean);
    CHECK(report.error.empty());
    CHECK(report.digests.seq == 20);
    CHECK(report.digests.chunks.size() >= 2);
    CHECK(report.live_chunks == report.digests.chunks.size());
    before = report.world_digest;
    const auto goodbye = client.goodbye();
    REQUIRE(goodbye.has_value());
    CHECK(goodbye->reason == GoodbyeReason::closing);
  }
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  const auto accepted = client.join(5, 33);
  REQUIRE(accepted.has_value());
  CHECK(accepted->author == 1);
  CHECK(accepted->resolved == 20);
  CHECK(client.welcome.epoch == 2);
  CHECK(client.welcome.durable == 20);
  client.send(edit(20, {0, 1, 2}, 1));
  const auto reject = client.next_of<Reject>();
  REQUIRE(reject.has_value());
  CHECK(reject->reason == RejectReason::already_resolved);
  client.send(View{1, {0, 0, 0}, 3, 1});
  std::map<ChunkKey, Version> versions;
  for (const auto& s : snapshots(client, 29 * 3)) versions[s.key] = s.chunk.version;
  CHECK(versions.at({0, {0, 0, 0}}).epoch == 1);
  const StopReport report = server->stop();
  CHECK(report.is_clean);
  CHECK(report.error.empty());
  CHECK(report.world_digest == before);
}

TEST_CASE("the last name of a player is stored, with or without an edit", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const auto stored_names = [&] {
    std::vector<std::string> names;
    const auto store = open_world(config.world, StoreAccess::read_only);
    REQUIRE(store.has_value());
    const auto rows = (*store)->players();
    REQUIRE(rows.has_value());
    for (const PlayerRow& row : *rows) names.push_back(row.name);
    return names;
  };
  const auto come_as = [&](const std::string& name, bool edits) {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    client.name = name;
    const auto accepted = client.join(1);
    REQUIRE(accepted.has_value());
    CHECK(accepted->author == 1);
    if (edits) {
      client.send(edit(accepted->resolved + 1, {1, 1, 1}, 2));
      REQUIRE(client.sees_durable(accepted->resolved + 1));
    }
    CHECK(server->stop().is_clean);
  };
  come_as("ada", false);
  CHECK(stored_names().empty());  // players who never edited leave no row
  come_as("ada", true);
  CHECK(stored_names() == std::vector<std::string>{"ada"});
  come_as("grace", false);
  CHECK(stored_names() == std::vector<std::string>{"grace"});
  come_as("edsger", true);
  CHECK(stored_names() == std::vector<std::string>{"edsger"});
}

}  // namespace

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
  const EditRequest valid = edit(1, {3, 70, 3}, 1);
  const Bytes descriptor = encode(valid.edit);
  Bytes bytes = *encode_message(valid).bytes;
  const auto at = std::search(bytes.begin(), bytes.end(), descriptor.begin(), descriptor.end());
  REQUIRE(at != bytes.end());
  *at = 0xff;
  const EncodedMessage invalid{FrameClass::edits, std::make_shared<const Bytes>(bytes)};

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
  client.send(edit(2, {3, 70, 3}, 1));
  const auto commit = client.next_of<Commit>();
  REQUIRE(commit.has_value());
  CHECK(commit->first == 1);
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

}  // namespace runstone::test
