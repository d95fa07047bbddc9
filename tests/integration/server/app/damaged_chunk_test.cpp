// One damaged row in the database: sessions that see its chunk get "chunk unavailable", everything
// else works, and the row stays as it is, so that it can be repaired.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/fault_vfs.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone {
namespace {

using test::flat_creation;
using test::quiet_config;
using test::raw_sql;
using test::RawClient;
using test::start_server;
using test::TempFolder;

constexpr ChunkKey kDamaged{0, {0, 0, 0}};
const char* const kRow =
    "SELECT hex(data) || '/' || checksum FROM snapshot WHERE x=0 AND y=0 AND z=0";

EditRequest edit(ClientSequence seq, VoxelPos at) { return {seq, 0, {SetVoxel{at}, {}, 1}}; }

/// The answers for the chunks of a view.
struct Answers {
  std::set<ChunkKey> sent, unavailable;
};
/// Reads until `count` chunks are answered.
Answers answers(RawClient& client, std::size_t count) {
  Answers got;
  while (got.sent.size() + got.unavailable.size() < count) {
    auto message = client.next();
    REQUIRE(message.has_value());
    if (const auto* snapshot = RawClient::snapshot_in(*message)) got.sent.insert(snapshot->key);
    if (const auto* none = std::get_if<ChunkUnavailable>(&*message)) {
      CHECK(none->reason == UnavailableReason::damaged);
      got.unavailable.insert(none->keys.begin(), none->keys.end());
    }
  }
  return got;
}

/// A world with snapshots of two chunks, one of them damaged afterwards.
void make_damaged_world(const std::string& folder) {
  {
    const auto server = start_server(quiet_config(folder), flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    client.send(edit(1, {1, 1, 1}));
    client.send(edit(2, {17, 1, 1}));
    while (true) {
      const auto durable = client.next_of<Durable>();
      REQUIRE(durable.has_value());
      if (durable->seq == 2) break;
    }
    REQUIRE(server->stop().is_clean);
  }
  const std::string damage =
      "UPDATE snapshot SET data = zeroblob(length(data)) "
      "WHERE x=0 AND y=0 AND z=0; SELECT changes()";
  REQUIRE(raw_sql(folder + "/world.sqlite", damage) == "1");
}

TEST_CASE("a disk that cannot be read for a moment quarantines no chunk", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.log_level = LogLevel::error;
  test::FaultVfs disk;
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    disk.fail(1, EIO, test::FaultVfs::Lasts::for_ever);
    client.send(View{1, {0, 0, 0}, 1, 0});
    while (!disk.has_failed()) std::this_thread::yield();
    // The other loads of the view meet the error as well. Each is tried again after a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    disk.heal();
    const Answers seen = answers(client, 5);
    CHECK(seen.sent.size() == 5);
    CHECK(seen.unavailable.empty());
    CHECK(server->stop().is_clean);
  }
}

TEST_CASE("a damaged chunk is unavailable to the sessions that see it, and others are not affected",
          "[integration]") {
  const TempFolder folder;
  make_damaged_world(folder / "world");
  const std::string row = raw_sql(folder / "world/world.sqlite", kRow);
  REQUIRE(row.find('/') != std::string::npos);
  {
    ServerConfig config = quiet_config(folder / "world");
    config.log_level = LogLevel::error;
    const auto server = start_server(config, flat_creation());
    RawClient near(server->port());
    RawClient far(server->port());
    REQUIRE(near.join(1, 2).has_value());
    REQUIRE(far.join(2).has_value());
    near.send(View{1, {0, 0, 0}, 1, 0});
    const Answers seen = answers(near, 5);
    CHECK(seen.unavailable == std::set{kDamaged});
    CHECK(seen.sent.size() == 4);
    CHECK(seen.sent.contains({0, {1, 0, 0}}));
    far.send(View{1, {5, 0, 0}, 1, 0});
    CHECK(answers(far, 5).sent.size() == 5);

    near.send(edit(1, {18, 1, 1}));  // the neighbouring chunk accepts edits
    auto commit = near.next_of<Commit>();
    REQUIRE(commit.has_value());
    CHECK(commit->edits.at(0).seq == 3);
    CHECK(commit->edits.at(0).previous == std::vector<Sequence>{2});
    far.send(edit(1, {2, 1, 1}));  // an edit of the damaged chunk is ordered like any other
    commit = far.next_of<Commit>();
    REQUIRE(commit.has_value());
    CHECK(commit->edits.at(0).previous == std::vector<Sequence>{1});
    far.send(ChunkRequest{{kDamaged}});  // the chunk is not in the session's view
    near.send(ChunkRequest{{kDamaged}});
    CHECK(answers(near, 1).unavailable == std::set{kDamaged});
    static_cast<void>(server->stop());
  }
  CHECK(raw_sql(folder / "world/world.sqlite", kRow) == row);
}

}  // namespace
}  // namespace runstone
