// A server that cannot start or finds damage writes one clear line and overwrites nothing.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "common/core/epoch_branch.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/sql/crash_image.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/support/store/compact_by_hand.hpp"

namespace runstone::test {
namespace {

std::string start_error(const ServerConfig& config, const WorldCreation& creation) {
  const auto server = Server::start(config, creation);
  REQUIRE_FALSE(server.has_value());
  CHECK(server.error().find('\n') == std::string::npos);
  return server.error();
}

/// Changes at least one row of a closed world.
void run_sql(const std::string& file, const std::string& sql) {
  const std::string changes = raw_sql(file, sql + "; SELECT changes()");
  INFO(changes);
  REQUIRE(std::atoi(changes.c_str()) > 0);
}

TEST_CASE("a busy port is named, and the world keeps its epoch", "[integration]") {
  const TempFolder folder;
  const auto first = start_server(quiet_config(folder / "first"), flat_creation());
  ServerConfig config = quiet_config(folder / "second");
  {
    CHECK(start_server(config, flat_creation())->stop().is_clean);
  }
  config.listen = "127.0.0.1:" + std::to_string(first->port());
  CHECK(contains(start_error(config, flat_creation()), config.listen));
  config.listen = "127.0.0.1:0";
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  CHECK(client.welcome.epoch == 2);
}

TEST_CASE("an invalid address is named, and no world is made", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  for (const char* address : {":", "127.0.0.1:", "127.0.0.1:70000", "127.0.0.1:x"}) {
    config.listen = address;
    CHECK(contains(start_error(config, flat_creation()), address));
  }
  CHECK(::access((folder / "world").c_str(), F_OK) != 0);
}

TEST_CASE("an empty world file is named and left alone", "[integration]") {
  const TempFolder folder;
  {
    std::ofstream file(folder / "world.sqlite");
  }
  const auto self = folder / ".";
  CHECK(contains(start_error(quiet_config(self), flat_creation()), "world.sqlite: is empty"));
  CHECK(std::ifstream(folder / "world.sqlite").good());
}

TEST_CASE("an unknown generator, edge or materials file makes no world", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  WorldCreation creation = flat_creation();
  SECTION("generator") {
    creation.generator = "volcano";
    CHECK(contains(start_error(config, creation), "volcano"));
  }
  SECTION("edge") {
    creation.edge = 33;
    CHECK(contains(start_error(config, creation), "33"));
  }
  SECTION("missing materials") {
    creation.materials_file = folder / "none.toml";
    CHECK(contains(start_error(config, creation), "none.toml"));
  }
  SECTION("broken materials") {
    creation.materials_file = folder / "broken.toml";
    std::ofstream(creation.materials_file) << "[[material]]\nname = \n";
    CHECK(contains(start_error(config, creation), "broken.toml:2"));
  }
  CHECK_FALSE(has_world(config.world));
}

TEST_CASE("a second server on the same world does not start", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  const auto first = start_server(config, flat_creation());
  CHECK(contains(start_error(config, flat_creation()), "world"));
  RawClient client(first->port());
  CHECK(client.join(1).has_value());
}

TEST_CASE("a file that is no world is named and left as it is", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  std::filesystem::create_directories(config.world);
  const std::string file = config.world + "/world.sqlite";
  const std::string content = "this is a text, not a database, and somebody may still need it";
  std::ofstream(file) << content;
  CHECK(contains(start_error(config, flat_creation()), "world.sqlite"));
  std::ifstream in(file);
  CHECK(std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>()) ==
        content);
}

TEST_CASE("a folder that cannot be written is named", "[integration]") {
  if (::geteuid() == 0) {
    WARN("root may write everywhere: a file in place of the folder stands in");
  }
  const TempFolder folder;
  std::ofstream(folder / "file") << "x";
  const ServerConfig config = quiet_config(folder / "file/world");
  CHECK(contains(start_error(config, flat_creation()), "file"));
}

/// A world with edits in three chunks, stopped cleanly.
void make_edited_world(const ServerConfig& config) {
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  REQUIRE(client.join(1).has_value());
  for (ClientSequence seq = 1; seq <= 3; ++seq) {
    const auto x = static_cast<std::int32_t>(seq - 1) * 16;
    client.send(EditRequest{seq, 0, {SetVoxel{{x, 1, 1}}, {}, 2}});
  }
  REQUIRE(client.sees_durable(3));
  REQUIRE(server->stop().is_clean);
}

TEST_CASE("a damaged snapshot is quarantined: not sent, not regenerated, its edits still ordered",
          "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  run_sql(config.world + "/world.sqlite", "UPDATE snapshot SET data = zeroblob(40) WHERE x = 1");
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    client.send(View{1, {0, 0, 0}, 2, 0});
    std::set<ChunkKey> got;
    for (int i = 0; i < 12; ++i) {
      const auto snapshot = client.next_of<ChunkSnapshot>();
      REQUIRE(snapshot.has_value());
      got.insert(snapshot->key);
    }
    CHECK(got.size() == 12);
    CHECK_FALSE(got.contains({0, {1, 0, 0}}));
    client.send(EditRequest{4, 0, {SetVoxel{{17, 1, 1}}, {}, 3}});
    const auto commit = client.next_of<Commit>();
    REQUIRE(commit.has_value());
    CHECK(commit->edits.at(0).seq == 4);
    CHECK(commit->edits.at(0).previous == std::vector<Sequence>{2});
    const StopReport report = server->stop();
    CHECK(report.is_clean);
    CHECK(contains(report.error, "chunk=1,0,0"));
  }
  // The damaged row was not replaced.
  run_sql(config.world + "/world.sqlite",
          "UPDATE snapshot SET data = data WHERE x = 1 AND data = zeroblob(40)");
}

