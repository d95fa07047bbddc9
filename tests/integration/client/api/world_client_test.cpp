// WorldClient against a server: terrain whose neighbours arrive later, edits, losses and refusals.
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <string>

#include "tests/integration/client/api/joined_client.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"

namespace runstone::test {
namespace {

WorldClientOptions options_of(const Server& server, std::uint8_t radius = 2) {
  WorldClientOptions options;
  options.server = "127.0.0.1:" + std::to_string(server.port());
  options.name = "ada";
  options.view_radius = options.view_radius_vertical = radius;
  return options;
}

/// The flat world is solid below y = 0 and around it.
EditDescriptor voxel(VoxelPos at, Material material) { return {SetVoxel{at}, {}, material}; }

}  // namespace

TEST_CASE("a program that meshes the chunks that it is told keeps no mesh out of date",
          "[integration][client_api]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), terrain_creation());
  JoinedClient ada(options_of(*server, 3)), ben(options_of(*server, 2));
  CHECK(ada.await<WorldOpened>().is_another);
  ada.catch_up();
  REQUIRE(ada.meshes.size() > 50);
  CHECK(ada.outdated_meshes() == 0);
  CHECK(ada.terrain_again == 0);  // each chunk waited for its neighbours

  // The view moves: chunks at its edge get neighbours, and others lose theirs.
  ClientPlace place = ada->place();
  place.at.x += 3 * 16;
  REQUIRE(ada->move(place).has_value());
  ada.catch_up();
  CHECK(ada.terrain_again > 10);
  CHECK(ada.outdated_meshes() == 0);

  // Edits at borders and corners of chunks, by both.
  ben.catch_up();
  const Material stone = ada->find_material("stone").value();
  REQUIRE(ben->find_material("stone") == stone);
  const VoxelPos eye{static_cast<std::int32_t>(place.at.x), static_cast<std::int32_t>(place.at.y),
                     static_cast<std::int32_t>(place.at.z)};
  const VoxelPos corner = origin_of(chunk_of(eye, 16), 16);
  const EditNumber first = ada.edit({FillSphere{corner, 5}, {}, stone});
  CHECK(ada.await<EditConfirmed>().edit == first);
  ben.edit({FillBox{{{corner.x - 1, corner.y - 1, corner.z - 1}, corner}}, {}, kEmpty});
  ben.await<EditConfirmed>();
  const OthersEdit seen = ada.await<OthersEdit>();
  CHECK(seen.author == ben->world()->author);
  CHECK(seen.chunks.size() >= 4);
  ada.catch_up();
  CHECK(ada.outdated_meshes() == 0);
  CHECK(ada->material_at({corner.x - 1, corner.y - 1, corner.z - 1}) == kEmpty);
}

TEST_CASE("edits are confirmed, durable, rejected and refused, each with words",
          "[integration][client_api]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.reach_max = 20;
  auto server = start_server(config, flat_creation());
  JoinedClient ada(options_of(*server, 3));
  CHECK(ada->submit(voxel({0, 20, 0}, 1)).error().text == "no world is open");
  CHECK_FALSE(ada->move({}).has_value());
  ada.catch_up();
  const ClientPlace place = ada->place();
  const VoxelPos near{static_cast<std::int32_t>(place.at.x),
                      static_cast<std::int32_t>(place.at.y) + 3,
                      static_cast<std::int32_t>(place.at.z)};
  const EditNumber good = ada.edit(voxel(near, 1));
  CHECK(ada->material_at(near) == Material{1});  // at once
  const EditConfirmed confirmed = ada.await<EditConfirmed>();
  CHECK(confirmed.edit == good);
  CHECK(confirmed.sequence == 1);
  CHECK(ada.await<EditDurable>().edit == good);

  const VoxelPos far{near.x + 40, near.y, near.z};
  const EditNumber bad = ada.edit(voxel(far, 1));
  CHECK(ada->material_at(far) == Material{1});
  const EditRejected rejected = ada.await<EditRejected>();
  CHECK(rejected.edit == bad);
  CHECK(rejected.reason == "out_of_reach");
  CHECK_FALSE(rejected.text.empty());
  CHECK(ada->material_at(far) == kEmpty);

  // The client refuses an edit before it is sent if it knows itself that the edit is invalid.
  CHECK(ada->submit({FillSphere{near, 60'000}, {}, 1}).error().code == ErrorCode::limit_exceeded);
  CHECK_FALSE(ada->submit(voxel(near, 60'000)).error().text.empty());
  CHECK(ada->submit(clock_edit({})).error().code == ErrorCode::unknown_kind);
  must(config.world, {"role", "default", "visitor"});
  ada.until([&] { return !ada->submit(voxel(near, 2)).has_value(); });
  const auto refused = ada->submit(voxel(near, 2));
  CHECK(refused.error().code == ErrorCode::not_permitted);
  CHECK_FALSE(refused.error().text.empty());

  ClientPlace nowhere = place;
  nowhere.at.x = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(ada->move(nowhere).has_value());
  nowhere.at.x = 1e300;
  CHECK_FALSE(ada->move(nowhere).has_value());
  CHECK_FALSE(ada->set_view_radii(65, 1).has_value());
}

TEST_CASE("chat, commands and players reach a program as events", "[integration][client_api]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  JoinedClient ada(options_of(*server, 1));
  ada.catch_up();
  WorldClientOptions of_ben = options_of(*server, 1);
  of_ben.name = "ben";
  JoinedClient ben(of_ben);
  ben.catch_up();
  ada.until([&] { return ada->players().size() == 1; });
  CHECK(ada->players()[0].name == "ben");
  REQUIRE(ben->chat("hello").has_value());
  ada.until([&] {
    const auto line = ada.await<ChatReceived>();
    return line.from == ChatReceived::From::player && line.text == "hello" && line.name == "ben";
  });
  CHECK_FALSE(ben->chat("").has_value());
  const EditNumber edit = ben.edit(voxel({2, 20, 2}, 1));
  CHECK(ben.await<EditConfirmed>().edit == edit);
  REQUIRE(ben->command("undo").has_value());
  CHECK(ben->command("undo").error().text == "the previous command is still running");
  const CommandDone done = ben.await<CommandDone>();
  CHECK(done.is_ok);
  CHECK_FALSE(done.lines.empty());
  ada.until([&] { return ada->material_at({2, 20, 2}) == kEmpty; });
  // At most one answer waits: the next command is refused until the program has drained it.
  REQUIRE(ben->command("no-such-command").has_value());
  std::string why = "the previous command is still running";
  for (int i = 0; i < 6'000 && why == "the previous command is still running"; ++i) {
    ben->wait(10);
    ben->step();
    const auto again = ben->command("undo");
    why = again ? "" : again.error().text;
  }
  CHECK(why == "the answer of the previous command was not drained");
  CHECK_FALSE(ben.await<CommandDone>().is_ok);
  ben->close();
  CHECK(ben->state() == ConnectionState::ended);
  CHECK(ben->command("undo").error().text == "no world is open");
  CHECK(ben->chunk({0, 0, 0}) != nullptr);
  ada.until([&] { return ada->players().empty(); });
}

TEST_CASE("a server that ends is reported, and an edit made meanwhile reaches the next one",
          "[integration][client_api]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  WorldClientOptions options = options_of(*server, 1);
  options.key_file = folder / "ada.key";
  options.cache_folder = folder / "cache";
  config.listen = options.server;
  JoinedClient ada(options);
  CHECK(ada.await<WorldOpened>().is_first_contact);
  ada.catch_up();
  CHECK(std::filesystem::exists(folder / "ada.key.servers"));
  const auto id = ada->world()->id;

  static_cast<void>(server->stop());
  server.reset();
  const ConnectionLost lost = ada.await<ConnectionLost>();
  CHECK_FALSE(lost.is_final);
  CHECK_FALSE(lost.headline.empty());
  CHECK(ada->state() == ConnectionState::connecting);
  CHECK(ada->chunk({0, 0, 0}) != nullptr);
  const EditNumber edit = ada.edit(voxel({1, 20, 1}, 1));

  server = start_server(config, flat_creation());
  const WorldOpened opened = ada.await<WorldOpened>();
  CHECK_FALSE(opened.is_another);
  CHECK_FALSE(opened.is_first_contact);
  CHECK(ada->world()->id == id);
  CHECK(ada.await<EditConfirmed>().edit == edit);
  ada.catch_up();
  CHECK(ada.outdated_meshes() == 0);
  ada->close();

  // The next run of the program has the same identity, knows the server and has the chunks.
  JoinedClient again(options);
  CHECK_FALSE(again.await<WorldOpened>().is_first_contact);
  again.catch_up();
  CHECK(again->material_at({1, 20, 1}) == Material{1});
}

TEST_CASE("a wrong password ends the client for good, with words", "[integration][client_api]") {
  const TempFolder folder;
  const ServerConfig config = quiet_config(folder / "world");
  auto server = start_server(config, flat_creation());
  must(config.world, {"role", "default", "nobody"});
  REQUIRE(control(config.world, {"password", "set"}, [] {
            return Result<std::string, std::string>("blue cheese 42");
          }).is_ok);
  WorldClientOptions options = options_of(*server, 1);
  JoinedClient without(options);
  const ConnectionLost lacking = without.await<ConnectionLost>();
  CHECK(lacking.is_final);
  CHECK(lacking.lacks_password);
  options.password = "blue cheese 41";
  JoinedClient wrong(options);
  const ConnectionLost lost = wrong.await<ConnectionLost>();
  CHECK(lost.is_final);
  CHECK_FALSE(lost.lacks_password);
  CHECK(lost.detail.find("the password is wrong") != std::string::npos);
  CHECK(wrong->state() == ConnectionState::ended);
  CHECK(wrong->submit(voxel({0, 20, 0}, 1)).error().text == "no world is open");
  wrong->step();
  CHECK(wrong->drain().empty());
  options.password = "blue cheese 42";
  JoinedClient right(options);
  right.await<WorldOpened>();
}

}  // namespace runstone::test
