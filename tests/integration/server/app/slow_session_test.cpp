// Clients that send faster than the server reads, or do not read what it sends.
#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <thread>
#include <variant>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

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

TEST_CASE("a client that sends and reads nothing is ended after the idle time", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.idle_s = 5;
  const auto server = start_server(config, flat_creation());
  RawClient silent(server->port());
  REQUIRE(silent.join(1).has_value());
  silent.send(View{1, {0, 0, 0}, 1, 0});
  RawClient good(server->port());
  REQUIRE(good.join(2).has_value());
  // Their commits fill the sockets of the client that reads nothing.
  constexpr ClientSequence kEdits = 10'000;
  for (ClientSequence seq = 1; seq <= kEdits; ++seq)
    good.send(voxel_edit(seq, {static_cast<std::int32_t>(seq % 16), 3, 3}, some_material(seq)));
  REQUIRE(good.sees_durable(kEdits));
  constexpr int kPingsMax = 1'000;
  for (int i = 0; i < kPingsMax && silent.is_open(); ++i) {
    silent.send(Ping{i});
    good.send(Ping{i});
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  CHECK_FALSE(silent.is_open());
  CHECK(good.next_of<Pong>().has_value());
}

TEST_CASE("a client that sends no receive acks still gets its view", "[integration]") {
  const TempFolder folder;
  const auto server = start_server(quiet_config(folder / "world"), flat_creation());
  RawClient quiet(server->port());
  quiet.features = kFeatureReceiveAck;
  REQUIRE(quiet.join(1).has_value());
  quiet.send(View{1, {0, 0, 0}, 2, 1});
  CHECK(next_snapshots(quiet, 13 * 3).size() == 13 * 3);
}

TEST_CASE("a client that never reads loses chunks and commits, and the server goes on",
          "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.chunk_queue_kib = 64;
  config.edit_queue_kib = 64;
  config.messages_per_second = 0;
  const auto server = start_server(config, flat_creation());
  RawClient silent(server->port());
  REQUIRE(silent.join(1).has_value());
  silent.send(View{1, {0, 0, 0}, 16, 16});
  RawClient good(server->port());
  REQUIRE(good.join(2).has_value());
  good.send(View{1, {0, 0, 0}, 1, 0});
  next_snapshots(good, 5);
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
    good.send(voxel_edit(seq, {static_cast<std::int32_t>(seq % 16), 3, 3}, some_material(seq)));
  }
  reader.join();
  CHECK(answers == kEdits);  // each edit is answered exactly once
  CHECK(answered.size() == kEdits);
}

}  // namespace
}  // namespace runstone::test