TEST_CASE("a damaged log row above the checkpoint stops the start and is named", "[integration]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  const std::string file = config.world + "/world.sqlite";
  run_sql(file, "UPDATE edit_log SET checksum = checksum + 1 WHERE seq = 3");
  CHECK(contains(start_error(config, flat_creation()), "seq=3"));
}

TEST_CASE(
    "a world whose log was compacted to its end goes on at its sequence and never before its time",
    "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  constexpr TimeUs kFuture = 9'000'000'000'000'000;  // the wall clock was set back since
  compact_by_hand(config.world + "/world.sqlite", {{1, 3}, kFuture}, {});
  {
    const auto server = start_server(config, flat_creation());
    RawClient client(server->port());
    REQUIRE(client.join(1).has_value());
    client.send(EditRequest{4, 0, {SetVoxel{{1, 1, 1}}, {}, 3}});
    REQUIRE(client.sees_durable(4));
    CHECK(server->stop().is_clean);
  }
  const auto store = open_world(config.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  CHECK(*(*store)->log_range() == LogRange{4, {{2, 4}, kFuture}});
}

TEST_CASE("a damaged last log row stops the start even if no edit is above the checkpoint",
          "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  run_sql(config.world + "/world.sqlite",
          "UPDATE edit_log SET time_us = time_us + 1 WHERE seq = 3");
  CHECK(contains(start_error(config, flat_creation()), "edit_log seq=3"));
}

TEST_CASE("a server does not start over lost edits unless they are accepted", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  ServerConfig killed = quiet_config(folder / "killed");
  {
    const auto server = start_server(config, flat_creation());
    RawClient ana(server->port()), ben(server->port());
    REQUIRE(ana.join(1).has_value());
    REQUIRE(ben.join(2)->author == 2);
    ben.send(EditRequest{1, 0, {SetVoxel{{1, 2, 1}}, {}, 2}});
    REQUIRE(ben.sees_durable(4));
    copy_crash_image(config.world, killed.world);
  }
  std::filesystem::remove(killed.world + "/world.sqlite-wal");
  const std::string error = start_error(killed, flat_creation());
  INFO(error);
  CHECK(contains(error, "world.sqlite: edit_log: ends at seq=3, but seq=4 was durable"));
  CHECK(contains(error, "--accept-losses"));
  CHECK(start_error(killed, flat_creation()) == error);
  {
    const auto server = start_server(killed, flat_creation(), true);
    RawClient cid(server->port());
    const auto accepted = cid.join(3);
    REQUIRE(accepted.has_value());
    CHECK_FALSE(is_same_branch(cid.welcome.epoch, 2));
    CHECK(cid.welcome.durable == 3);
    CHECK(accepted->author == 3);  // 2 was Ben's
    cid.send(EditRequest{1, 0, {SetVoxel{{1, 2, 1}}, {}, 3}});
    REQUIRE(cid.sees_durable(4));
    CHECK(server->stop().is_clean);
  }
  CHECK(start_server(killed, flat_creation())->stop().is_clean);
}

TEST_CASE("a player whose row is lost keeps a newcomer from the number", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  run_sql(config.world + "/world.sqlite", "DELETE FROM player");
  const std::string error = start_error(config, flat_creation());
  CHECK(contains(error, "player: rows vanished"));
  CHECK(contains(error, "0 rows, meta counts 1, none for author=1"));
  {
    const auto server = start_server(config, flat_creation(), true);
    RawClient client(server->port());
    const auto accepted = client.join(2);
    REQUIRE(accepted.has_value());
    CHECK(accepted->author == 2);
  }
  CHECK(start_server(config, flat_creation())->stop().is_clean);
}

TEST_CASE("a lost watermark does not let an edit be applied twice", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  run_sql(config.world + "/world.sqlite", "DELETE FROM player_instance");
  CHECK(contains(start_error(config, flat_creation()), "player_instance: rows vanished"));
  const auto server = start_server(config, flat_creation(), true);
  RawClient client(server->port());
  const auto accepted = client.join(1);
  REQUIRE(accepted.has_value());
  CHECK(accepted->resolved == 3);
}

TEST_CASE("a world of a newer version does not start", "[integration]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  make_edited_world(config);
  run_sql(config.world + "/world.sqlite",
          "CREATE TABLE t(x); INSERT INTO t VALUES(1); PRAGMA user_version = 99");
  const std::string error = start_error(config, flat_creation());
  CHECK(contains(error, "world.sqlite: is of world format 99; this program knows format "));
}

}  // namespace
}  // namespace runstone::test
