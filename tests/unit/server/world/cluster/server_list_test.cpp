// Who gets which list of servers, and when.
#include "server/world/cluster/server_list.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/unit/server/world/cluster/cluster_bench.hpp"

namespace runstone::test {
namespace {

constexpr std::uint8_t kListedKey = 200;  // the seed of config()
constexpr SessionId kFirstLink = 50;

/// The servers of a bench with it have the addresses server0:4747, server1:4747 and so on.
WorldConfig listed_config() {
  WorldConfig c = config();
  c.player_address = "server";
  return c;
}

std::string address_of(std::size_t server) { return "server" + std::to_string(server) + ":4747"; }

std::vector<std::string> addresses_in(const Servers& list) {
  std::vector<std::string> out;
  for (const ServerEntry& server : list.servers) out.push_back(server.address);
  return out;
}
using ListedNames = std::vector<std::string>;

struct ListBench : ClusterBench {
  explicit ListBench(std::size_t followers) : ClusterBench(followers, listed_config()) {}
  std::vector<Servers> lists(std::size_t server, SessionId session = 1) {
    return sent<Servers>(server, session);
  }
  void wait(TimeUs us) {
    for (const TimeUs end_us = time_us + us; time_us < end_us;) tick();
  }
};

/// Connects another server to the bench.
void connect_follower(WorldBench& bench, SessionId link, const FollowRequest& request,
                      std::uint64_t features = kFeatureServers | kFeatureServerList) {
  bench.server.connected(link, bench.now());
  Hello hello = bench.hello(kListedKey, link);
  hello.features = features;
  bench.server.received(link, hello, bench.now());
  const Welcome welcome = bench.environment.messages<Welcome>(link, 0).at(0);
  bench.server.received(link, bench.client_auth(kListedKey, hello, welcome), bench.now());
  bench.server.received(link, request, bench.now());
}

}  // namespace

TEST_CASE("a world with one server sends no list", "[world][servers]") {
  ListBench bench(0);
  bench.join(0, 1, 1);
  bench.wait(2 * kPlayerCountsUs);
  CHECK(bench.lists(0).empty());
}

TEST_CASE("players of every server get all servers, as seen from theirs", "[world][servers]") {
  ListBench bench(2);
  bench.join(0, 1, 1);
  bench.join(1, 1, 2);
  bench.join(1, 2, 3);
  bench.join(2, 1, 4);
  bench.tick();
  bench.tick();
  for (const std::size_t server : {0U, 1U, 2U}) {
    CAPTURE(server);
    REQUIRE(bench.lists(server).size() == 1);
    const Servers list = bench.lists(server)[0];
    CHECK(list.here == server + 1);
    CHECK(list.servers == std::vector<ServerEntry>{{address_of(0), "https://page0", 1},
                                                   {address_of(1), "https://page1", 2},
                                                   {address_of(2), "https://page2", 1}});
  }
  CHECK(bench.lists(1, 2) == bench.lists(1, 1));
}

TEST_CASE("the list comes after session accepted, also for who joins later", "[world][servers]") {
  ListBench bench(1);
  bench.tick();
  for (const std::size_t server : {0U, 1U}) {
    CAPTURE(server);
    bench.join(server, 1, static_cast<std::uint8_t>(server + 1));
    CHECK(bench.lists(server).empty());
    bench.tick();
    bench.tick();
    CHECK(bench.lists(server).size() == 1);
  }
}

TEST_CASE("a client that does not know lists gets none", "[world][servers]") {
  ListBench bench(1);
  bench.join(0, 1, 1, bench.hello(1, kFeaturesKnown & ~kFeatureNames & ~kFeatureServerList));
  bench.join(1, 1, 2, bench.hello(2, kFeaturesKnown & ~kFeatureNames & ~kFeatureServerList));
  bench.wait(1'000'000);
  CHECK(bench.lists(0).empty());
  CHECK(bench.lists(1).empty());
}

TEST_CASE("numbers of players alone are sent every ten seconds at most", "[world][servers]") {
  ListBench bench(1);
  bench.join(0, 1, 1);
  bench.tick();
  bench.tick();
  REQUIRE(bench.lists(0).size() == 1);
  bench.join(1, 1, 2);
  bench.wait(kPlayerCountsUs - 200'000);
  CHECK(bench.lists(0).size() == 1);
  CHECK(bench.lists(1).size() == 1);  // it joined later
  bench.wait(400'000);
  REQUIRE(bench.lists(0).size() == 2);
  CHECK(bench.lists(0)[1].servers[1].players == 1);
  REQUIRE(bench.lists(1).size() == 2);
  CHECK(bench.lists(1)[1].servers == bench.lists(0)[1].servers);
  bench.wait(3 * kPlayerCountsUs);  // nobody comes or leaves
  CHECK(bench.lists(0).size() == 2);
}

TEST_CASE("a server that comes or ends changes the list at once", "[world][servers]") {
  ListBench bench(2);
  for (const std::size_t server : {0U, 1U, 2U})
    bench.join(server, 1, static_cast<std::uint8_t>(server + 1));
  bench.tick();
  bench.tick();
  bench.cut(2);
  bench.tick();
  bench.tick();
  for (const std::size_t server : {0U, 1U}) {
    CAPTURE(server);
    REQUIRE(bench.lists(server).size() == 2);
    CHECK(addresses_in(bench.lists(server)[1]) == ListedNames{address_of(0), address_of(1)});
    CHECK(bench.lists(server)[1].here == server + 1);
  }
  CHECK(bench.lists(2).size() == 1);  // it keeps the last one
  bench.cut(1);
  bench.tick();
  bench.tick();
  REQUIRE(bench.lists(0).size() == 3);
  CHECK(addresses_in(bench.lists(0)[2]) == ListedNames{address_of(0)});
  bench.connect(1);
  bench.tick();
  bench.tick();
  REQUIRE(bench.lists(0).size() == 4);
  CHECK(addresses_in(bench.lists(0)[3]) == ListedNames{address_of(0), address_of(1)});
  CHECK(bench.lists(1).size() == 3);
}

TEST_CASE("a new owner keeps the list until the others have come, and then makes its own",
          "[world][servers]") {
  ListBench bench(2);
  bench.join(1, 1, 1);
  bench.join(2, 1, 2);
  bench.tick();
  bench.tick();
  bench.lose_owner();
  REQUIRE(bench.take_over(1));
  bench.tick();
  bench.connect(2);
  bench.tick();
  bench.join(1, 2, 3);
  bench.wait(kServersGatherUs - 200'000);
  CHECK(bench.lists(1).size() == 1);
  REQUIRE(bench.lists(1, 2).size() == 1);
  CHECK(addresses_in(bench.lists(1, 2)[0]) ==
        ListedNames{address_of(0), address_of(1), address_of(2)});
  bench.wait(300'000);
  for (const std::size_t server : {1U, 2U}) {
    CAPTURE(server);
    REQUIRE_FALSE(bench.lists(server).empty());
    const Servers last = bench.lists(server).back();
    CHECK(addresses_in(last) == ListedNames{address_of(1), address_of(2)});
    CHECK(last.here == server);
  }
}

TEST_CASE("a session whose queue is full gets the list later", "[world][servers]") {
  ListBench bench(1);
  bench.join(0, 1, 1);
  bench.environment(0).full.insert(1);
  bench.tick();
  CHECK(bench.lists(0).empty());
  bench.environment(0).full.clear();
  bench.tick();
  CHECK(bench.lists(0).size() == 1);
}

TEST_CASE("servers without an address for players are not listed, and none is listed twice",
          "[world][servers]") {
  WorldConfig c = config();
  c.player_address = "owner:1";
  WorldBench bench(c);
  bench.join(1, 1, 1, {}, kFeatureServerList);
  connect_follower(bench, kFirstLink, FollowRequest{});
  bench.tick();
  CHECK(bench.environment.messages<Servers>(1, kEdge).empty());
  connect_follower(bench, kFirstLink + 1, FollowRequest{{}, "other:1", "https://first"});
  connect_follower(bench, kFirstLink + 2, FollowRequest{{}, "other:1", "https://second"});
  connect_follower(bench, kFirstLink + 3, FollowRequest{{}, "owner:1", ""});
  bench.tick();
  const auto lists = bench.environment.messages<Servers>(1, kEdge);
  REQUIRE(lists.size() == 1);
  CHECK(lists[0].servers ==
        std::vector<ServerEntry>{{"other:1", "https://first", 0}, {"owner:1", "", 1}});
  CHECK(lists[0].here == 2);
}

TEST_CASE("a server that does not ask for lists gets none, and is listed", "[world][servers]") {
  WorldConfig c = config();
  c.player_address = "owner:1";
  WorldBench bench(c);
  bench.join(1, 1, 1, {}, kFeatureServerList);
  connect_follower(bench, kFirstLink, FollowRequest{{}, "other:1", ""}, kFeatureServers);
  bench.tick();
  CHECK(bench.environment.messages<Servers>(1, kEdge).size() == 1);
  CHECK(bench.environment.messages<Servers>(kFirstLink, kEdge).empty());
}

TEST_CASE("a list has no more servers than a message may have", "[world][servers]") {
  WorldConfig c = config();
  c.player_address = "owner:1";
  WorldBench bench(c);
  bench.join(1, 1, 1, {}, kFeatureServerList);
  for (std::size_t i = 0; i < kServersMax + 5; ++i)
    connect_follower(bench, static_cast<SessionId>(kFirstLink + i),
                     FollowRequest{{}, "follower" + std::to_string(i) + ":1", ""});
  bench.tick();
  const auto lists = bench.environment.messages<Servers>(1, kEdge);
  REQUIRE(lists.size() == 1);
  CHECK(lists[0].servers.size() == kServersMax);
  CHECK(lists[0].here != 0);
}

}  // namespace runstone::test
