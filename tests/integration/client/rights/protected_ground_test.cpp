// A client of a real server refuses its own edits where the server would reject them.
#include <catch2/catch.hpp>
#include <string>

#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"

namespace runstone::test {
namespace {

constexpr View kGroundView{1, {0, 0, 0}, 2, 1};
const EditDescriptor kEditInSpawn{SetVoxel{{3, 3, 3}}, {}, 2};

/// Requires that the client refuses the edit, and returns the text for the player.
std::string refused_edit(LiveSession& client, const EditDescriptor& edit) {
  const auto seq = client.session().offer(edit, steady_now_us(), steady_now_us());
  REQUIRE_FALSE(seq.has_value());
  CHECK(seq.error().code == ErrorCode::not_permitted);
  return client.session().refusal_text(edit, seq.error());
}

std::size_t known_boxes(LiveSession& client) { return client.replica().ground().boxes().size(); }

}  // namespace

TEST_CASE("where ground is protected, the client refuses its edit before it is sent",
          "[integration][rights]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  auto server = start_server(quiet_config(world), flat_creation());
  LiveSession client(server->port(), kGroundView);
  client.catch_up();
  client.until([&] { return client.replica().ground().permissions().has_value(); });
  CHECK(client.replica().ground().permissions()->role == "builder");
  client.edit(kEditInSpawn);
  client.catch_up();
  const std::uint64_t submitted = client.replica().local_edits().counters().submitted;

  REQUIRE(control(world, {"protect", "spawn", "0", "0", "0", "7", "7", "7"}).is_ok);
  client.until([&] { return known_boxes(client) == 1; });
  CHECK(refused_edit(client, kEditInSpawn) == "the ground is protected: spawn");
  client.edit({SetVoxel{{8, 3, 3}}, {}, 2});  // beside it
  client.catch_up();
  CHECK(client.replica().local_edits().counters().submitted == submitted + 1);
  CHECK(client.replica().local_edits().counters().rejected == 0);

  REQUIRE(control(world, {"protect", "spawn", "add", "role:builder"}).is_ok);
  client.until([&] {
    const auto& boxes = client.replica().ground().boxes();
    return !boxes.empty() && boxes.begin()->second.admits;
  });
  client.edit(kEditInSpawn);
  client.catch_up();
  REQUIRE(control(world, {"unprotect", "spawn"}).is_ok);
  client.until([&] { return known_boxes(client) == 0; });
  client.edit(kEditInSpawn);
  client.catch_up();
  CHECK(client.replica().local_edits().counters().rejected == 0);
  server->stop();
}

}  // namespace runstone::test
