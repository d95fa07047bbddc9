// A running server makes keyframes of old and new edits of its log. If it cannot, it goes on
// without them.
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "server/history/world_at.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

constexpr std::uint64_t kEvery = 20;

EditDescriptor nth_edit(Sequence n) {
  const auto i = static_cast<std::int32_t>(n);
  return {SetVoxel{{i % 16, i / 16 % 16, i / 256 % 16}}, {}, static_cast<Material>(1 + n % 3)};
}

/// Makes a closed world whose log has `count` edits in one chunk.
void make_world(const std::string& folder, Sequence count) {
  WorldMeta meta = sample_meta();
  meta.generator.name = "flat";
  auto store = *create_world(folder, meta);
  REQUIRE(store->raise_epoch().has_value());
  SplitMix64 rng(1);
  auto records = sample_records(rng, 1, 1, count);
  for (EditRecord& record : records) record.edit = nth_edit(record.version.seq);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  REQUIRE(store->append(players, records).has_value());
}

ServerConfig keyframe_config(const std::string& world) {
  ServerConfig config = quiet_config(world);
  config.keyframe_edits = kEvery;
  return config;
}

std::vector<Sequence> places(const std::string& folder) {
  std::vector<Sequence> found;
  const auto store = *open_world(folder, StoreAccess::read_only);
  const auto keyframes = *store->keyframes();
  for (const Keyframe& keyframe : keyframes) {
    found.push_back(keyframe.at.version.seq);
  }
  return found;
}

/// Waits until the world has so many keyframes, for at most half a minute.
bool wait_for(const std::string& folder, std::size_t keyframes) {
  for (int i = 0; i < 3000; ++i) {
    if (places(folder).size() >= keyframes) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

std::vector<Sequence> multiples(std::size_t count) {
  std::vector<Sequence> out;
  for (std::size_t i = 1; i <= count; ++i) out.push_back(i * kEvery);
  return out;
}

TEST_CASE("a server makes the keyframes that its log lacks, and new ones as the log grows",
          "[integration][keyframe]") {
  const TempFolder folder;
  make_world(folder.path(), 130);
  {
    const auto server = start_server(keyframe_config(folder.path()), {});
    CHECK(wait_for(folder.path(), 6));
    RawClient client(server->port());
    const auto accepted = client.join(1);
    REQUIRE(accepted.has_value());
    for (Sequence seq = 131; seq <= 185; ++seq)
      client.send(EditRequest{seq - 130, 0, nth_edit(seq)});
    CHECK(client.sees_durable(185));
    CHECK(wait_for(folder.path(), 9));
    const StopReport report = server->stop();
    CHECK(report.is_clean);
    CHECK(report.error.empty());
  }
  CHECK(places(folder.path()) == multiples(9));
  auto store = *open_world(folder.path(), StoreAccess::read_only);
  const auto checked = store->check();
  CHECK((checked ? "" : checked.error().message()) == "");
  const auto generator = *make_generator(store->meta().generator, store->meta().materials);
  auto world = *WorldAt::open(*store, *generator, 185);
  CHECK(world.stored_at() == 180);
  CHECK(world.chunk({0, {0, 0, 0}})->digest == (*store->load_snapshot({0, {0, 0, 0}}))->digest);
}

TEST_CASE("a server configured without keyframes makes none", "[integration][keyframe]") {
  const TempFolder folder;
  make_world(folder.path(), 60);
  ServerConfig config = keyframe_config(folder.path());
  config.keyframe_edits = 0;
  CHECK(start_server(config, {})->stop().is_clean);
  CHECK(places(folder.path()).empty());
}

TEST_CASE("a damaged edit ends the keyframe thread, not the server", "[integration][keyframe]") {
  const TempFolder folder;
  make_world(folder.path(), 100);
  CHECK(start_server(quiet_config(folder.path()), {})
            ->stop()
            .is_clean);  // every edit is in a snapshot, so the next start reads no old edit
  REQUIRE(raw_sql(folder / "world.sqlite",
                  "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 50; SELECT changes()") ==
          "1");
  const auto server = start_server(keyframe_config(folder.path()), {});
  CHECK(wait_for(folder.path(), 2));
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  for (Sequence seq = 101; seq <= 150; ++seq) client.send(EditRequest{seq - 100, 0, nth_edit(seq)});
  CHECK(client.sees_durable(150));
  CHECK(server->stop().is_clean);
  CHECK(places(folder.path()) == multiples(2));
}

TEST_CASE("runstone-replay makes the keyframes that a world lacks", "[integration][keyframe]") {
  const TempFolder folder;
  make_world(folder.path(), 130);
  const auto once = run_replay({"keyframes", "--world", folder.path(), "--keyframe-edits", "20"});
  CHECK(once.code == 0);
  CHECK(once.err == "");
  CHECK(once.out == "keyframes   6 made of 6 chunks, 0 there before\n");
  CHECK(places(folder.path()) == multiples(6));
  CHECK(run_replay({"keyframes", "--world", folder.path(), "--keyframe-edits", "20"}).out ==
        "keyframes   0 made of 0 chunks, 6 there before\n");
  const auto held = *open_world(folder.path(), StoreAccess::read_write);
  const auto refused = run_replay({"keyframes", "--world", folder.path()});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("another program is writing this world") != std::string::npos);
}

}  // namespace
}  // namespace runstone::test
