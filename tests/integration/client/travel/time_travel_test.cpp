// Clients view the past of a real server on loopback.
#include <catch2/catch.hpp>
#include <map>
#include <vector>

#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"

namespace runstone::test {
namespace {

constexpr View kView{1, {0, 0, 0}, 2, 1};
using ChunkStates = std::map<ChunkKey, std::pair<Version, Digest>>;

ChunkStates states_of(const Replica& replica) {
  ChunkStates states;
  for (const ChunkKey& key : replica.confirmed_keys()) {
    const ChunkPtr chunk = replica.confirmed(key);
    CHECK(digest_of(chunk->voxels) == chunk->digest);
    states[key] = {chunk->version, chunk->digest};
  }
  return states;
}

/// A builder whose replica records the view after each of its edits.
struct Builder {
  explicit Builder(std::uint16_t port) : client(port, kView) {
    client.catch_up();
    moments.push_back(states_of(client.replica()));
  }
  void build(int edits) {
    for (int i = 0; i < edits; ++i) {
      const auto n = static_cast<std::int32_t>(moments.size());
      const VoxelPos at = {n * 7 % 60 - 30, n * 5 % 20 - 8, n * 11 % 60 - 30};
      client.edit(
          {FillSphere{at, static_cast<std::uint16_t>(n % 5)}, {}, static_cast<Material>(n % 7)});
      client.catch_up();
      moments.push_back(states_of(client.replica()));
    }
  }
  LiveSession client;
  std::vector<ChunkStates> moments;  // by sequence
};

HistoryRequest to_seq(Sequence seq) { return {1, HistoryTarget::sequence, seq, 0}; }

}  // namespace

TEST_CASE("a client sees its view as it was after any edit, and the live world again", "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  Builder builder(server->port());
  builder.build(30);
  LiveSession viewer(server->port(), kView);
  viewer.catch_up();
  CHECK(states_of(viewer.replica()) == builder.moments[30]);

  for (const Sequence seq : {20U, 0U, 7U, 29U, 30U, 1U}) {
    CAPTURE(seq);
    viewer.travel(to_seq(seq));
    CHECK(viewer.session().history_refusal().empty());
    CHECK(viewer.session().loaded());
    REQUIRE(viewer.replica().past().has_value());
    CHECK(viewer.replica().past()->seq == seq);
    CHECK(states_of(viewer.replica()) == builder.moments[seq]);
  }

  // Edits of the live world do not change the view of the past.
  builder.build(10);
  for (int i = 0; i < 20; ++i) viewer.pump();
  CHECK(states_of(viewer.replica()) == builder.moments[1]);
  CHECK_FALSE(viewer.session().offer({SetVoxel{{0, 0, 0}}, {}, 1}, 0, 0).has_value());

  viewer.travel({});
  viewer.catch_up();
  CHECK_FALSE(viewer.replica().past().has_value());
  CHECK(states_of(viewer.replica()) == builder.moments[40]);
  builder.build(3);
  viewer.until([&] { return states_of(viewer.replica()) == builder.moments[43]; });
  viewer.edit({SetVoxel{{1, 2, 3}}, {}, 5});
  viewer.catch_up();
  CHECK(viewer.replica().counters().drifted == 0);
  server->stop();
}

TEST_CASE("scrubbing sends the changed chunks, and a view that moves in the past shows the past",
          "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  Builder builder(server->port());
  builder.build(20);
  LiveSession viewer(server->port(), {1, {40, 0, 0}, 2, 1});
  viewer.catch_up();
  viewer.travel(to_seq(12));
  viewer.session().set_view(kView);
  viewer.catch_up();
  CHECK(states_of(viewer.replica()) == builder.moments[12]);

  viewer.travel(
      to_seq(12));  // again, because the server forgets the chunks it sent before the view moved
  const auto before = viewer.replica().counters().snapshots_taken;
  viewer.travel(to_seq(13));
  std::size_t changed = 0;
  for (const auto& [key, state] : builder.moments[13])
    changed += state != builder.moments[12].at(key) ? 1 : 0;
  CHECK(changed > 0);
  CHECK(viewer.replica().counters().snapshots_taken - before == changed);
  CHECK(states_of(viewer.replica()) == builder.moments[13]);
  server->stop();
}

TEST_CASE("a moment that is not in the log is refused with a reason, and the view does not change",
          "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  Builder builder(server->port());
  builder.build(3);
  LiveSession viewer(server->port(), kView);
  viewer.catch_up();
  viewer.travel(to_seq(4));
  CHECK(viewer.session().history_refusal().find("seq=4") != std::string::npos);
  CHECK_FALSE(viewer.replica().past().has_value());
  CHECK(viewer.session().loaded());
  viewer.travel(to_seq(2));
  viewer.travel(to_seq(99));
  CHECK_FALSE(viewer.session().history_refusal().empty());
  CHECK(viewer.replica().past()->seq == 2);
  CHECK(states_of(viewer.replica()) == builder.moments[2]);
  server->stop();
}

TEST_CASE("a moment may be named by its time", "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  Builder builder(server->port());
  builder.build(5);
  LiveSession viewer(server->port(), kView);
  viewer.catch_up();
  viewer.travel(to_seq(3));
  const TimeUs third_us = viewer.replica().past()->utc_us;
  CHECK(third_us > 0);
  viewer.travel({1, HistoryTarget::time, 0, third_us});
  CHECK(viewer.replica().past()->seq == 3);
  viewer.travel({1, HistoryTarget::time, 0, third_us - 1});
  CHECK(viewer.replica().past()->seq == 2);
  CHECK(states_of(viewer.replica()) == builder.moments[2]);
  viewer.travel({1, HistoryTarget::time, 0, 1});
  CHECK(viewer.replica().past()->seq == 0);
  server->stop();
}

TEST_CASE("of several requests in a row the last one takes effect", "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  Builder builder(server->port());
  builder.build(12);
  LiveSession viewer(server->port(), kView);
  viewer.catch_up();
  for (Sequence seq = 0; seq <= 12; ++seq)
    REQUIRE(viewer.session().request_history(to_seq(seq)).has_value());
  viewer.travel(to_seq(5));
  CHECK(viewer.replica().past()->seq == 5);
  CHECK(states_of(viewer.replica()) == builder.moments[5]);
  for (Sequence seq = 0; seq <= 12; ++seq)
    REQUIRE(viewer.session().request_history(to_seq(seq)).has_value());
  viewer.travel({});
  viewer.catch_up();
  CHECK(states_of(viewer.replica()) == builder.moments[12]);
  server->stop();
}

}  // namespace runstone::test
