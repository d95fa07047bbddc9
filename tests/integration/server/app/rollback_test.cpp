// Undo, redo and rollback on a running server: from a client, through the control socket, and while
// another player builds. Afterwards server, snapshots and a replay of the log agree.
#include <sys/stat.h>

#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/local/stream_protocol.hpp>
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>
#include <thread>

#include "common/core/hex.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/control_program.hpp"
#include "server/admin/control_socket.hpp"
#include "server/store/store.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/support/net/raw_client.hpp"
#include "tests/support/replay/run_replay.hpp"

namespace runstone::test {
namespace {

void build(RawClient& client, ClientSequence seq, const EditShape& shape, Material material) {
  client.send(EditRequest{seq, 0, {shape, {}, material}});
}

/// Returns the voxels of the world from its log alone.
std::string replayed(const std::string& world) {
  const auto replay = run_replay({"verify", "--world", world});
  INFO(replay.out << replay.err);
  REQUIRE(replay.code == 0);
  return replay.out;
}

}  // namespace

TEST_CASE("players undo and redo by a command, and other commands need rights",
          "[integration][rollback]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  KeySeed seed{};
  seed.fill(2);
  config.operators = {key_pair_of(seed).public_key};
  auto server = start_server(config, flat_creation());
  RawClient ana(server->port());
  ana.features = kFeatureCommands;
  REQUIRE(ana.join(1).has_value());
  build(ana, 1, FillBox{{{0, 70, 0}, {4, 74, 4}}}, 1);
  build(ana, 2, FillBox{{{2, 70, 0}, {6, 74, 4}}}, 2);
  CHECK(command(ana, "undo").text == "undo: 64 voxels in 1 chunk\n");
  CHECK(command(ana, "undo").text == "undo: 64 voxels in 1 chunk\n");
  CHECK_FALSE(command(ana, "undo").is_ok);
  CHECK(command(ana, "redo").is_ok);
  CHECK(command(ana, "redo").is_ok);
  const Answer nothing = command(ana, "redo");
  CHECK_FALSE(nothing.is_ok);
  CHECK(nothing.text == "nothing to redo\n");
  // A player with the right `build` may roll back on the player's own ground only.
  const Answer refused = command(ana, "rollback preview author ben");
  CHECK_FALSE(refused.is_ok);
  INFO(refused.text);
  CHECK(refused.text.find("roll_back") != std::string::npos);

  RawClient boss(server->port());
  boss.features = kFeatureCommands;
  REQUIRE(boss.join(2).has_value());
  CHECK(command(boss, "rollback list").is_ok);
  CHECK(command(boss, "log limit 3").text.find(" redo of 2 restored 2 70 0 to 5 73 3\n") !=
        std::string::npos);
  seed.fill(1);
  const std::string key = to_hex(key_pair_of(seed).public_key);
  const std::string shown = key_fingerprint(key_pair_of(seed).public_key);
  CHECK(command(boss, "players").text.find("player1 #1 " + shown + " key " + key + " is here") !=
        std::string::npos);
  CHECK(command(boss, "rollback preview author nobody").text.find("nobody of that name") !=
        std::string::npos);

  // Faster than any player types.
  for (std::uint32_t i = 0; i < 60; ++i) ana.send(CommandRequest{1000 + i, "help"});
  int too_many = 0;
  for (std::uint32_t i = 0; i < 60;) {
    const auto output = ana.next_of<CommandOutput>();
    REQUIRE(output.has_value());
    too_many += !output->lines.empty() && !output->is_ok ? 1 : 0;
    i += output->is_done ? 1 : 0;
  }
  CHECK(too_many > 0);
  const StopReport report = server->stop();
  CHECK(report.is_clean);
  CHECK(report.error.empty());
  replayed(folder / "world");
}

TEST_CASE("a griefer is rolled back by control while a builder builds", "[integration][rollback]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  auto server = start_server(quiet_config(world), flat_creation());
  struct stat mode{};
  REQUIRE(::stat((world + "/" + kControlSocketName).c_str(), &mode) == 0);
  CHECK((mode.st_mode & 0777) == 0600);
  RawClient builder(server->port());
  RawClient griefer(server->port());
  REQUIRE(builder.join(1).has_value());
  REQUIRE(griefer.join(2).has_value());
  build(builder, 1, FillBox{{{-30, 80, -30}, {30, 90, 30}}}, 1);
  REQUIRE(builder.sees_durable(1));
  for (ClientSequence i = 1; i <= 40; ++i) {
    const auto x = static_cast<std::int32_t>(i);
    build(griefer, i, FillSphere{{-40 + 2 * x, 85, 20 - x}, 9}, i % 2 == 0 ? kEmpty : Material{3});
  }
  REQUIRE(griefer.sees_durable(41));
  const Answer preview =
      control(world, {"rollback", "preview", "author", "player2", "since", "1h"});
  INFO(preview.text);
  REQUIRE(preview.is_ok);
  CHECK(preview.text.find("would take back 40 edits") != std::string::npos);

  // The builder sets voxels everywhere until the rollback is done.
  std::atomic<bool> is_done{false};
  std::atomic<int> rounds{0};
  std::thread building([&] {
    for (ClientSequence i = 2; i < 4000 && !is_done; ++i) {
      const auto n = static_cast<std::int32_t>(i);
      build(builder, i, SetVoxel{{-30 + n * 7 % 60, 80 + n % 10, -30 + n * 13 % 60}}, 2);
      ++rounds;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  const Answer applied = control(world, {"rollback", "apply", "p1"});
  is_done = true;
  building.join();
  INFO(applied.text);
  CHECK(applied.is_ok);
  CHECK(applied.text.find("rollback p1 done") != std::string::npos);
  const int built = rounds;
  CHECK(built > 0);
  CHECK(control(world, {"rollback", "preview", "author", "player2"}).text.find("nothing to do") !=
        std::string::npos);
  CHECK(control(world, {"rollback", "list"}).text.starts_with("rollback "));
  builder.send(Goodbye{GoodbyeReason::closing, ""});
  griefer.send(Goodbye{GoodbyeReason::closing, ""});
  const StopReport report = server->stop();
  CHECK(report.is_clean);
  CHECK(report.error.empty());
  CHECK_FALSE(std::filesystem::exists(world + "/" + kControlSocketName));
  replayed(world);

  // The house is as its builder left it, without any of the griefer's edits.
  const auto store = *open_world(world, StoreAccess::read_only);
  std::set<VoxelPos> touched;
  for (ClientSequence i = 2; i < 2 + static_cast<ClientSequence>(built); ++i) {
    const auto n = static_cast<std::int32_t>(i);
    touched.insert({-30 + n * 7 % 60, 80 + n % 10, -30 + n * 13 % 60});
  }
  std::uint64_t wrong = 0;
  for (int y = 70; y < 100; ++y) {
    for (int z = -40; z < 40; ++z) {
      for (int x = -60; x < 60; ++x) {
        const VoxelPos p{x, y, z};
        const auto chunk = store->load_snapshot({0, chunk_of(p, 16)});
        REQUIRE(chunk.has_value());
        const Material is =
            chunk->has_value() ? material_at((*chunk)->voxels, local_of(p, 16)) : kEmpty;
        const bool in_house = VoxelBox{{-30, 80, -30}, {30, 90, 30}}.contains(p);
        const Material ought = touched.contains(p) ? Material{2} : in_house ? Material{1} : kEmpty;
        wrong += is == ought ? 0 : 1;
      }
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("commands find a renamed player by the old name, and choose nobody if two had it",
          "[integration][rollback]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  Sequence edits = 0;
  const auto edit_as = [&](Server& server, std::uint8_t who, const std::string& name,
                           ClientInstance instance) {
    RawClient client(server.port());
    client.name = name;
    REQUIRE(client.join(who, instance).has_value());
    build(client, 1, SetVoxel{{who, 80, static_cast<std::int32_t>(instance)}}, 1);
    REQUIRE(client.sees_durable(++edits));
  };
  {
    auto server = start_server(quiet_config(world), flat_creation());
    edit_as(*server, 1, "mole", 1);
    edit_as(*server, 1, "angel", 2);
    server->stop();
  }
  auto server = start_server(quiet_config(world), flat_creation());
  const Answer log = control(world, {"log", "author", "mole"});
  CHECK(log.is_ok);
  CHECK(log.text.starts_with("author \"mole\" is now called angel #1 "));
  KeySeed seed{};
  seed.fill(1);
  const std::string angel = " angel #1 " + key_fingerprint(key_pair_of(seed).public_key);
  CHECK(log.text.find(angel + " player voxel 1 80 2") != std::string::npos);
  const Answer preview = control(world, {"rollback", "preview", "author", "mole"});
  CHECK(preview.is_ok);
  CHECK(preview.text.find("would take back 2 edits") != std::string::npos);
  CHECK(control(world, {"log", "author", "angel"}).text.find("now called") == std::string::npos);
  // Names are folded here as in every command.
  CHECK(control(world, {"log", "author", "ANGEL"}).text ==
        control(world, {"log", "author", "angel"}).text);

  edit_as(*server, 2, "mole", 1);
  const Answer several = control(world, {"log", "author", "mole"});
  CHECK_FALSE(several.is_ok);
  CHECK(several.text.find("several players have, own or had that name: ") != std::string::npos);
}

TEST_CASE("a silent control connection does not keep a server from stopping",
          "[integration][rollback]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  asio::io_context io;
  asio::local::stream_protocol::socket idle(io);
  idle.connect(*control_path(folder.path()));
  CHECK(control(folder.path(), {"status"}).is_ok);
  CHECK(server->stop().is_clean);
  asio::error_code error;
  std::array<char, 1> byte{};
  CHECK(idle.read_some(asio::buffer(byte), error) == 0);
  CHECK(error == asio::error::eof);
}

TEST_CASE("control reports that no server runs the world, or that its path is too long",
          "[integration][rollback]") {
  const TempFolder folder;
  std::ostringstream out;
  const auto two_lines = control_server({folder / "none", {"status\nstop"}}, out);
  CHECK(two_lines.error() == "control: the command is not one line of UTF-8 text");
  const auto nobody = control_server({folder / "none", {"status"}}, out);
  REQUIRE_FALSE(nobody.has_value());
  CHECK(nobody.error().find("no server of this user runs that world") != std::string::npos);
  const auto too_long = control_server({std::string(200, 'a'), {"status"}}, out);
  REQUIRE_FALSE(too_long.has_value());
  CHECK(too_long.error().find("has at most 107 bytes") != std::string::npos);
}

TEST_CASE("the socket file of a killed server is replaced", "[integration][rollback]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  start_server(quiet_config(world), flat_creation())->stop();
  {
    asio::io_context io;
    auto left = ControlSocket::listen(io, world, [](const std::string&, CommandReply) {});
    REQUIRE(left.has_value());
    std::filesystem::rename(world + "/" + kControlSocketName, world + "/kept");
  }
  std::filesystem::rename(world + "/kept", world + "/" + kControlSocketName);
  const auto server = start_server(quiet_config(world), flat_creation());
  CHECK(control(world, {"status"}).is_ok);
}

}  // namespace runstone::test
