// Players add builds to the library of a running server, list them and fetch them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>

#include "server/store/build_table.hpp"
#include "tests/integration/server/app/large_build.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

/// Offers a file and sends it, with at most four uploads that were not answered. Returns the last
/// answer.
BuildAnswer add_build_as(RawClient& client, std::uint32_t request, const Bytes& file) {
  constexpr std::uint64_t kWindow = 4 * kBuildUploadBytesMax;
  client.send(BuildOffer{request, file.size()});
  std::uint64_t sent = 0;
  while (true) {
    const auto answer = client.next_of<BuildAnswer>();
    REQUIRE(answer.has_value());
    CHECK(answer->request == request);
    if (answer->number != 0 || !answer->refusal.empty()) return *answer;
    while (sent < file.size() && sent - answer->received < kWindow) {
      const std::uint64_t count = std::min<std::uint64_t>(kBuildUploadBytesMax, file.size() - sent);
      const auto begin = file.begin() + static_cast<std::ptrdiff_t>(sent);
      client.send(
          BuildUpload{request, sent, Bytes(begin, begin + static_cast<std::ptrdiff_t>(count))});
      sent += count;
    }
  }
}

Builds list_as(RawClient& client, const BuildsRequest& request) {
  client.send(request);
  const auto builds = client.next_of<Builds>();
  REQUIRE(builds.has_value());
  CHECK(builds->request == request.request);
  CHECK(builds->refusal.empty());
  return *builds;
}

Bytes fetch_as(RawClient& client, std::uint32_t request, const ListedBuild& build) {
  Bytes file;
  while (file.size() < build.file_bytes) {
    client.send(BuildPieceRequest{++request, build.number, file.size()});
    const auto piece = client.next_of<BuildPiece>();
    REQUIRE(piece.has_value());
    CHECK(piece->request == request);
    INFO(piece->refusal);
    REQUIRE_FALSE(piece->bytes.empty());
    file.insert(file.end(), piece->bytes.begin(), piece->bytes.end());
  }
  return file;
}

}  // namespace

TEST_CASE("a player adds a build, and another one lists it and fetches it byte by byte",
          "[integration][library]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  const Bytes mill = large_build("Mill"), tower = large_build("Tower");
  REQUIRE(mill.size() > kBuildPartBytes);
  {
    const auto server = start_server(quiet_config(world), flat_creation());
    RawClient ada(server->port()), bob(server->port());
    ada.features = bob.features = kFeatureBuilds;
    REQUIRE(ada.join(1).has_value());
    REQUIRE(bob.join(2).has_value());

    const BuildAnswer added = add_build_as(ada, 1, mill);
    INFO(added.refusal);
    REQUIRE(added.number != 0);
    CHECK(added.received == mill.size());
    REQUIRE(add_build_as(ada, 2, tower).number > added.number);

    BuildsRequest asked;
    asked.name = "mi";
    const Builds builds = list_as(bob, asked);
    CHECK(builds.total == 2);
    CHECK_FALSE(builds.has_more);
    REQUIRE(builds.builds.size() == 1);
    const ListedBuild& build = builds.builds[0];
    CHECK(build.number == added.number);
    CHECK(build.info.name == "Mill");
    CHECK(build.info.author == "player1");  // the file says another one
    CHECK(build.added_by_name == "player1");
    CHECK(build.file_bytes == mill.size());
    CHECK(fetch_as(bob, 1, build) == mill);

    asked = {};
    asked.request = 100;
    const Builds newest = list_as(bob, asked);
    REQUIRE(newest.builds.size() == 1);
    CHECK(newest.builds[0].info.name == "Tower");
    CHECK(newest.has_more);

    // A damaged file is refused, and so is one that the player does not end.
    Bytes damaged = mill;
    damaged[damaged.size() / 2] ^= 1;
    const BuildAnswer refused = add_build_as(bob, 101, damaged);
    CHECK(refused.number == 0);
    CHECK(refused.refusal.starts_with("the file is no sound .rsb: "));
    bob.send(BuildOffer{102, mill.size()});
    CHECK(server->stop().is_clean);
  }
  const auto store = open_world(world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const auto sound = (*store)->check();
  INFO((sound ? std::string() : sound.error().message()));
  CHECK(sound.has_value());
  CHECK((*store)->library_rows()->size() == 2);
}

TEST_CASE("a build above the limits of the server is refused when it is offered",
          "[integration][library]") {
  const TempFolder folder;
  ServerConfig config = quiet_config(folder / "world");
  config.build_mib = 1;
  const auto server = start_server(config, flat_creation());
  RawClient client(server->port());
  client.features = kFeatureBuilds;
  REQUIRE(client.join(1).has_value());
  client.send(BuildOffer{1, (1U << 20) + 1});
  const auto refused = client.next_of<BuildAnswer>();
  REQUIRE(refused.has_value());
  CHECK(refused->refusal.find("(build_mib)") != std::string::npos);
  CHECK(server->stop().is_clean);
}

}  // namespace runstone::test
