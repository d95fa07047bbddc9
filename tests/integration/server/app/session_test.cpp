// Sessions of clients that keep the rules: joining, editing, and a restart of the server.
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/runs/dense.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/codec/view_distance.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

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
  const View view{1, {0, 0, 0}, 3, 1};
  client.send(view);
  client.cuts_chunks = false;
  std::set<ChunkKey> keys;
  std::int64_t last = 0;  // distance of the farthest chunk of all messages before
  while (keys.size() < 29 * 3) {
    const auto message = client.next();
    REQUIRE(message.has_value());
    if (const auto* uniform = std::get_if<UniformChunks>(&*message)) {
      for (const UniformChunk& chunk : uniform->chunks) keys.insert(chunk.key);
    }
    const auto* chunks = std::get_if<Chunks>(&*message);
    if (chunks == nullptr) continue;
    std::int64_t farthest = last;
    for (const ChunkAnswer& answer : chunks->chunks) {
      const auto& snapshot = std::get<ChunkSnapshot>(answer);
      CHECK(distance2(view, snapshot.key.at) >= last);
      farthest = std::max(farthest, distance2(view, snapshot.key.at));
      keys.insert(snapshot.key);
      CHECK(snapshot.chunk.digest == digest_of(snapshot.chunk.voxels));
      CHECK(snapshot.chunk.version == Version{});
    }
    last = farthest;
  }
  client.cuts_chunks = true;

  client.send(voxel_edit(1, {1, 1, 1}, 2));
  std::vector<Message> seen;
  const auto commit = client.next_of<Commit>(&seen);
  REQUIRE(commit.has_value());
  CHECK(commit->epoch == 1);
  CHECK(commit->edits.at(0).seq == 1);
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
    next_snapshots(*clients.back(), 5);
  }
  constexpr ClientSequence kEdits = 50;
  for (ClientSequence seq = 1; seq <= kEdits; ++seq) {
    for (auto& client : clients)
      client->send(
          voxel_edit(seq, {static_cast<std::int32_t>(seq % 16), 3, 3}, some_material(seq)));
  }
  std::vector<std::vector<OperationId>> orders;
  for (auto& client : clients) {
    std::vector<OperationId> order;
    Sequence next = 1;
    while (order.size() < 3 * kEdits) {
      const auto commit = client->next_of<Commit>();
      REQUIRE(commit.has_value());
      for (const OrderedEdit& e : commit->edits) {
        CHECK(e.seq == next);
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
      client.send(voxel_edit(seq, {static_cast<std::int32_t>(seq) * 7 % 40 - 20, 1, 2},
                             some_material(seq)));
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
  client.send(voxel_edit(20, {0, 1, 2}, 1));
  const auto reject = client.next_of<Reject>();
  REQUIRE(reject.has_value());
  CHECK(reject->reason == RejectReason::already_resolved);
  client.send(View{1, {0, 0, 0}, 3, 1});
  std::map<ChunkKey, Version> versions;
  for (const auto& s : next_snapshots(client, 29 * 3)) versions[s.key] = s.chunk.version;
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
      client.send(voxel_edit(accepted->resolved + 1, {1, 1, 1}, 2));
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
}  // namespace runstone::test
