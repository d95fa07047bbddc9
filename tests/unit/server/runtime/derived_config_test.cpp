#include "server/runtime/derived_config.hpp"

#include <catch2/catch.hpp>

#include "tests/support/store/sample_world.hpp"

namespace runstone::test {
namespace {

TEST_CASE("settings reach the world strand in its units", "[server]") {
  ServerConfig config;
  config.depth_max = 5;
  config.height_max = 70;
  config.view_interval_ms = 20;
  config.worker_threads = 3;
  config.idle_s = 7;
  config.digest_check_ms = 250;
  config.memory_mib = 16;
  config.snapshot_s = 9;
  config.builder_budget = {3, 8};
  config.budgets_per_address = 5;
  config.chunk_loads_per_second = 30;
  config.sessions_per_key = 6;
  config.sessions_per_address = 7;
  config.range_seats_percent = 40;
  config.stop_s = 4;
  config.speed_max = 70;
  const WorldConfig world = world_config_of(config, sample_meta(), 4747);
  CHECK(world.world_id == sample_meta().world_id);
  CHECK(world.chunk_edge == kSampleEdge);
  CHECK(world.server_keys.public_key == key_pair_of(sample_meta().server_key_seed).public_key);
  CHECK(world.heights.y_min == -5);
  CHECK(world.heights.y_max == 70);
  CHECK(world.view_interval_us == 20'000);
  CHECK(world.loads_in_flight_max == 12);
  CHECK(world.idle_us_max == 7'000'000);
  CHECK(world.digest_check_interval_us == 250'000);
  CHECK(world.memory.edit_bytes_max == 16U * 1024 * 1024);
  CHECK(world.memory.view_bytes_max < world.memory.edit_bytes_max);
  CHECK(world.memory.idle_bytes_max < world.memory.view_bytes_max);
  CHECK(world.snapshots.stack_bytes_max == world.memory.stack_bytes_max);
  CHECK(world.snapshots.interval_us == 9'000'000);
  CHECK(world.edit_budget == EditBudget{3, 8});
  CHECK(world.budgets_per_address == 5);
  CHECK(world.chunk_loads == Budget{30, 300});
  CHECK(world.sessions_per_key == 6);
  CHECK(world.sessions_per_address == 7);
  CHECK(world.range_seats_percent == 40);
  CHECK(world.stop_us_max == 3'000'000);
  CHECK(world.speed_max == 70);
}

TEST_CASE("links have the public address, or that of a server for its machine alone", "[runtime]") {
  ServerConfig config;
  const auto link_address = [&config] {
    return world_config_of(config, sample_meta(), 5000).link_address;
  };
  for (const char* local : {"127.0.0.1:0", "localhost", "127.0.0.2:5000"}) {
    config.listen = local;
    const std::string host(local);
    CHECK(link_address() == host.substr(0, host.find(':')) + ":5000");
  }
  config.listen = "[::1]:5000";
  CHECK(link_address() == "[::1]:5000");
  for (const char* open : {"0.0.0.0:5000", ":5000", "[::]:5000", "192.0.2.1", "example.org:5000"}) {
    config.listen = open;
    CHECK(link_address() == "HOST:5000");
  }
  config.public_address = "example.org";
  CHECK(link_address() == "example.org:5000");
  config.public_address = "example.org:443";
  CHECK(link_address() == "example.org:443");
  config.public_address = "2001:db8::7";
  CHECK(link_address() == "[2001:db8::7]:5000");
}

TEST_CASE("only a server of a world in a database has an address in the list of servers",
          "[runtime]") {
  ServerConfig config;
  config.listen = "192.0.2.1";
  config.player_address = "play.example";
  config.page_address = "https://play.example";
  CHECK(world_config_of(config, sample_meta(), 5000).player_address.empty());
  CHECK(world_config_of(config, sample_meta(), 5000).page_address.empty());
  config.store = "postgresql://db.example/valley";
  CHECK(world_config_of(config, sample_meta(), 5000).player_address == "play.example:5000");
  CHECK(world_config_of(config, sample_meta(), 5000).page_address == "https://play.example");
}

TEST_CASE("the configured encoding is the preferred one", "[server]") {
  ServerConfig config;
  for (const ChunkEncoding encoding :
       {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    config.encoding = encoding;
    CHECK(world_config_of(config, sample_meta(), 4747).preferred_encoding == encoding);
  }
}

TEST_CASE("settings reach the network in bytes, with room for handshakes", "[server]") {
  ServerConfig config;
  config.sessions_max = 10;
  config.control_queue_kib = 64;
  config.edit_queue_kib = 65;
  config.chunk_queue_kib = 66;
  config.session_kib_per_second = 2;
  config.server_kib_per_second = 3;
  config.read_kib_per_second = 4;
  config.budgets_per_address = 3;
  config.messages_per_second = 50;
  const NetLimits limits = net_limits_of(config);
  CHECK(limits.connections_max > config.sessions_max);
  CHECK(limits.send.control_bytes == 64U * 1024);
  CHECK(limits.send.edit_bytes == 65U * 1024);
  CHECK(limits.send.chunk_bytes == 66U * 1024);
  CHECK(limits.bytes_per_second == 2U * 1024);
  CHECK(limits.server_bytes_per_second == 3U * 1024);
  CHECK(limits.read_bytes_per_second == 4U * 1024);
  CHECK(limits.read_bytes_per_address == 12U * 1024);
  CHECK(limits.messages_per_second == 50);
  CHECK(limits.message_burst == 100);
}

}  // namespace
}  // namespace runstone::test
