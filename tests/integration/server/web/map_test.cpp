#include <arpa/inet.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/web/waiting_requests.hpp"
#include "tests/integration/server/app/server_commands.hpp"
#include "tests/integration/server/app/session_messages.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/raw_client.hpp"

namespace runstone::test {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kCalmAddress = 0x7f000002;
// Drawing is charged to the range of an address, too, and this one is of another range.
constexpr std::uint32_t kFarAddress = 0x7f010002;
constexpr const char* kTile = "/map/tile/0/0/0.png";

WebConfig map_config_of(const TempFolder& folder) {
  WebConfig config = web_config_of(folder);
  config.world = folder / "world";
  config.map_ms_per_second = config.map_requests_per_second = 0;
  return config;
}

Json json_of(const HttpReply& reply) {
  INFO(reply.body);
  REQUIRE(reply.status == 200);
  CHECK(reply.header("Content-Type") == "application/json");
  return Json::parse(reply.body);
}

/// Asks for the state until the log has this many edits, for at most half a minute.
bool comes_to(WebPeer& peer, Sequence seq) {
  for (int i = 0; i < 300; ++i) {
    if (Json::parse(peer.get("/map/state.json").body).at("seq") >= seq) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

/// A player who has joined and edits voxels.
struct Builder {
  explicit Builder(std::uint16_t port) : client(port) {
    REQUIRE(client.join(1).has_value());
    View view;
    view.number = 1;
    view.radius_h = view.radius_v = 1;
    client.send(view);
    REQUIRE(client.next_of<ViewState>().has_value());
  }
  /// Sets a voxel and waits for the commit.
  void build(const VoxelPos& at) {
    client.send(voxel_edit(++count, at, 2));
    REQUIRE(client.next_of<Commit>().has_value());
  }
  RawClient client;
  ClientSequence count = 0;
};

TEST_CASE("the map follows the log: tiles have the version of what they show", "[integration]") {
  const TempFolder folder;
  const WebBench bench(server_config_of(folder), map_config_of(folder));
  WebPeer peer(bench.port());
  CHECK(peer.get("/map").body.find("map.js") != std::string::npos);
  CHECK(peer.get("/map.js").header("Content-Type") == "text/javascript; charset=utf-8");
  const Json first = json_of(peer.get("/map/state.json"));
  const HttpReply before = peer.get(kTile);
  REQUIRE(before.status == 200);
  CHECK(before.header("Content-Type") == "image/png");
  CHECK(before.header("Cache-Control") == "no-cache");
  CHECK(before.body.substr(1, 3) == "PNG");
  const std::string etag = before.header("ETag");
  REQUIRE_FALSE(etag.empty());
  const std::string condition = "If-None-Match: " + etag + "\r\n";
  const HttpReply same = peer.request("GET", kTile, condition);
  CHECK(same.status == 304);
  CHECK(same.body.empty());
  CHECK(same.header("ETag") == etag);

  Builder builder(bench.server->port());
  builder.build({3, 40, 5});
  const auto since = first.at("seq").get<Sequence>();
  REQUIRE(comes_to(peer, since + 1));
  const HttpReply after = peer.request("GET", kTile, condition);
  CHECK(after.status == 200);
  CHECK(after.header("ETag") != etag);
  CHECK(after.body != before.body);
  // A tile that the edit does not touch has its old version.
  CHECK(peer.request("GET", "/map/tile/0/-9/4.png", condition).status == 304);

  const Json news = json_of(peer.get("/map/state.json?since=" + std::to_string(since)));
  CHECK(news.at("is_complete") == true);
  REQUIRE(news.at("changed").size() == 1);
  CHECK(news.at("changed")[0] == Json({0, 0}));

  const HttpReply past = peer.get(std::string(kTile) + "?at=" + std::to_string(since));
  CHECK(past.header("ETag") == etag);
  CHECK(past.body == before.body);
}

TEST_CASE("a click says who built what, when, and how to take it back", "[integration]") {
  const TempFolder folder;
  const WebBench bench(server_config_of(folder), map_config_of(folder));
  WebPeer peer(bench.port());
  Builder builder(bench.server->port());
  const auto begin = json_of(peer.get("/map/state.json")).at("seq").get<Sequence>();
  builder.build({3, 40, 5});
  builder.build({3, 41, 5});
  REQUIRE(comes_to(peer, begin + 2));
  const Json told = json_of(peer.get("/map/builders.json?x=3&z=5"));
  CHECK(told.at("y") == 41);
  REQUIRE(told.at("edits").size() == 2);
  const Json& newest = told.at("edits")[0];
  CHECK(newest.at("author") == "player1");
  CHECK(newest.at("seq") == begin + 2);
  CHECK(newest.at("what").get<std::string>().find("voxel 3 41 5 := ") == 0);
  CHECK(json_of(peer.get("/map/builders.json?x=4&z=5")).at("edits").empty());
  const Json earlier =
      json_of(peer.get("/map/builders.json?x=3&z=5&at=" + std::to_string(begin + 1)));
  CHECK(earlier.at("y") == 40);
  CHECK(earlier.at("edits").size() == 1);
  const Json moment = json_of(peer.get("/map/moment.json?seq=" + std::to_string(begin + 2)));
  CHECK(moment.at("time_ms").get<TimeUs>() > 1'700'000'000'000);
  // The command that the map names is one that the server understands, for this edit alone.
  std::vector<std::string> words;
  std::istringstream command(newest.at("undo").get<std::string>());
  for (std::string word; command >> word;) words.push_back(word);
  const Answer preview = control(folder / "world", words);
  CAPTURE(preview.text);
  CHECK(preview.is_ok);
  CHECK(preview.text.find("1 edit") != std::string::npos);

  const Json recent = json_of(peer.get("/map/recent.json"));
  CHECK(recent.size() == 2);
  CHECK(recent[0] == newest);
  CHECK(peer.get("/status").body.find("voxel 3 41 5 := ") != std::string::npos);

  const HttpReply players = peer.get("/map/players.json");
  const Json list = json_of(players);
  REQUIRE(list.size() == 1);
  CHECK(list[0][0] == "player1");
}

TEST_CASE("the rights of strangers hold on the map", "[integration]") {
  const TempFolder folder;
  const WebBench bench(server_config_of(folder), map_config_of(folder));
  const std::string world = folder / "world";
  WebPeer peer(bench.port());
  const auto comes_to_answer = [&](const std::string& target, int status) {
    for (int i = 0; i < 300; ++i) {
      if (peer.get(target).status == status) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  };
  CHECK(peer.get(std::string(kTile) + "?at=0").status == 200);
  REQUIRE(control(world, {"role", "set", "guest", "see"}).is_ok);
  REQUIRE(control(world, {"role", "default", "guest"}).is_ok);
  REQUIRE(comes_to_answer(std::string(kTile) + "?at=0", 403));
  CHECK(peer.get(kTile).status == 200);
  const Json state = json_of(peer.get("/map/state.json"));
  CHECK(state.at("look_back") == false);
  CHECK_FALSE(state.contains("first"));
  for (const char* target : {"/map/builders.json?x=0&z=0", "/map/moment.json?seq=0",
                             "/map/tile/0/0/0.png?at=1", "/map/recent.json"}) {
    CAPTURE(target);
    const HttpReply refused = peer.get(target);
    CHECK(refused.status == 403);
    CHECK(refused.body == "strangers may not see the past of this world\n");
  }
  REQUIRE(control(world, {"role", "default", "nobody"}).is_ok);
  REQUIRE(comes_to_answer("/map/players.json", 403));
  for (const char* target : {"/map/state.json", "/map/builders.json?x=0&z=0", kTile}) {
    CAPTURE(target);
    CHECK(peer.get(target).body == "this world is for invited players, so its map is not public\n");
  }
  CHECK(peer.get("/map/players.json").status == 403);
  REQUIRE(control(world, {"role", "default", "visitor"}).is_ok);
  CHECK(comes_to_answer(kTile, 200));
}

TEST_CASE("absurd requests get clear words, and nothing but the map is read", "[integration]") {
  const TempFolder folder;
  const WebBench bench(server_config_of(folder), map_config_of(folder));
  WebPeer peer(bench.port());
  const auto status_of = [&](const std::string& target) { return peer.get(target).status; };
  CHECK(status_of("/map/tile/9/0/0.png") == 400);
  CHECK(status_of("/map/tile/0/9999999/0.png") == 400);
  CHECK(status_of("/map/tile/0/0/0.png?at=99999999") == 404);
  CHECK(status_of("/map/tile/0/0/0.png?at=18446744073709551616") == 400);
  CHECK(status_of("/map/moment.json?seq=99999999") == 404);
  CHECK(status_of("/map/moment.json?time_ms=0") == 200);
  CHECK(status_of("/map/builders.json?x=999999999999&z=0") == 400);
  CHECK(status_of("/map/state.json?since=9223372036854775807") == 200);
  for (const char* target :
       {"/map/../world.sqlite", "/map/tile/../../../etc/passwd", "/map/%2e%2e/world.sqlite",
        "/map//etc/passwd", "/map/world.sqlite", "/map/tile/0/0/0.png/../../x"}) {
    CAPTURE(target);
    CHECK(peer.get(target).status == 404);
  }
  CHECK(peer.request("POST", kTile).status == 405);
  CHECK(peer.request("HEAD", kTile).status == 200);
  // The corners of the world are drawn, too.
  for (const char* target : {"/map/tile/0/-1048576/-1048576.png", "/map/tile/8/4095/4095.png",
                             "/map/tile/0/1048575/-1048576.png"}) {
    CAPTURE(target);
    CHECK(status_of(target) == 200);
  }
}

TEST_CASE("an address that asks for too much is slowed down, and others are not", "[integration]") {
  const TempFolder folder;
  WebConfig config = map_config_of(folder);
  config.map_requests_per_second = 2;
  config.map_ms_per_second = 1'000;  // slow drawing does not use it up
  const WebBench bench(server_config_of(folder), config);
  WebPeer greedy(bench.port());
  int served = 0, refused = 0;
  for (int i = 0; i < 60 && refused == 0; ++i) {
    const HttpReply reply = greedy.get(kTile);  // drawn once, so that the requests come fast
    if (reply.status == 200) ++served;
    if (reply.status != 429) continue;
    ++refused;
    CHECK(reply.header("Retry-After") == "1");
  }
  CHECK(served >= 20);
  CHECK(served <= 40);
  CHECK(refused == 1);
  WebPeer other(bench.port(), kCalmAddress);
  CHECK(other.get(kTile).status == 200);
}

TEST_CASE("the requests of an address that wait count for all maps together", "[integration]") {
  const TempFolder folder;
  WebConfig config = map_config_of(folder);
  config.gateway_socket = WebConfig().gateway_socket;
  config.world.clear();
  std::vector<std::unique_ptr<Server>> servers;
  for (const std::string name : {"valley", "hills"}) {
    ServerConfig server = quiet_config(folder / name);
    server.gateway_socket = folder / (name + ".sock");
    config.servers.push_back({name, server.gateway_socket, "", "", folder / name});
    servers.push_back(start_server(server, flat_creation()));
  }
  const auto gateway = start_gateway(config);
  // One map alone would refuse none of them.
  constexpr std::size_t kOfEachMap = WaitingRequests::kOfAddressMax - 1;
  std::vector<std::unique_ptr<WebPeer>> peers;
  for (std::size_t i = 0; i < 2 * kOfEachMap; ++i)
    peers.push_back(std::make_unique<WebPeer>(gateway->port()));
  // All are sent before half of them are drawn, unless this thread has to wait for a processor.
  bool is_refused = false;
  for (int round = 0; round < 10 && !is_refused; ++round) {
    for (std::size_t i = 0; i < peers.size(); ++i) {
      peers[i]->send("GET /world/" + std::string(i % 2 == 0 ? "valley" : "hills") + "/map/tile/0/" +
                     std::to_string(i) + "/" + std::to_string(round) +
                     ".png HTTP/1.1\r\nHost: x\r\n\r\n");
    }
    for (const auto& peer : peers) {
      const HttpReply reply = peer->reply();
      if (reply.status != 429) continue;
      is_refused = true;
      CHECK(reply.body.find("many requests of this address wait") == 0);
    }
  }
  CHECK(is_refused);
  WebPeer other(gateway->port(), kCalmAddress);
  CHECK(other.get("/world/valley" + std::string(kTile)).status == 200);
}

TEST_CASE("the time of drawing is charged to the address that asked", "[integration]") {
  const TempFolder folder;
  WebConfig config = map_config_of(folder);
  config.map_ms_per_second = 1;  // 40 ms at once
  const WebBench bench(server_config_of(folder), config);
  WebPeer greedy(bench.port());
  bool is_refused = false;
  // Each tile is drawn, so the time adds up on the fastest machine.
  for (int i = 0; i < 10'000 && !is_refused; ++i) {
    const HttpReply reply = greedy.get("/map/tile/0/" + std::to_string(i) + "/0.png");
    is_refused = reply.status == 429;
    if (is_refused) CHECK(reply.body.find("drawn much for this address") != std::string::npos);
  }
  CHECK(is_refused);
  WebPeer other(bench.port(), kFarAddress);
  CHECK(other.get(kTile).status == 200);
  CHECK(other.get("/metrics").body.find("runstone_web_map_refused 1\n") != std::string::npos);
}

TEST_CASE("the map needs no running server, writes nothing, and can be off", "[integration]") {
  const TempFolder folder;
  WebBench bench(server_config_of(folder), map_config_of(folder));
  {
    Builder builder(bench.server->port());
    builder.build({3, 40, 5});
  }
  bench.server.reset();
  const auto files = [&] {
    std::map<std::string, std::pair<std::uintmax_t, std::filesystem::file_time_type>> out;
    for (const auto& file : std::filesystem::directory_iterator(folder / "world")) {
      const std::string name = file.path().filename().string();
      // Readers of SQLite share their locks in this file.
      if (!name.ends_with("-shm")) out[name] = {file.file_size(), file.last_write_time()};
    }
    return out;
  };
  WebPeer peer(bench.port());
  REQUIRE(peer.get("/map/state.json").status == 200);
  const auto before = files();
  for (int zoom = 0; zoom <= 8; ++zoom)
    CHECK(peer.get("/map/tile/" + std::to_string(zoom) + "/0/0.png").status == 200);
  CHECK(peer.get(std::string(kTile) + "?at=0").status == 200);
  CHECK(files() == before);

  std::filesystem::rename(folder / "world", folder / "away");
  bool is_away = false;
  for (int i = 0; i < 100 && !is_away; ++i) {
    const HttpReply reply = peer.get(kTile);
    is_away = reply.status == 503;
    if (is_away) CHECK(reply.body == "the world of this map cannot be read now\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  CHECK(is_away);
  CHECK(peer.get("/status").status == 200);

  const auto off = start_gateway(web_config_of(folder));
  WebPeer visitor(off->port());
  CHECK(visitor.get("/map").status == 404);
  CHECK(visitor.get("/map").body.find("shows no map") != std::string::npos);
  CHECK(visitor.get(kTile).body == "this gateway shows no map: its host has not turned it on\n");
  CHECK(visitor.get("/").body.find("href=\"map\"") == std::string::npos);
}

}  // namespace
}  // namespace runstone::test
